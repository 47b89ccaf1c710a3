#include "ensonify/output/grid_npz.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "ensonify/core/error.hpp"
#include "ensonify/output/npz.hpp"

namespace ensonify {
namespace {

static_assert(std::endian::native == std::endian::little, ".npy arrays are written as they lie in memory");

std::vector<std::size_t> shape_of(const GridFrame& frame) {
  return {static_cast<std::size_t>(frame.size[2]), static_cast<std::size_t>(frame.size[1]),
          static_cast<std::size_t>(frame.size[0])};
}

NpyArray bytes_array(const GridFrame& frame, const std::vector<std::uint8_t>& cells) {
  return {.descr = "|u1", .shape = shape_of(frame), .bytes = std::string(cells.begin(), cells.end())};
}

NpyArray doubles_array(const std::vector<double>& values, std::vector<std::size_t> shape) {
  std::string bytes(values.size() * sizeof(double), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return {.descr = "<f8", .shape = std::move(shape), .bytes = std::move(bytes)};
}

std::vector<double> doubles(const NpyArray& array) {
  std::vector<double> values(array.bytes.size() / sizeof(double));
  std::memcpy(values.data(), array.bytes.data(), values.size() * sizeof(double));
  return values;
}

std::vector<std::uint8_t> cells_of(const NpyArray& array, std::uint8_t largest, const std::string& name) {
  expect_descr(array, "|u1", name);
  std::vector<std::uint8_t> cells(array.bytes.begin(), array.bytes.end());
  for (const std::uint8_t cell : cells) {
    if (cell > largest) throw DataError(fmt::format("{}: holds {}, the largest value is {}", name, cell, largest));
  }
  return cells;
}

std::map<std::string, NpyArray> arrays_of(const OccupancyGrid& grid) {
  const GridFrame& frame = grid.frame;
  std::map<std::string, NpyArray> arrays;
  arrays["occupancy"] = bytes_array(frame, grid.occupancy);
  arrays["observable"] =
      bytes_array(frame, grid.observable.empty() ? std::vector<std::uint8_t>(frame.cells(), 0) : grid.observable);
  arrays["origin"] = doubles_array({frame.origin_m.x(), frame.origin_m.y(), frame.origin_m.z()}, {3});
  arrays["resolution"] = doubles_array({frame.resolution_m}, {});
  arrays["axis_order"] = npy_text("z,y,x");
  arrays["frame"] = npy_text("world ENU, metres, z up; origin is the minimum corner of cell [0,0,0]");
  arrays["classes"] = npy_text("0 free, 1 surface, 2 interior");
  return arrays;
}

/// Arrays of a file, among them those that are needed.
std::map<std::string, NpyArray> read_arrays(const std::filesystem::path& path, const char* cells, const char* kind) {
  std::map<std::string, NpyArray> arrays = read_npz(path);
  for (const char* needed : {cells, "origin", "resolution"}) {
    if (!arrays.contains(needed)) {
      throw DataError(fmt::format("{}: {} is missing; is it {}?", path.string(), needed, kind));
    }
  }
  return arrays;
}

/// The frame that an array of cells lies in.
GridFrame frame_of(const std::map<std::string, NpyArray>& arrays, const char* name, const std::string& path) {
  const NpyArray& cells = arrays.at(name);
  const auto named = [&](const std::string& array) { return path + ": " + array; };
  if (cells.shape.size() != 3) throw DataError(named(name) + " must have the three axes [z, y, x]");
  GridFrame frame;
  for (int a = 0; a < 3; ++a) {
    const std::size_t n = cells.shape[2 - a];
    if (n == 0 || n > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw DataError(fmt::format("{} has {} cells on an axis", named(name), n));
    }
    frame.size[a] = static_cast<int>(n);
  }
  expect_descr(arrays.at("origin"), "<f8", named("origin"));
  expect_descr(arrays.at("resolution"), "<f8", named("resolution"));
  const std::vector<double> origin = doubles(arrays.at("origin"));
  const std::vector<double> resolution = doubles(arrays.at("resolution"));
  if (origin.size() != 3 || resolution.size() != 1) {
    throw DataError(path + ": origin must hold 3 numbers and resolution 1");
  }
  frame.origin_m = Vec3(origin[0], origin[1], origin[2]);
  frame.resolution_m = resolution[0];
  if (!frame.origin_m.allFinite() || !(resolution[0] > 0) || !std::isfinite(resolution[0])) {
    throw DataError(path + ": origin must be finite and resolution positive");
  }
  return frame;
}

}  // namespace

void write_grid_npz(const OccupancyGrid& grid, const std::filesystem::path& path) { write_npz(path, arrays_of(grid)); }

OccupancyGrid read_grid_npz(const std::filesystem::path& path) {
  const std::map<std::string, NpyArray> arrays = read_arrays(path, "occupancy", "an occupancy grid");
  const auto named = [&](const std::string& name) { return path.string() + ": " + name; };
  OccupancyGrid grid;
  const NpyArray& occupancy = arrays.at("occupancy");
  grid.occupancy = cells_of(occupancy, 2, named("occupancy"));
  grid.frame = frame_of(arrays, "occupancy", path.string());
  if (arrays.contains("observable")) {
    const NpyArray& observable = arrays.at("observable");
    if (observable.shape != occupancy.shape) throw DataError(named("observable") + " and occupancy differ in shape");
    grid.observable = cells_of(observable, 1, named("observable"));
  }
  return grid;
}

void write_map_npz(const LogOddsMap& map, const std::filesystem::path& path) {
  std::map<std::string, NpyArray> arrays = arrays_of(occupancy_of(map));
  std::string bytes(map.log_odds.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), map.log_odds.data(), bytes.size());
  arrays["log_odds"] = {.descr = "<f4", .shape = shape_of(map.frame), .bytes = std::move(bytes)};
  arrays["log_odds_sign"] = npy_text("natural log-odds, positive occupied, negative free, 0 unknown");
  arrays["classes"] = npy_text("0 free or unknown, 1 occupied; known where observable is 1");
  write_npz(path, arrays);
}

LogOddsMap read_map_npz(const std::filesystem::path& path) {
  const std::map<std::string, NpyArray> arrays = read_arrays(path, "log_odds", "a map");
  const NpyArray& cells = arrays.at("log_odds");
  expect_descr(cells, "<f4", path.string() + ": log_odds");
  LogOddsMap map{frame_of(arrays, "log_odds", path.string()), std::vector<float>(cells.bytes.size() / sizeof(float))};
  std::memcpy(map.log_odds.data(), cells.bytes.data(), cells.bytes.size());
  if (!is_finite(map)) throw DataError(path.string() + ": log_odds holds NaN or infinity; unknown cells hold 0");
  return map;
}

}  // namespace ensonify
