#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace ensonify {

/// An array of numpy: C order, little endian. `descr` is numpy's type string ("|u1", "<f4", "<f8", "<U7").
struct NpyArray {
  std::string descr;
  std::vector<std::size_t> shape;  ///< empty: a scalar
  std::string bytes;
};

/// A string as numpy holds it: a scalar of 4-byte characters. ASCII only.
NpyArray npy_text(std::string_view ascii);

/// The bytes of a .npy file, format 1.0 (NEP 1, Kern 2007).
std::string to_npy(const NpyArray& array);

/// Reads .npy 1.0 to 3.0. Throws DataError (with `name`): not .npy, Fortran order, Python objects, another byte order,
/// or another number of bytes than the shape says.
NpyArray from_npy(std::string_view file, const std::string& name);

/// Throws DataError unless the array has this type.
void expect_descr(const NpyArray& array, std::string_view descr, const std::string& name);

}  // namespace ensonify
