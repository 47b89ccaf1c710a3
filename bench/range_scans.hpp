#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

#include "ensonify/mapping/insert_scan.hpp"

namespace ensonify::bench {

/// Range scans of a closed room, from the shared folder of benchmark data (ENSONIFY_SHARED, else ../shared beside the
/// source tree): file format SCN1, little endian. Rays without a hit end at twice the maximum range.
struct RangeScans {
  float resolution_m = 0;
  float max_range_m = 0;
  std::size_t rays = 0;
  std::vector<RangeScan> scans;
};

inline std::filesystem::path room_scans_path() {
  const char* shared = std::getenv("ENSONIFY_SHARED");
  const std::filesystem::path folder =
      shared ? std::filesystem::path(shared)
             : std::filesystem::path(__FILE__).parent_path().parent_path().parent_path() / "shared";
  return folder / "bench" / "mapping" / "room.scn";
}

/// None where the file is absent or of another format.
inline std::optional<RangeScans> read_range_scans(const std::filesystem::path& path) {
  struct Header {
    char magic[4];
    std::uint32_t scans, azimuths, elevations;
    float voxel_m, max_range_m, azimuth_min, azimuth_max, elevation_min, elevation_max;
    std::uint32_t reserved;
  } h{};
  static_assert(sizeof(Header) == 44);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(&h), sizeof h) || std::memcmp(h.magic, "SCN1", 4) != 0) return std::nullopt;
  RangeScans all;
  all.resolution_m = h.voxel_m;
  all.max_range_m = h.max_range_m;
  std::vector<float> range(std::size_t{h.azimuths} * h.elevations);
  for (std::uint32_t s = 0; s < h.scans; ++s) {
    float pose[7];
    file.read(reinterpret_cast<char*>(pose), sizeof pose);
    if (!file.read(reinterpret_cast<char*>(range.data()), static_cast<std::streamsize>(range.size() * sizeof(float)))) {
      return std::nullopt;
    }
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose[3], pose[4], pose[5], pose[6]).normalized();
    RangeScan scan;
    scan.origin_m = Vec3(pose[0], pose[1], pose[2]);
    scan.points_m.reserve(range.size());
    for (std::uint32_t e = 0; e < h.elevations; ++e) {
      const double el = h.elevation_min + (e + 0.5) * (h.elevation_max - h.elevation_min) / h.elevations;
      for (std::uint32_t a = 0; a < h.azimuths; ++a) {
        const double az = h.azimuth_min + (a + 0.5) * (h.azimuth_max - h.azimuth_min) / h.azimuths;
        const double r = range[std::size_t{e} * h.azimuths + a];
        const Vec3 ray(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el));
        scan.points_m.push_back(scan.origin_m + q * ray * (r <= h.max_range_m ? r : 2.0 * h.max_range_m));
      }
    }
    all.rays += scan.points_m.size();
    all.scans.push_back(std::move(scan));
  }
  return all;
}

}  // namespace ensonify::bench
