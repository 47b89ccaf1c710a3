#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Greyscale PNG, 8 or 16 bits, no filter, fastest deflate: speckle is next to incompressible, and filters make it
/// larger. About 3 ms for 512 x 512 noisy pixels on one core of 2.8 GHz.
std::vector<std::uint8_t> encode_png(const Image2<std::uint8_t>& image);
std::vector<std::uint8_t> encode_png(const Image2<std::uint16_t>& image);

/// Decodes a greyscale PNG. Throws DataError naming `name` where the bytes are broken, larger than 2^28 pixels, or of
/// another depth.
Image2<std::uint8_t> decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);
Image2<std::uint8_t> read_png(const std::filesystem::path& path);

}  // namespace ensonify
