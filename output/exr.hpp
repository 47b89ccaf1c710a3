#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// A named float channel of an image.
using Channel = std::pair<std::string, Image2<float>>;

/// Writes 32-bit float channels of equal size as one OpenEXR file (ZIP compression), whole or not at all.
/// Rows = range bins, columns = beams. `comment` goes into the header. Throws DataError.
void write_exr(const std::filesystem::path& path, const std::vector<Channel>& channels, const std::string& comment);

/// Reads every channel of an OpenEXR file as float. Throws DataError.
std::vector<Channel> read_exr(const std::filesystem::path& path);

}  // namespace ensonify
