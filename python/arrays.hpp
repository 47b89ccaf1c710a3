#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/core/image2.hpp"
#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/python/bindings.hpp"

/// Arrays in and out. What goes in must fit as it is: nothing is converted in silence. What comes out is a writable
/// view into the object that it belongs to, and keeps that alive; or owns what was moved into it.
namespace ensonify::python {

std::string type_name(const py::handle& object);

/// Throws TypeError: no array, or of another dtype; ValueError: another number of dimensions, not C-contiguous.
template <typename T>
py::array_t<T> require_array(const py::handle& object, const char* what, int dimensions) {
  if (!py::isinstance<py::array>(object)) {
    throw py::type_error(fmt::format("{} must be a numpy array, not {}", what, type_name(object)));
  }
  const auto any = py::reinterpret_borrow<py::array>(object);
  if (!py::isinstance<py::array_t<T>>(any)) {
    throw py::type_error(fmt::format("{} must have dtype {}, not {}; convert it with .astype", what,
                                     py::str(py::dtype::of<T>()).template cast<std::string>(),
                                     py::str(any.dtype()).cast<std::string>()));
  }
  if (any.ndim() != dimensions) {
    throw py::value_error(fmt::format("{} must have {} dimensions, not {}", what, dimensions, any.ndim()));
  }
  if ((any.flags() & py::array::c_style) == 0) {
    throw py::value_error(fmt::format("{} must be C-contiguous; numpy.ascontiguousarray makes it so", what));
  }
  return py::reinterpret_borrow<py::array_t<T>>(object);
}

template <typename T>
Image2<T> image_from(const py::array_t<T>& array) {
  constexpr py::ssize_t most = 1 << 28;
  if (array.size() == 0) throw py::value_error("an image needs pixels");
  if (array.size() > most) throw py::value_error(fmt::format("an image of {} pixels is too large", array.size()));
  Image2<T> image(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)));
  std::copy_n(array.data(), array.size(), image.pixels().begin());
  return image;
}

/// uint8, uint16 (65535 becomes 255) or float32 (0..255).
GreyImage grey_from(const py::handle& object, const char* what);

/// The pixels of `image`, which `owner` holds.
template <typename T>
py::array view_of(const Image2<T>& image, const py::handle& owner) {
  return py::array_t<T>({image.rows(), image.columns()}, image.pixels().data(), owner);
}
/// None where the image is empty: it was not modelled, or not asked for.
template <typename T>
py::object view_or_none(const Image2<T>& image, const py::handle& owner) {
  return image.empty() ? py::object(py::none()) : py::object(view_of(image, owner));
}
/// The cells [z, y, x] of a grid, which `owner` holds.
template <typename T>
py::array view_of(const std::vector<T>& cells, const GridFrame& frame, const py::handle& owner) {
  return py::array_t<T>({frame.size[2], frame.size[1], frame.size[0]}, cells.data(), owner);
}

/// The image moved into an array of its own.
template <typename T>
py::array moved_to_array(Image2<T>&& image) {
  auto* kept = new Image2<T>(std::move(image));
  const py::capsule owner(kept, [](void* p) { delete static_cast<Image2<T>*>(p); });
  return view_of(*kept, owner);
}

template <typename T>
py::array copied_to_array(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace ensonify::python
