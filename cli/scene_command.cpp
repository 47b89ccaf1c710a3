#include <fmt/format.h>

#include <memory>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/truth_warnings.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/place.hpp"
#include "ensonify/sim/voxelize.hpp"

namespace ensonify::cli {
namespace {

std::size_t triangles(const Scene& scene) {
  std::size_t sum = 0;
  for (const Instance& instance : scene.instances) {
    sum += scene.meshes[static_cast<std::size_t>(instance.mesh)].triangles.size();
  }
  return sum;
}

void list() {
  for (const std::string& name : library_names("scenes")) fmt::print("{:<16} {}\n", name, load_scene(name).title);
}

void check(const std::string& path_or_name, std::uint64_t layout) {
  const Scene scene = open_scene(path_or_name, layout);
  const auto box = [](const Eigen::AlignedBox3d& b) {
    return fmt::format("({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f}) m", b.min().x(), b.min().y(), b.min().z(),
                       b.max().x(), b.max().y(), b.max().z());
  };
  Eigen::AlignedBox3d extent;
  for (const Instance& instance : scene.instances) {
    for (const Eigen::Vector3f& v : scene.meshes[static_cast<std::size_t>(instance.mesh)].vertices_m) {
      extent.extend(instance.T_world_object * v.cast<double>());
    }
  }
  const VoxelTruth truth = voxelize(scene, scene.grid_resolution_m);
  fmt::print(
      "{}: {}\n  {} objects, {} meshes, {} triangles\n  extent     {}\n  bounds     {}\n  navigable  {}\n"
      "  grid       {} x {} x {} cells of {} m\n  water      {:.1f} m/s\n",
      scene.name, scene.title, scene.instances.size(), scene.meshes.size(), triangles(scene), box(extent),
      box(scene.bounds_m), box(scene.navigable_m), truth.grid.frame.size[0], truth.grid.frame.size[1],
      truth.grid.frame.size[2], truth.grid.frame.resolution_m, sound_speed_mps(scene.water));
  std::size_t at = 0;
  std::size_t open = 0;
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    const VoxelReport& report = truth.reports[at++];
    open += !report.watertight;
    if (!report.watertight || report.inside_out || report.unlike_edges > 0)
      fmt::print("  {}: {}\n", instance.name, report.describe());
  }
  if (open == 0 && at > 0) fmt::print("  {}\n", at == 1 ? "watertight" : "all watertight");
  warn_of_void(scene, truth);
  for (std::size_t i = 0; i < scene.waypoints.size(); ++i) {
    if (has_room(truth.grid, scene.waypoints[i].translation(), 0.0)) continue;
    throw ConfigError(fmt::format("{}: waypoint {} lies inside something; move it", scene.name, i));
  }
  fmt::print("valid\n");
}

}  // namespace

void add_scene(CLI::App& app) {
  auto* command = app.add_subcommand("scene", "List, check, draw and export scenes");
  command->require_subcommand(1);
  command->footer(
      "Example:\n  ensonify scene list\n  ensonify scene check my_scene.yaml\n"
      "  ensonify scene show marina --out out/marina");
  auto* all = command->add_subcommand("list", "Names and titles of the bundled scenes");
  all->footer("Example:\n  ensonify scene list");
  all->callback(list);
  auto* sub = command->add_subcommand("check", "Load a scene or mesh and say what is in it, or what is wrong with it");
  auto scene = std::make_shared<std::string>();
  auto layout = std::make_shared<std::uint64_t>(0);
  sub->add_option("SCENE", *scene, "Scene YAML, bundled name, or a mesh file")->required();
  sub->add_option("--layout", *layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  sub->footer("Example:\n  ensonify scene check pier_harbor --layout 3");
  sub->callback([scene, layout] { check(*scene, *layout); });
  add_scene_show(*command);
  add_scene_export(*command);
}

}  // namespace ensonify::cli
