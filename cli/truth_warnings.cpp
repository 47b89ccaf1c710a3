#include "ensonify/cli/truth_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <map>
#include <set>

namespace ensonify::cli {
namespace {

void warn(const Scene& scene, const std::string& what) {
  fmt::print(std::cerr, "ensonify: warning: {}: {}\n", scene.name, what);
}

std::string box(const Eigen::AlignedBox3d& b) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m", b.min().x(), b.min().y(), b.min().z(),
                     b.max().x(), b.max().y(), b.max().z());
}

bool has_free_cell(const OccupancyGrid& grid, const Eigen::AlignedBox3d& box) {
  const GridFrame& frame = grid.frame;
  const auto low = frame.cell_of(box.min());
  const auto high = frame.cell_of(box.max());
  const auto within = [&](int axis, int cell) { return std::clamp(cell, 0, frame.size[axis] - 1); };
  for (int z = within(2, low[2]); z <= within(2, high[2]); ++z) {
    for (int y = within(1, low[1]); y <= within(1, high[1]); ++y) {
      for (int x = within(0, low[0]); x <= within(0, high[0]); ++x) {
        if (grid.occupancy[frame.index(x, y, z)] == static_cast<std::uint8_t>(Occupancy::free)) return true;
      }
    }
  }
  return false;
}

/// The name without its last _<number>; the name itself where it ends in none.
std::string stem_of(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789");
  const bool numbered = end != std::string::npos && end + 1 < name.size() && end > 0 && name[end] == '_';
  return numbered ? name.substr(0, end) : name;
}

/// Copies and parts are called after their object, <name>_0, <name>_1 and so on, parts of copies <name>_0_0.
class Objects {
 public:
  explicit Objects(const Scene& scene) {
    for (const Instance& instance : scene.instances) {
      for (std::string name = instance.name; names_.insert(name).second && stem_of(name) != name;) name = stem_of(name);
    }
  }
  std::string of(const Instance& instance) const {
    std::string name = instance.name;
    while (stem_of(name) != name && names_.contains(stem_of(name) + "_0")) name = stem_of(name);
    return name;
  }

 private:
  std::set<std::string> names_;
};

double lowest_z_m(const Scene& scene, const Instance& instance) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& v : scene.meshes[static_cast<std::size_t>(instance.mesh)].vertices_m) {
    lowest = std::min(lowest, (instance.T_world_object * v.cast<double>()).z());
  }
  return lowest;
}

}  // namespace

void warn_of_void(const Scene& scene, const VoxelTruth& truth) {
  struct Found {
    std::size_t cells = 0;
    bool below_top = false;  // what stands out of the water is no mistake
  };
  const Objects objects(scene);
  const bool afloat = std::ranges::any_of(scene.instances, [](const Instance& i) { return !i.obstacle; });
  std::map<std::string, Found> found;
  std::size_t at = 0;
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    const VoxelReport& report = truth.reports[at++];
    Found& object = found[objects.of(instance)];
    const std::size_t cells = report.surface_cells + report.interior_cells;
    object.cells += cells;
    if (cells == 0) object.below_top |= !afloat || lowest_z_m(scene, instance) < scene.bounds_m.max().z();
  }
  if (found.empty()) warn(scene, "nothing in it is an obstacle, so that all of the truth is free");
  for (const auto& [name, object] : found) {
    if (object.cells > 0 || !object.below_top) continue;
    warn(scene, fmt::format("{} has no cell in the truth: it lies outside of bounds, {}; move it, or widen bounds",
                            name, box(scene.bounds_m)));
  }
  if (!has_free_cell(truth.grid, scene.navigable_m)) {
    warn(scene,
         fmt::format("navigable, {}, has no free cell: it lies inside of something; move it", box(scene.navigable_m)));
  }
}

void warn_of_place(const Scene& scene, const Vec3& sonar_m, bool silent, double range_min_m, double range_max_m) {
  const std::string sonar = fmt::format("the sonar at ({:.4g}, {:.4g}, {:.4g})", sonar_m.x(), sonar_m.y(), sonar_m.z());
  const bool in_air = sonar_m.z() > 0.0 && scene.bounds_m.max().z() <= 0.0;
  const std::string above = fmt::format("{:.4g} m above the water (z is up, 0 at the surface)", sonar_m.z());
  if (in_air && !silent) warn(scene, fmt::format("{} is {}, and pings as if it were in it", sonar, above));
  if (!silent) return;
  std::string where = "turn it or move it nearer";
  if (in_air) {
    where = "it is " + above;
  } else if (!scene.bounds_m.contains(sonar_m)) {
    where = fmt::format("it is outside of the scene, {}", box(scene.bounds_m));
  }
  warn(scene, fmt::format("{} meets no surface within {:.4g} to {:.4g} m: {}", sonar, range_min_m, range_max_m, where));
}

}  // namespace ensonify::cli
