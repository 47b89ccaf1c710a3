#include "ensonify/output/trajectory_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_bytes = std::size_t{256} << 20;
constexpr std::size_t max_poses = 2'000'000;
constexpr std::string_view blank = " \t\r";

struct Line {
  const std::filesystem::path& path;
  int number;

  [[noreturn]] void fail(const std::string& rule) const {
    throw DataError(fmt::format("{}:{}: {}", path.string(), number, rule));
  }
};

/// What may stand in an error message of a text that may be anything.
std::string quoted(std::string_view word) {
  std::string text(word.substr(0, 32));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + text + "'";
}

std::array<double, 8> numbers_of(std::string_view text, const Line& line) {
  std::array<double, 8> values{};
  std::size_t count = 0;
  while (true) {
    const std::size_t start = text.find_first_not_of(blank);
    if (start == std::string_view::npos) break;
    text.remove_prefix(start);
    const std::string_view word = text.substr(0, text.find_first_of(blank));
    text.remove_prefix(word.size());
    if (count == values.size()) line.fail("has more than the 8 numbers 'time x y z qx qy qz qw'");
    double& value = values[count++];
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
      line.fail(fmt::format("{} is no finite number; a line is 'time x y z qx qy qz qw'", quoted(word)));
    }
  }
  if (count != values.size()) {
    line.fail(fmt::format("has {} numbers, not the 8 of 'time x y z qx qy qz qw'", count));
  }
  return values;
}

StampedPose pose_of(const std::array<double, 8>& v, const Line& line) {
  if (std::abs(v[0]) > 1e12) line.fail(fmt::format("time {} s is no time", v[0]));
  const Vec3 position(v[1], v[2], v[3]);
  if (position.cwiseAbs().maxCoeff() > 1e6) line.fail("the position lies more than 1000 km away; it must be in metres");
  const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
  if (!(std::abs(q.norm() - 1.0) < 0.01)) {
    line.fail(fmt::format("the quaternion (qx qy qz qw) has norm {:.4g}; it must be 1", q.norm()));
  }
  StampedPose stamped;
  stamped.time_s = v[0];
  stamped.T_world_sonar.linear() = q.normalized().toRotationMatrix();
  stamped.T_world_sonar.translation() = position;
  return stamped;
}

}  // namespace

void write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (T_world_sonar, metres, ENU)\n";
  for (const StampedPose& stamped : poses) {
    const Vec3 t = stamped.T_world_sonar.translation();
    const Eigen::Quaterniond q(stamped.T_world_sonar.rotation());
    text += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", stamped.time_s, t.x(), t.y(),
                        t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_file(path, text);
}

std::vector<StampedPose> read_tum(const std::filesystem::path& path) {
  const std::string text = read_text(path, max_bytes);
  std::vector<StampedPose> poses;
  Line line{path, 0};
  for (std::string_view rest = text; !rest.empty();) {
    ++line.number;
    const std::size_t end = rest.find('\n');
    const std::string_view here = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const std::size_t start = here.find_first_not_of(blank);
    if (start == std::string_view::npos || here[start] == '#') continue;
    const StampedPose pose = pose_of(numbers_of(here, line), line);
    if (!poses.empty() && !(pose.time_s > poses.back().time_s)) {
      line.fail(fmt::format("time {} s does not come after {} s; times must ascend", pose.time_s, poses.back().time_s));
    }
    if (poses.size() == max_poses) line.fail(fmt::format("more than {} poses; cut the file", max_poses));
    poses.push_back(pose);
  }
  if (poses.empty())
    throw DataError(fmt::format("{}: holds no pose; a line is 'time x y z qx qy qz qw'", path.string()));
  return poses;
}

}  // namespace ensonify
