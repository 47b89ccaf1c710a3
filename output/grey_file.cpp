#include "ensonify/output/grey_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/exr.hpp"
#include "ensonify/output/npy.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

constexpr float levels_16 = 257.0F;  ///< 65535 / 255
constexpr std::size_t most_pixels = std::size_t{1} << 28;

/// .PNG is a .png too.
std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

GreyImage read_grey_png(const fs::path& path) {
  constexpr std::size_t depth_at = 24;  // of IHDR, which comes first
  const auto bytes = read_file(path);
  if (bytes.size() > depth_at && bytes[depth_at] == 16) return to_grey(decode_png<std::uint16_t>(bytes, path));
  return to_grey(decode_png<std::uint8_t>(bytes, path));
}

GreyImage read_grey_npy(const fs::path& path) {
  const NpyArray array = from_npy(read_text(path), path.string());
  if (array.shape.size() != 2 || array.shape[0] == 0 || array.shape[1] == 0 ||
      array.shape[0] > most_pixels / array.shape[1]) {
    throw DataError(fmt::format("{}: must be an array of two dimensions (range bins, beams), not of {}", path.string(),
                                array.shape.size()));
  }
  const auto pixels_of = [&]<typename Pixel>(Pixel) {
    Image2<Pixel> pixels(static_cast<int>(array.shape[0]), static_cast<int>(array.shape[1]));
    std::memcpy(pixels.pixels().data(), array.bytes.data(), array.bytes.size());
    return pixels;
  };
  const auto as_they_are = [](const auto& pixels) {
    GreyImage image{Image2<float>(pixels.rows(), pixels.columns()), GreyDepth::real};
    std::ranges::transform(pixels.pixels(), image.grey.pixels().begin(), [](auto v) { return static_cast<float>(v); });
    return image;
  };
  if (array.descr == "|u1") return to_grey(pixels_of(std::uint8_t{}));
  if (array.descr == "<u2") return to_grey(pixels_of(std::uint16_t{}));
  if (array.descr == "<f4") return as_they_are(pixels_of(float{}));
  if (array.descr == "<f8") return as_they_are(pixels_of(double{}));
  if (array.descr == "<i4") return as_they_are(pixels_of(std::int32_t{}));
  if (array.descr == "<i8") return as_they_are(pixels_of(std::int64_t{}));
  throw DataError(fmt::format("{}: holds '{}'; an image must be of uint8, uint16, int32, int64, float32 or float64",
                              path.string(), array.descr));
}

GreyImage read_grey_exr(const fs::path& path) {
  auto channels = read_exr(path);
  if (channels.size() != 1) {
    throw DataError(
        fmt::format("{}: has {} channels; an image to filter must have one", path.string(), channels.size()));
  }
  return {std::move(channels.front().second), GreyDepth::real};
}

template <typename Grey>
std::vector<std::uint8_t> rounded_png(const Image2<float>& grey, float unit) {
  Image2<Grey> whole(grey.rows(), grey.columns());
  std::ranges::transform(grey.pixels(), whole.pixels().begin(),
                         [=](float x) { return static_cast<Grey>(std::lrint(std::clamp(x, 0.0F, 255.0F) * unit)); });
  return encode_png(whole);
}

[[noreturn]] void unknown_extension(const fs::path& path) {
  throw ConfigError(fmt::format("{}: an image must end in .png, .exr or .npy", path.string()));
}

}  // namespace

bool is_grey_file(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".png" || extension == ".exr" || extension == ".npy";
}

GreyImage read_grey(const fs::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".png") return read_grey_png(path);
  if (extension == ".npy") return read_grey_npy(path);
  if (extension == ".exr") return read_grey_exr(path);
  unknown_extension(path);
}

void write_grey(const fs::path& path, const GreyImage& image) {
  const std::string extension = extension_of(path);
  if (extension == ".png") {
    write_file(path, image.depth == GreyDepth::bits16 ? rounded_png<std::uint16_t>(image.grey, levels_16)
                                                      : rounded_png<std::uint8_t>(image.grey, 1.0F));
  } else if (extension == ".npy") {
    NpyArray array{
        .descr = "<f4",
        .shape = {static_cast<std::size_t>(image.grey.rows()), static_cast<std::size_t>(image.grey.columns())},
        .bytes = std::string(image.grey.size() * sizeof(float), '\0')};
    std::memcpy(array.bytes.data(), image.grey.pixels().data(), array.bytes.size());
    write_file(path, to_npy(array));
  } else if (extension == ".exr") {
    write_exr(path, {{"Y", image.grey}}, "grey levels on the scale 0..255");
  } else {
    unknown_extension(path);
  }
}

}  // namespace ensonify
