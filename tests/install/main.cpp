// A user of the installed library: one ping in a bundled scene with a bundled sonar.
#include <algorithm>
#include <iostream>

#include "ensonify/config/library.hpp"
#include "ensonify/generators/form_images.hpp"
#include "ensonify/sim/trace_ping.hpp"

int main() {
  using namespace ensonify;
  const Scene scene = load_scene("test_tank");
  const SonarModel sonar = load_sonar("holoocean", {.range_min_m = {}, .range_max_m = 6.0, .range_bins = 256});
  const RayScene rays(scene, default_isa);
  const Pose T_world_sonar = pose_from_xyz_rpy({1.0, 0.0, -1.5}, 0.0, 0.0, radians(-90.0));
  const Ping ping = PingTracer(rays, sonar, scene.water).trace(T_world_sonar);
  const ImageSettings settings{{"none", {}}, 0.0, 8};
  const PingImages images = form_images(Receiver(sonar), ping, settings, {});

  // Eigen's alignment must be the same on both sides of the library's border: the wall stands where the YAML says.
  const auto wall = std::find_if(scene.instances.begin(), scene.instances.end(),
                                 [](const Instance& instance) { return instance.name == "wall_south"; });
  const auto hits = ping.truth.first_hit_range_m.pixels();
  std::cout << "data " << library_folder("scenes").string() << "\n"
            << "wall_y_m " << wall->T_world_object.translation().y() << "\n"
            << "nearest_m " << *std::min_element(hits.begin(), hits.end()) << "\n"
            << "image " << images.raw.grey.rows() << " " << images.raw.grey.columns() << "\n"
            << "mask " << std::count(images.mask.pixels().begin(), images.mask.pixels().end(), 255) << "\n";
}
