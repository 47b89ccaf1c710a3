#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/fan_view.hpp"
#include "ensonify/output/sha256.hpp"
#include "ensonify/output/tar_shard.hpp"
#include "ensonify/output/trajectory_file.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class Files : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("ensonify_shards_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

using Tar = Files;
using Atomic = Files;
using Tum = Files;

void fill(const fs::path& path) {
  TarShard shard(path);
  shard.add("000000.raw.png", Bytes{1, 2, 3});
  shard.add("000000.json", Bytes{});
  shard.add("000001.raw.png", Bytes(100'000, 7));
  shard.finish();
}

TEST_F(Tar, RoundTripInOrder) {
  fill(folder / "a.tar");
  std::vector<std::pair<std::string, Bytes>> members;
  read_tar(folder / "a.tar", [&](const std::string& name, const Bytes& bytes) { members.emplace_back(name, bytes); });
  ASSERT_EQ(members.size(), 3u);
  EXPECT_EQ(members[0], (std::pair<std::string, Bytes>{"000000.raw.png", {1, 2, 3}}));
  EXPECT_TRUE(members[1].second.empty());
  EXPECT_EQ(members[2].second, Bytes(100'000, 7));
}

TEST_F(Tar, SameSamplesSameBytes) {
  fill(folder / "a.tar");
  fs::last_write_time(folder / "a.tar", fs::last_write_time(folder / "a.tar") - std::chrono::hours(100));
  fill(folder / "b.tar");
  EXPECT_EQ(read_file(folder / "a.tar"), read_file(folder / "b.tar"));
}

TEST_F(Tar, UnfinishedLeavesNothing) {
  {
    TarShard shard(folder / "a.tar");
    shard.add("x", Bytes{1});
    EXPECT_FALSE(fs::exists(folder / "a.tar"));
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(Tar, GarbageAndTruncation) {
  const auto ignore = [](const std::string&, const Bytes&) {};
  write_file(folder / "garbage.tar", std::string(5000, 'x'));
  EXPECT_THROW(read_tar(folder / "garbage.tar", ignore), DataError);
  EXPECT_THROW(read_tar(folder / "missing.tar", ignore), DataError);
  fill(folder / "a.tar");
  const auto whole = read_file(folder / "a.tar");
  write_file(folder / "cut.tar", std::span(whole).first(50'000));
  EXPECT_THROW(read_tar(folder / "cut.tar", ignore), DataError);
}

// FIPS 180-2, appendix B.
TEST(Sha256, KnownAnswers) {
  EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256().add("abc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256().add("abcdbcdecdefdefgefghfghighijhi").add("jkijkljklmklmnlmnomnopnopq").hex(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256().add(std::string(1'000'000, 'a')).hex(),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(Atomic, OldOrNewNeverHalf) {
  write_file(folder / "deep/er/a.txt", "old");
  EXPECT_EQ(read_text(folder / "deep/er/a.txt"), "old");
  EXPECT_THROW(write_atomically(folder / "deep/er/a.txt",
                                [](const fs::path& temporary) {
                                  write_file(temporary, std::string_view("half"));
                                  throw std::runtime_error("power cut");
                                }),
               std::runtime_error);
  EXPECT_EQ(read_text(folder / "deep/er/a.txt"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "deep/er"), fs::directory_iterator()), 1);
  EXPECT_THROW(read_text(folder / "deep/er/a.txt", 2), DataError);  // larger than allowed
  EXPECT_THROW(read_text(folder / "none"), DataError);
}

// One line a pose: time tx ty tz qx qy qz qw. Yaw of 90 deg is (0, 0, sin 45, cos 45).
TEST_F(Tum, Text) {
  Pose pose = pose_from_xyz_rpy({1.5, -2.25, -3.0}, 0, 0, radians(90.0));
  write_tum(folder / "a.txt", {{0.0, Pose::Identity()}, {0.5, pose}});
  EXPECT_EQ(read_text(folder / "a.txt"),
            "# timestamp tx ty tz qx qy qz qw (T_world_sonar, metres, ENU)\n"
            "0.000000000 0.000000000 0.000000000 0.000000000 0.000000000000 0.000000000000 0.000000000000 "
            "1.000000000000\n"
            "0.500000000 1.500000000 -2.250000000 -3.000000000 0.000000000000 0.000000000000 0.707106781187 "
            "0.707106781187\n");
}

TEST_F(Tum, RoundTrip) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 50; ++i) {
    poses.push_back({i / 3.0, pose_from_xyz_rpy({0.1 * i, -7.0 / (i + 1), -3}, 0.1 * i, 0.02 * i, 3.0 - 0.7 * i)});
  }
  write_tum(folder / "a.txt", poses);
  const auto back = read_tum(folder / "a.txt");
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(back[i].time_s, poses[i].time_s, 1e-9);
    EXPECT_LT((back[i].T_world_sonar.matrix() - poses[i].T_world_sonar.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_F(Tum, TakesWhatOthersWrite) {
  write_file(folder / "a.txt",
             "# made elsewhere\r\n\r\n  1.7e9\t1 2 -3 0 0 0.995 0.0998\r\n1700000000.5 1 2 -3 0 0 0 -1");
  const auto poses = read_tum(folder / "a.txt");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].time_s - poses[0].time_s, 0.5);
  EXPECT_NEAR(poses[0].T_world_sonar.linear().determinant(), 1.0, 1e-12);
  EXPECT_TRUE(poses[1].T_world_sonar.linear().isIdentity(1e-12));
}

TEST_F(Tum, RefusesWithFileAndLine) {
  const std::string good = "0 0 0 -1 0 0 0 1\n";
  const std::vector<std::pair<std::string, std::string>> broken{
      {"", "holds no pose"},
      {"# only words\n\n", "holds no pose"},
      {good + "1 0 0 -1 0 0 0\n", "a.txt:2: has 7 numbers"},
      {good + "1 0 0 -1 0 0 0 1 5\n", "a.txt:2: has more than the 8"},
      {good + "# c\n1 0 x -1 0 0 0 1\n", "a.txt:3: 'x' is no finite number"},
      {good + "1,0,0,-1,0,0,0,1\n", "a.txt:2: '1,0,0,-1,0,0,0,1' is no finite"},
      {good + "1 nan 0 -1 0 0 0 1\n", "a.txt:2: 'nan' is no finite"},
      {good + "inf 0 0 -1 0 0 0 1\n", "'inf' is no finite"},
      {good + "1 1e999 0 -1 0 0 0 1\n", "'1e999' is no finite"},
      {good + "1 1e7 0 -1 0 0 0 1\n", "a.txt:2: the position lies"},
      {good + "1 0 0 -1 0 0 0 0\n", "a.txt:2: the quaternion (qx qy qz qw) has norm 0"},
      {good + "1 0 0 -1 0 0 0 2\n", "norm 2; it must be 1"},
      {good + "0 0 0 -1 0 0 0 1\n", "a.txt:2: time 0 s does not come after 0 s"},
      {"1e300 0 0 -1 0 0 0 1\n", "a.txt:1: time"},
      {good + std::string("\0\x01\xff", 3) + "\n", "a.txt:2: '?"},
      {std::string(100'000, '7'), "a.txt:1: '77777777777777777777777777777777' is no finite"}};
  for (const auto& [text, fragment] : broken) {
    write_file(folder / "a.txt", text);
    try {
      read_tum(folder / "a.txt");
      ADD_FAILURE() << "accepted: " << text.substr(0, 60);
    } catch (const DataError& e) {
      EXPECT_NE(std::string(e.what()).find(fragment), std::string::npos) << e.what();
    }
  }
  EXPECT_THROW(read_tum(folder / "missing.txt"), DataError);
  fs::resize_file(folder / "a.txt", std::size_t{300} << 20);  // sparse
  EXPECT_THROW(read_tum(folder / "a.txt"), DataError);
}

// A point at range r and azimuth theta is drawn r cos(theta) above the lower edge and r sin(theta) left of the middle,
// height / range_max pixels a metre.
/// 121 beams a degree apart, 1 to 9 m.
SonarGeometry wide_fan() {
  SonarGeometry g;
  g.range_min_m = 1.0;
  g.range_max_m = 9.0;
  g.range_bins = 160;
  for (int b = 0; b < 121; ++b) g.beam_azimuth_rad.push_back(radians(60.0 - b));
  return g;
}

TEST(FanView, BrightCellLandsWhereItBelongs) {
  const SonarGeometry g = wide_fan();
  const int height = 450;
  const double pixels_per_m = height / 9.0;
  for (const auto& [bin, beam] : {std::pair{100, 60}, std::pair{150, 10}, std::pair{60, 110}, std::pair{20, 60}}) {
    Image2<std::uint8_t> image(160, 121);
    image(bin, beam) = 255;
    const auto fan = fan_view(image, g, height);
    EXPECT_EQ(fan.rows(), height);
    EXPECT_EQ(fan.columns(), 2 * static_cast<int>(std::ceil(height * std::sin(radians(60.0)))));
    double u = 0, v = 0, sum = 0;
    for (int row = 0; row < fan.rows(); ++row) {
      for (int column = 0; column < fan.columns(); ++column) {
        u += fan(row, column) * (column + 0.5);
        v += fan(row, column) * (row + 0.5);
        sum += fan(row, column);
      }
    }
    ASSERT_GT(sum, 0.0);
    const double r = 1.0 + 0.05 * (bin + 0.5);
    const double theta = radians(60.0 - beam);
    EXPECT_NEAR(u / sum, fan.columns() / 2.0 - r * std::sin(theta) * pixels_per_m, 1.0) << bin << " " << beam;
    EXPECT_NEAR(v / sum, height - r * std::cos(theta) * pixels_per_m, 1.0) << bin << " " << beam;
  }
}

/// A smooth image survives both ways where neighbouring pixels of the fan lie within the fan.
TEST(FanView, BackToPolarIsTheImageItWasDrawnFrom) {
  const SonarGeometry g = wide_fan();
  Image2<float> image(160, 121);
  for (int k = 0; k < 160; ++k) {
    for (int b = 0; b < 121; ++b)
      image(k, b) = static_cast<float>(120.0 + 80.0 * std::sin(0.05 * k) * std::cos(0.04 * b));
  }
  const Image2<float> back = polar_view(fan_view(image, g, 720, Resampling::bilinear), g);
  ASSERT_EQ(back.rows(), 160);
  ASSERT_EQ(back.columns(), 121);
  for (int k = 2; k < 158; ++k) {
    for (int b = 2; b < 119; ++b) EXPECT_NEAR(back(k, b), image(k, b), 0.5F) << k << " " << b;
  }
  for (float& level : image.pixels()) level = level > 120.0F ? 255.0F : 0.0F;
  const Image2<float> mask = fan_view(image, g, 720, Resampling::nearest);
  EXPECT_TRUE(std::ranges::all_of(mask.pixels(), [](float level) { return level == 0.0F || level == 255.0F; }));
  EXPECT_THROW(polar_view(Image2<float>(720, 1000), g), DataError);
}

TEST(FanView, BlackOutsideOfTheFan) {
  SonarGeometry g;
  g.range_min_m = 2.0;
  g.range_max_m = 4.0;
  g.range_bins = 50;
  for (int b = 0; b < 61; ++b) g.beam_azimuth_rad.push_back(radians(30.0 - b));
  const auto fan = fan_view(Image2<std::uint8_t>(50, 61, 200), g, 200);
  for (int row = 0; row < fan.rows(); ++row) {
    for (int column = 0; column < fan.columns(); ++column) {
      const double x = (200 - row - 0.5) / 50.0;
      const double y = (fan.columns() / 2.0 - column - 0.5) / 50.0;
      const double r = std::hypot(x, y);
      const double theta = degrees(std::abs(std::atan2(y, x)));
      if (r < 1.95 || r > 4.05 || theta > 31.5) {
        EXPECT_EQ(fan(row, column), 0) << row << " " << column;
      }
      if (r > 2.1 && r < 3.9 && theta < 28.5) {
        EXPECT_EQ(fan(row, column), 200) << row << " " << column;
      }
    }
  }
}

}  // namespace
}  // namespace ensonify
