#pragma once

#include <cstddef>
#include <vector>

#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/sim/bit_grid.hpp"
#include "ensonify/sim/voxel_report.hpp"

namespace ensonify {

/// Most cells a ground-truth grid may have unless the caller says otherwise.
constexpr std::size_t default_max_cells = 64'000'000;

/// Occupancy of one object in a box of the grid; both grids cover the same box, interior without surface cells.
struct ObjectVoxels {
  BitGrid surface;
  BitGrid interior;
  VoxelReport report;
};

/// Ground-truth occupancy of a scene and one report for each obstacle, in the order of the scene's instances.
struct VoxelTruth {
  OccupancyGrid grid;
  std::vector<VoxelReport> reports;
};

/// The grid over `bounds_m`: its borders are multiples of the resolution, as OctoMap's are, so that z = 0 is one.
/// Throws ConfigError: resolution not positive, bounds empty, or more than `max_cells` cells (names a resolution that
/// fits).
GridFrame frame_over(const Eigen::AlignedBox3d& bounds_m, double resolution_m,
                     std::size_t max_cells = default_max_cells);

/// Cells of `frame` that the mesh touches (surface) and those inside of it. A mesh whose edges all pair up is solid by
/// parity; so is one with holes too small to matter (the three axes disagree on at most 1 % of the inside). Any other
/// is a shell, filled with what the outside can not reach. Throws DataError on broken indices or coordinates.
ObjectVoxels voxelize_object(const TriangleMesh& mesh, const Eigen::Affine3d& T_world_object, const GridFrame& frame);

/// Union of all obstacles over the scene's bounds, parallel, same bits for any number of threads. A surface cell that
/// lies wholly inside another solid is interior.
VoxelTruth voxelize(const Scene& scene, double resolution_m, std::size_t max_cells = default_max_cells);

}  // namespace ensonify
