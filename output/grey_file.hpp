#pragma once

#include <filesystem>

#include "ensonify/core/grey_image.hpp"

namespace ensonify {

/// Whether the extension is one that read_grey and write_grey know: .png, .exr, .npy.
bool is_grey_file(const std::filesystem::path& path);

/// A greyscale image as levels 0..255: PNG of 8 bits, or of 16 (divided by 257); .npy of two dimensions (uint8, uint16
/// likewise; other numbers as they are); .exr with one channel, as it is. Throws DataError: broken, of another kind,
/// empty, or ConfigError: an extension that is not known.
GreyImage read_grey(const std::filesystem::path& path);

/// Writes whole or not at all. PNG: rounded, held to 0..255, 16 bits where the depth says so, else 8; .npy: float32;
/// .exr: one channel Y. Throws DiskError, or ConfigError: an extension that is not known.
void write_grey(const std::filesystem::path& path, const GreyImage& image);

}  // namespace ensonify
