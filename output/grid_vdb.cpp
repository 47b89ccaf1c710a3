#include "ensonify/output/grid_vdb.hpp"

#ifdef ENSONIFY_HAS_OPENVDB

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <sstream>

#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

/// Every cell that is not 0, as a sparse grid.
template <typename Grid>
typename Grid::Ptr to_vdb(const GridFrame& frame, const std::vector<std::uint8_t>& cells, const char* name) {
  auto grid = Grid::create();
  auto accessor = grid->getAccessor();
  for (int z = 0; z < frame.size[2]; ++z) {
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = 0; x < frame.size[0]; ++x) {
        const std::uint8_t value = cells[frame.index(x, y, z)];
        if (value) accessor.setValue({x, y, z}, static_cast<typename Grid::ValueType>(value));
      }
    }
  }
  openvdb::tools::prune(grid->tree());
  auto transform = openvdb::math::Transform::createLinearTransform(frame.resolution_m);
  const Vec3 first = frame.centre_m(0, 0, 0);
  transform->postTranslate(openvdb::Vec3d(first.x(), first.y(), first.z()));
  grid->setTransform(transform);
  grid->setName(name);
  return grid;
}

}  // namespace

void write_grid_vdb(const OccupancyGrid& grid, const std::filesystem::path& path) {
  openvdb::initialize();
  openvdb::GridCPtrVec grids = {to_vdb<openvdb::FloatGrid>(grid.frame, grid.occupancy, "occupancy")};
  if (!grid.observable.empty()) {
    grids.push_back(to_vdb<openvdb::BoolGrid>(grid.frame, grid.observable, "observable"));
  }
  std::ostringstream bytes;
  openvdb::io::Stream(bytes).write(grids);
  write_file(path, bytes.view());
}

}  // namespace ensonify

#else

#include <fmt/format.h>

#include "ensonify/core/error.hpp"

namespace ensonify {

void write_grid_vdb(const OccupancyGrid&, const std::filesystem::path& path) {
  throw DataError(
      fmt::format("can not write {}: built without OpenVDB; install libopenvdb-dev and libboost-dev and "
                  "rebuild, or write .npz, .bt, .ply or .pgm",
                  path.string()));
}

}  // namespace ensonify

#endif
