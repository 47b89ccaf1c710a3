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

NpyArray bytes_array(const GridFrame& frame, const std::vector<std::uint8_t>& cells) {
  return {.descr = "|u1",
          .shape = {static_cast<std::size_t>(frame.size[2]), static_cast<std::size_t>(frame.size[1]),
                    static_cast<std::size_t>(frame.size[0])},
          .bytes = std::string(cells.begin(), cells.end())};
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

}  // namespace

void write_grid_npz(const OccupancyGrid& grid, const std::filesystem::path& path) {
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
  write_npz(path, arrays);
}

OccupancyGrid read_grid_npz(const std::filesystem::path& path) {
  const std::map<std::string, NpyArray> arrays = read_npz(path);
  const auto named = [&](const std::string& name) { return path.string() + ": " + name; };
  for (const char* needed : {"occupancy", "origin", "resolution"}) {
    if (!arrays.contains(needed)) throw DataError(named(needed) + " is missing; is it an occupancy grid?");
  }

  OccupancyGrid grid;
  const NpyArray& occupancy = arrays.at("occupancy");
  grid.occupancy = cells_of(occupancy, 2, named("occupancy"));
  if (occupancy.shape.size() != 3) throw DataError(named("occupancy") + " must have the three axes [z, y, x]");
  for (int a = 0; a < 3; ++a) {
    const std::size_t n = occupancy.shape[2 - a];
    if (n == 0 || n > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw DataError(fmt::format("{} has {} cells on an axis", named("occupancy"), n));
    }
    grid.frame.size[a] = static_cast<int>(n);
  }
  if (arrays.contains("observable")) {
    const NpyArray& observable = arrays.at("observable");
    if (observable.shape != occupancy.shape) throw DataError(named("observable") + " and occupancy differ in shape");
    grid.observable = cells_of(observable, 1, named("observable"));
  }

  expect_descr(arrays.at("origin"), "<f8", named("origin"));
  expect_descr(arrays.at("resolution"), "<f8", named("resolution"));
  const std::vector<double> origin = doubles(arrays.at("origin"));
  const std::vector<double> resolution = doubles(arrays.at("resolution"));
  if (origin.size() != 3 || resolution.size() != 1) {
    throw DataError(path.string() + ": origin must hold 3 numbers and resolution 1");
  }
  grid.frame.origin_m = Vec3(origin[0], origin[1], origin[2]);
  grid.frame.resolution_m = resolution[0];
  if (!grid.frame.origin_m.allFinite() || !(resolution[0] > 0) || !std::isfinite(resolution[0])) {
    throw DataError(path.string() + ": origin must be finite and resolution positive");
  }
  return grid;
}

}  // namespace ensonify
