#include <fmt/format.h>

#include <memory>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/cli/truth_warnings.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/sim/voxelize.hpp"

namespace ensonify::cli {
namespace {

struct Arguments {
  std::string scene;
  std::uint64_t layout = 0;
  double resolution_m = 0;
  std::string out;
  std::optional<double> slice_z_m;
};

void run(const Arguments& a) {
  const Scene scene = open_scene(a.scene, a.layout);
  const VoxelTruth truth = voxelize(scene, a.resolution_m);
  write_unbroken(std::filesystem::path(a.out).parent_path(), [&] {
    write_grid(truth.grid, a.out, {a.slice_z_m, false});
  });
  const GridFrame& frame = truth.grid.frame;
  std::size_t surface = 0;
  std::size_t interior = 0;
  for (const std::uint8_t cell : truth.grid.occupancy) {
    surface += cell == static_cast<std::uint8_t>(Occupancy::surface);
    interior += cell == static_cast<std::uint8_t>(Occupancy::interior);
  }
  fmt::print("{} x {} x {} cells of {} m: {} surface, {} interior, {} free -> {}\n", frame.size[0], frame.size[1],
             frame.size[2], frame.resolution_m, surface, interior, frame.cells() - surface - interior, a.out);
  std::size_t at = 0;
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    const VoxelReport& report = truth.reports[at++];
    if (!report.watertight || report.parity_disagreements > 0) {
      fmt::print("  {}: {}\n", instance.name, report.describe());
    }
  }
  warn_of_void(scene, truth);
}

}  // namespace

void add_voxelize(CLI::App& app) {
  auto* command = app.add_subcommand("voxelize", "Ground-truth occupancy of a scene or a mesh");
  auto a = std::make_shared<Arguments>();
  command->add_option("SCENE_OR_MESH", a->scene, "Scene YAML, bundled name, or a mesh file")->required();
  command->add_option("--resolution", a->resolution_m, "Edge of a cell in metres")->required()->check(above_zero());
  command->add_option("--out", a->out, "File: .npz, .bt (OctoMap), .pgm (nav2, with .yaml), .ply or .vdb")
      ->required()
      ->check(some_path());
  command->add_option("--layout", a->layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  command->add_option("--slice-z", a->slice_z_m, ".pgm: height of the slice in metres (default: middle of the grid)");
  command->footer("Example:\n  ensonify voxelize test_tank --resolution 0.05 --out out/tank.npz");
  command->callback([a] { run(*a); });
}

}  // namespace ensonify::cli
