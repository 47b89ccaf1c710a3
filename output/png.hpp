#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ensonify/core/colour.hpp"
#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Greyscale PNG, 8 or 16 bits, no filter, fastest deflate: speckle is next to incompressible, and filters make it
/// larger. About 1 ms for 512 x 512 noisy pixels on one core of 2.8 GHz. The packed bytes
/// may differ between processors; the pixels do not.
std::vector<std::uint8_t> encode_png(const Image2<std::uint8_t>& image);
std::vector<std::uint8_t> encode_png(const Image2<std::uint16_t>& image);

/// Colour PNG, 8 bits a channel; well packed, for pictures.
std::vector<std::uint8_t> encode_png(const Image2<Rgb>& image);

/// Decodes a greyscale PNG; Grey is std::uint8_t or std::uint16_t. Throws DataError naming `name` where the bytes are
/// broken, larger than 2^28 pixels, or of another depth.
template <typename Grey>
Image2<Grey> decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);

extern template Image2<std::uint8_t> decode_png(std::span<const std::uint8_t>, const std::filesystem::path&);
extern template Image2<std::uint16_t> decode_png(std::span<const std::uint8_t>, const std::filesystem::path&);

/// An 8-bit greyscale file.
Image2<std::uint8_t> read_png(const std::filesystem::path& path);

}  // namespace ensonify
