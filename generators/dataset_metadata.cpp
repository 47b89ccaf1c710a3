#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/json_text.hpp"

namespace ensonify {
namespace {

using nlohmann::json;
constexpr std::uint64_t max_line_bytes = 1 << 20;

double finite(const json& value, const char* key) {
  // JSON has no NaN: writers put null.
  const double number = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  if (!std::isfinite(number)) throw DataError(fmt::format("{} must be finite", key));
  return number;
}

Pose pose_of(const json& line, const char* key) {
  if (!line.contains(key))
    throw DataError(fmt::format("has no {}; every frame needs its pose, 4 x 4, row by row", key));
  const json& rows = line.at(key);
  Pose pose = Pose::Identity();
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = finite(rows.at(r).at(c), key);
  }
  const Eigen::Matrix3d rotation = pose.linear();
  const bool rigid = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
                     rotation.determinant() > 0 && pose.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
  if (!rigid) throw DataError(fmt::format("{} must be a rotation and a translation, 4 x 4, row by row", key));
  return pose;
}

FrameInfo info_of(const std::string& text, int split, int number) {
  const json line = parse_json(text, "metadata.jsonl");
  FrameInfo info;
  info.split = split;
  info.number = number;
  info.place = line.at("place");
  info.range_min_m = finite(line.at("range_min_m"), "range_min_m");
  info.range_max_m = finite(line.at("range_max_m"), "range_max_m");
  if (info.range_min_m < 0 || info.range_max_m <= info.range_min_m) {
    throw DataError("must keep 0 <= range_min_m < range_max_m");
  }
  if (!line.at("time").is_null()) info.time_s = finite(line.at("time"), "time");
  info.T_world_sonar = pose_of(line, "T_world_sonar");
  info.T_world_sonar_est = pose_of(line, "T_world_sonar_est");
  for (const auto& [key, value] : line.at("sampled").items()) {
    info.sampled.emplace_back(key, finite(value, key.c_str()));
  }
  info.line = text;
  return info;
}

}  // namespace

MetadataIndex index_metadata(const Dataset& dataset, int split) {
  const DatasetSplit& of = dataset.splits.at(static_cast<std::size_t>(split));
  MetadataIndex index{dataset.folder / of.name / "metadata.jsonl", split, {0}};
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(index.file, error);  // a pipe would never end
  std::ifstream in;
  if (regular) in.open(index.file, std::ios::binary);
  if (!in.is_open()) throw DataError(fmt::format("{}: can not be read", index.file.string()));
  std::uint64_t offset = 0;
  std::vector<char> chunk(1 << 20);
  while (in.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), in.gcount() > 0) {
    for (std::streamsize i = 0; i < in.gcount(); ++i) {
      ++offset;
      if (chunk[static_cast<std::size_t>(i)] != '\n') continue;
      if (offset - index.starts.back() > max_line_bytes) {
        throw DataError(
            fmt::format("{}, line {}: longer than {} bytes", index.file.string(), index.starts.size(), max_line_bytes));
      }
      index.starts.push_back(offset);
      if (index.starts.size() > static_cast<std::size_t>(of.frames) + 1) break;
    }
  }
  if (index.starts.size() != static_cast<std::size_t>(of.frames) + 1 || offset != index.starts.back()) {
    throw DataError(fmt::format("{}: must have {} lines, each ended by a newline, as the manifest says",
                                index.file.string(), of.frames));
  }
  return index;
}

std::vector<std::string> read_lines(const MetadataIndex& index, int first, int count) {
  const auto start = static_cast<std::size_t>(first);
  std::ifstream in(index.file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(index.starts.at(start)));
  std::vector<std::string> lines(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].resize(index.starts.at(start + i + 1) - index.starts[start + i] - 1);
    in.read(lines[i].data(), static_cast<std::streamsize>(lines[i].size()));
    in.get();
  }
  if (!in) throw DataError(fmt::format("{}: changed while it was read", index.file.string()));
  return lines;
}

std::vector<FrameInfo> read_frames(const MetadataIndex& index, int first, int count) {
  std::vector<FrameInfo> frames;
  for (const std::string& line : read_lines(index, first, count)) {
    const int number = first + static_cast<int>(frames.size());
    try {
      frames.push_back(info_of(line, index.split, number));
    } catch (const json::exception& e) {
      throw DataError(fmt::format("{}, line {}: {}", index.file.string(), number + 1, e.what()));
    } catch (const DataError& e) {
      throw DataError(fmt::format("{}, line {}: {}", index.file.string(), number + 1, e.what()));
    }
  }
  return frames;
}

}  // namespace ensonify
