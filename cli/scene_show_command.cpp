#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/trajectory.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/plot.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/scenes/scene_export.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"
#include "ensonify/sim/scene_view.hpp"

namespace ensonify::cli {
namespace {

constexpr double view_aspect = 1.5;

struct ShowArguments {
  std::string scene;
  std::uint64_t layout = 0;
  std::string out;
  std::string pose;
  std::string sonar = "oculus_m1200d_hf";
  double azimuth_deg = -120;
  double elevation_deg = 35;
  int width = 900;
};

using Line3 = std::vector<Vec3>;

/// The box's edges seen from above and from the side alike: one closed ring over all eight corners.
Line3 ring(const Eigen::AlignedBox3d& box) {
  using Box = Eigen::AlignedBox3d;
  return {box.corner(Box::BottomLeftFloor), box.corner(Box::BottomRightFloor), box.corner(Box::TopRightFloor),
          box.corner(Box::TopRightCeil),    box.corner(Box::TopLeftCeil),      box.corner(Box::BottomLeftCeil),
          box.corner(Box::BottomLeftFloor), box.corner(Box::TopLeftFloor),     box.corner(Box::TopLeftCeil)};
}

/// The scene's own path, as a vehicle swims it.
Line3 swum(const Scene& scene) {
  Line3 line;
  if (scene.waypoints.size() < 2) return line;
  const Trajectory trajectory(TrajectoryPoses{}, scene, RandomKey::from_seed(0));
  constexpr double step_m = 0.05;
  for (double t = 0; t <= 0.5 * trajectory.repeats_s(); t = trajectory.next_look_s(t, step_m)) {
    line.push_back(trajectory.path_at(t).translation());
  }
  return line;
}

/// Outline of the fan in its middle plane, then of its middle beam in elevation.
Line3 fan_outline(const SonarGeometry& g, const Pose& T_world_sonar) {
  constexpr int steps = 40;
  const auto at = [&](double azimuth, double elevation) {
    return Vec3(T_world_sonar * (g.range_max_m * Vec3(std::cos(elevation) * std::cos(azimuth),
                                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation))));
  };
  Line3 line{T_world_sonar.translation()};
  const double left = g.beam_azimuth_rad.front(), right = g.beam_azimuth_rad.back();
  for (int i = 0; i <= steps; ++i) line.push_back(at(left + (right - left) * i / steps, 0));
  line.push_back(T_world_sonar.translation());
  for (int i = 0; i <= steps; ++i) line.push_back(at(0, g.elevation_fov_rad * (static_cast<double>(i) / steps - 0.5)));
  line.push_back(T_world_sonar.translation());
  return line;
}

Series projected(const Line3& line, int up_axis, Series::Style style, std::string name) {
  Series series{std::move(name), {}, {}, style};
  for (const Vec3& p : line) {
    series.x.push_back(p.x());
    series.y.push_back(p[up_axis]);
  }
  return series;
}

/// The scene from above (up_axis 1) or from the south (2), drawn to scale.
std::vector<std::uint8_t> draw_map(const Scene& scene, const ShowArguments& a, int up_axis) {
  const Eigen::AlignedBox3d& b = scene.bounds_m;
  const double across_m = b.sizes().x(), up_m = b.sizes()[up_axis] + (up_axis == 2 ? 1.0 : 0.0);
  Camera camera = up_axis == 1 ? plan_camera(scene) : side_camera(scene);
  if (up_axis == 2) camera.T_world_camera.translation().z() += 0.5;  // a metre of air above the water
  const int width = a.width, height = std::max(1, static_cast<int>(std::lround(width * up_m / across_m)));
  Plot plot;
  plot.title = fmt::format("{}, {}, layout {}", scene.name, up_axis == 1 ? "plan" : "side view", scene.layout);
  plot.x_label = "east [m]";
  plot.y_label = up_axis == 1 ? "north [m]" : "up [m]";
  plot.equal_scale = true;
  const double y_min = b.min()[up_axis], y_max = y_min + up_m;
  plot.x_range = {b.min().x(), b.max().x()};
  plot.y_range = {y_min, y_max};
  plot.backdrop = Backdrop{draw_scene(scene, camera, width, height), b.min().x(), b.max().x(), y_min, y_max};
  if (const Line3 path_m = swum(scene); !path_m.empty()) {
    plot.series.push_back(projected(path_m, up_axis, Series::Style::line, "waypoints"));
  }
  plot.series.push_back(projected(ring(scene.navigable_m), up_axis, Series::Style::thin_line, "navigable"));
  if (!a.pose.empty()) {
    const SonarModel sonar = load_sonar(a.sonar);
    plot.series.push_back(
        projected(fan_outline(sonar.geometry, parse_pose(a.pose)), up_axis, Series::Style::line, sonar.name));
  }
  return draw_plots({{plot}, 1, width + 120, height + 120});
}

void show(const ShowArguments& a) {
  const Scene scene = open_scene(a.scene, a.layout);
  const std::filesystem::path out = a.out;
  const std::vector<std::uint8_t> plan = draw_map(scene, a, 1), side = draw_map(scene, a, 2);
  const int height = static_cast<int>(a.width / view_aspect);
  const Camera camera = oblique_camera(scene, radians(a.azimuth_deg), radians(a.elevation_deg), view_aspect);
  const std::vector<std::uint8_t> view = encode_png(draw_scene(scene, camera, a.width, height));
  write_unbroken(out, [&] {
    write_file(out / "plan.png", plan);
    write_file(out / "side.png", side);
    write_file(out / "view.png", view);
  });
  fmt::print("{}: plan.png side.png view.png in {}\n", scene.name, a.out);
}

}  // namespace

void add_scene_show(CLI::App& scene_command) {
  auto* command = scene_command.add_subcommand("show", "Draw a scene: plan, side view and a view from outside");
  auto a = std::make_shared<ShowArguments>();
  command->add_option("SCENE", a->scene, "Scene YAML, bundled name, or a mesh file")->required();
  command->add_option("--out", a->out, "Folder for plan.png side.png view.png")->required()->check(some_path());
  command->add_option("--layout", a->layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  command->add_option("--pose", a->pose, "\"x y z roll pitch yaw\" of a sonar whose fan is drawn");
  command->add_option("--sonar", a->sonar, "Sonar YAML or bundled name of that fan")->capture_default_str();
  command->add_option("--azimuth", a->azimuth_deg, "Where the view is taken from, degrees from east to north")
      ->check(CLI::Range(-360.0, 360.0))
      ->capture_default_str();
  command->add_option("--elevation", a->elevation_deg, "And degrees above the horizon")
      ->check(CLI::Range(-89.0, 89.0))
      ->capture_default_str();
  command->add_option("--width", a->width, "Of the pictures, pixels")
      ->check(CLI::Range(100, 4000))
      ->capture_default_str();
  command->footer("Example:\n  ensonify scene show pier_harbor --out out/pier_harbor --pose \"11 5 -4 0 15 230\"");
  command->callback([a] { show(*a); });
}

void add_scene_export(CLI::App& scene_command) {
  auto* command = scene_command.add_subcommand("export", "Write a scene as one mesh file");
  struct Arguments {
    std::string scene;
    std::uint64_t layout = 0;
    std::string out;
    bool surface = false;
  };
  auto a = std::make_shared<Arguments>();
  command->add_option("SCENE", a->scene, "Scene YAML, bundled name, or a mesh file")->required();
  command->add_option("--out", a->out, "File: .glb (y up, with materials), .obj, .ply or .stl (z up); metres")
      ->required()
      ->check(some_path());
  command->add_option("--layout", a->layout, "Layout of the scene")->check(whole_number())->capture_default_str();
  command->add_flag("--surface", a->surface, "With the sea surface");
  command->footer("Example:\n  ensonify scene export marina --layout 2 --out out/marina.glb");
  command->callback([a] {
    const std::filesystem::path out = a->out;
    const Scene scene = open_scene(a->scene, a->layout);
    const std::vector<std::uint8_t> bytes = export_scene(scene, out.extension().string(), a->surface);
    write_unbroken(out.parent_path(), [&] { write_file(out, bytes); });
    fmt::print("{}: {:.1f} MB\n", a->out, static_cast<double>(bytes.size()) * 1e-6);
  });
}

}  // namespace ensonify::cli
