#include "ensonify/output/trajectory_file.hpp"

#include <fmt/format.h>

#include "ensonify/output/atomic_file.hpp"

namespace ensonify {

void write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (T_world_sonar, metres, ENU)\n";
  for (const StampedPose& stamped : poses) {
    const Vec3 t = stamped.T_world_sonar.translation();
    const Eigen::Quaterniond q(stamped.T_world_sonar.rotation());
    text += fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", stamped.time_s, t.x(), t.y(),
                        t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_file(path, text);
}

}  // namespace ensonify
