#include "ensonify/sim/voxelize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/sim/mesh_edges.hpp"
#include "ensonify/sim/outside_fill.hpp"
#include "ensonify/sim/voxel_parity.hpp"
#include "ensonify/sim/voxel_surface.hpp"

namespace ensonify {
namespace {

std::vector<Vec3> to_cells(const TriangleMesh& mesh, const Eigen::Affine3d& T_world_object, const GridFrame& frame) {
  std::vector<Vec3> cells(mesh.vertices_m.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = (T_world_object * mesh.vertices_m[i].cast<double>() - frame.origin_m) / frame.resolution_m;
    if (!cells[i].allFinite()) throw DataError(fmt::format("mesh vertex {} is not a finite point; repair the mesh", i));
  }
  return cells;
}

void check_indices(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (std::max({t[0], t[1], t[2]}) >= mesh.vertices_m.size()) {
      throw DataError(fmt::format("mesh triangle {} names vertex {} but there are {} vertices; repair the mesh", i,
                                  std::max({t[0], t[1], t[2]}), mesh.vertices_m.size()));
    }
  }
}

/// By the sign of the enclosed volume (divergence theorem).
bool turns_inwards(const std::vector<Vec3>& cells, const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = cells[t[0]] - cells[0];
    volume += a.dot((cells[t[1]] - cells[0]).cross(cells[t[2]] - cells[0]));
  }
  return volume < 0;
}

/// The box of the grid that the points touch, one cell wider on every side; size 0 where there is none.
std::pair<std::array<int, 3>, std::array<int, 3>> padded_box(const std::vector<Vec3>& cells, const GridFrame& frame) {
  std::array<int, 3> low{};
  std::array<int, 3> size{};
  Eigen::AlignedBox3d box;
  for (const Vec3& p : cells) box.extend(p);
  for (int a = 0; a < 3; ++a) {
    const double last = frame.size[a] - 1.0;
    const double from = std::max(std::floor(box.min()[a] - surface_margin_cells), 0.0);
    const double to = std::min(std::floor(box.max()[a] + surface_margin_cells), last);
    if (!(from <= to)) return {};
    low[a] = static_cast<int>(from) - 1;
    size[a] = static_cast<int>(to) - low[a] + 2;
  }
  return {low, size};
}

/// Empties the rim of the box, which may lie outside of the grid.
void clear_rim(BitGrid& bits) {
  const int last_x = bits.size[0] - 1;
  for (int z = 0; z < bits.size[2]; ++z) {
    for (int y = 0; y < bits.size[1]; ++y) {
      std::uint64_t* row = bits.row(y, z);
      if (y == 0 || z == 0 || y == bits.size[1] - 1 || z == bits.size[2] - 1) {
        std::fill_n(row, bits.row_words, 0);
      } else {
        row[0] &= ~std::uint64_t{1};
        row[last_x >> 6] &= ~(std::uint64_t{1} << (last_x & 63));
      }
    }
  }
}

void remove(BitGrid& from, const BitGrid& what) {
  for (std::size_t i = 0; i < from.words.size(); ++i) from.words[i] &= ~what.words[i];
}

/// Adds an object to the occupancy: interior wins over surface, surface over free.
void add(const ObjectVoxels& object, OccupancyGrid& grid) {
  const BitGrid& s = object.surface;
  parallel_for(std::max(s.size[2] - 2, 0), [&](int slab) {
    const int z = slab + 1;
    for (int y = 1; y + 1 < s.size[1]; ++y) {
      const std::uint64_t* surface = s.row(y, z);
      const std::uint64_t* interior = object.interior.row(y, z);
      const std::size_t row = grid.frame.index(0, s.low[1] + y, s.low[2] + z);
      for (int i = 0; i < s.row_words; ++i) {
        // Index of bit 0; wraps for the rim cell left of the grid, whose bit is never set.
        const std::size_t base = row + static_cast<std::size_t>(static_cast<std::ptrdiff_t>(s.low[0]) + 64 * i);
        if (interior[i] == ~std::uint64_t{0}) {
          std::memset(grid.occupancy.data() + base, static_cast<int>(Occupancy::interior), 64);
          continue;
        }
        for (std::uint64_t bits = surface[i]; bits; bits &= bits - 1) {
          std::uint8_t& cell = grid.occupancy[base + static_cast<std::size_t>(std::countr_zero(bits))];
          cell = std::max(cell, static_cast<std::uint8_t>(Occupancy::surface));
        }
        for (std::uint64_t bits = interior[i]; bits; bits &= bits - 1) {
          grid.occupancy[base + static_cast<std::size_t>(std::countr_zero(bits))] =
              static_cast<std::uint8_t>(Occupancy::interior);
        }
      }
    }
  });
}

}  // namespace

GridFrame frame_over(const Eigen::AlignedBox3d& bounds_m, double resolution_m, std::size_t max_cells) {
  if (!(resolution_m > 0) || !std::isfinite(resolution_m)) {
    throw ConfigError(fmt::format("grid resolution is {} m; it must be positive, e.g. 0.1", resolution_m));
  }
  const Vec3 extent = bounds_m.max() - bounds_m.min();
  if (!extent.allFinite() || !(extent.minCoeff() > 0)) {
    throw ConfigError(fmt::format("grid bounds {} x {} x {} m hold no volume; every side must be positive and finite",
                                  extent.x(), extent.y(), extent.z()));
  }
  // Borders within a millionth of a cell of a multiple are that multiple: -0.3 / 0.1 is not -3 in binary.
  const auto borders = [&](double resolution) {
    const Vec3 low = (bounds_m.min() / resolution).array() + 1e-6;
    const Vec3 high = (bounds_m.max() / resolution).array() - 1e-6;
    return std::pair<Vec3, Vec3>(low.array().floor(), high.array().ceil());
  };
  const auto cells = [&](double resolution) {
    const auto [low, high] = borders(resolution);
    return (high - low).cwiseMax(1.0).prod();
  };
  if (!(cells(resolution_m) <= static_cast<double>(max_cells))) {
    const double least = std::cbrt(extent.prod() / static_cast<double>(max_cells));
    double fits = std::max(least, resolution_m);
    while (cells(fits) > static_cast<double>(max_cells)) fits *= 1.01;
    const double step = std::pow(10.0, std::floor(std::log10(fits)) - 1);
    double rounded = std::ceil(fits / step) * step;
    while (cells(rounded) > static_cast<double>(max_cells)) rounded += step;
    throw ConfigError(
        fmt::format("a grid of {} x {} x {} m at {} m has {:.0f} cells, more than {}; a resolution of {:.3g} m fits",
                    extent.x(), extent.y(), extent.z(), resolution_m, cells(resolution_m), max_cells, rounded));
  }
  const auto [low, high] = borders(resolution_m);
  GridFrame frame{.origin_m = low * resolution_m, .resolution_m = resolution_m};
  for (int a = 0; a < 3; ++a) frame.size[a] = std::max(1, static_cast<int>(high[a] - low[a]));
  return frame;
}

ObjectVoxels voxelize_object(const TriangleMesh& mesh, const Eigen::Affine3d& T_world_object, const GridFrame& frame) {
  check_indices(mesh);
  const std::vector<Vec3> cells = to_cells(mesh, T_world_object, frame);
  const EdgeCount edges = count_edges(mesh);
  ObjectVoxels object;
  VoxelReport& report = object.report;
  report.triangles = mesh.triangles.size();
  report.open_edges = edges.open;
  report.nonmanifold_edges = edges.nonmanifold;
  report.watertight = edges.watertight();

  const auto [low, size] = padded_box(cells, frame);
  if (size[0] == 0) return object;
  object.surface = BitGrid(low, size);
  report.unlike_edges = edges.unlike;
  report.inside_out = report.watertight && edges.unlike == 0 && turns_inwards(cells, mesh);
  auto outward = mesh.triangles;
  if (report.inside_out) {
    for (auto& t : outward) std::swap(t[1], t[2]);
  }
  mark_surface(cells, outward, object.surface);
  ParityVote vote = vote_parity(cells, mesh.triangles, low, size);
  clear_rim(vote.disagreement);
  clear_rim(vote.inside);
  remove(vote.disagreement, object.surface);
  remove(vote.inside, object.surface);
  object.interior = std::move(vote.inside);
  report.surface_cells = object.surface.count();
  report.interior_cells = object.interior.count();
  report.parity_disagreements = vote.disagreement.count();

  const bool parity_holds = report.watertight || report.parity_disagreements * 100 <= report.interior_cells;
  if (!parity_holds) {
    report.method = SolidMethod::outside_fill;
    object.interior = enclosed_by(object.surface);
    report.interior_cells = object.interior.count();
  }
  return object;
}

VoxelTruth voxelize(const Scene& scene, double resolution_m, std::size_t max_cells) {
  VoxelTruth truth;
  truth.grid.frame = frame_over(scene.bounds_m, resolution_m, max_cells);
  truth.grid.occupancy.assign(truth.grid.frame.cells(), static_cast<std::uint8_t>(Occupancy::free));
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) {
      throw ConfigError(fmt::format("scene {}: instance {} names mesh {} but there are {}", scene.name, instance.name,
                                    instance.mesh, scene.meshes.size()));
    }
    ObjectVoxels object;
    try {
      object = voxelize_object(scene.meshes[instance.mesh], instance.T_world_object, truth.grid.frame);
    } catch (const DataError& error) {
      throw DataError(fmt::format("scene {}: instance {}: {}", scene.name, instance.name, error.what()));
    }
    object.report.name = instance.name;
    add(object, truth.grid);
    truth.reports.push_back(std::move(object.report));
  }
  return truth;
}

}  // namespace ensonify
