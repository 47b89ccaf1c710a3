#include "ensonify/generators/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/dataset_plan.hpp"
#include "support/small_places.hpp"

namespace ensonify {
namespace {

using namespace test;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

TEST_F(Frames, SameInAnyOrderAndAlone) {
  const Recipe r = recipe(head + "splits:\n" + random_split + swum_split);
  ASSERT_EQ(r.frames(), 11);
  const FrameMaker forward(r, default_isa);
  const FrameMaker backward(r, default_isa);
  std::vector<Frame> frames;
  for (int i = 0; i < r.frames(); ++i) frames.push_back(forward.make(i));
  for (int i = r.frames() - 1; i >= 0; --i) {
    const Frame other = backward.make(i);
    EXPECT_EQ(other.images.raw.grey, frames[i].images.raw.grey) << i;
    EXPECT_EQ(other.images.clean.grey, frames[i].images.clean.grey) << i;
    EXPECT_EQ(other.pose.T_world_sonar.matrix(), frames[i].pose.T_world_sonar.matrix()) << i;
    EXPECT_EQ(other.pose.T_world_sonar_est.matrix(), frames[i].pose.T_world_sonar_est.matrix()) << i;
    EXPECT_EQ(other.pose.sampled, frames[i].pose.sampled) << i;
  }
  const FrameMaker alone(r, default_isa);
  EXPECT_EQ(alone.make(7).images.raw.grey, frames[7].images.raw.grey);
  EXPECT_NE(frames[0].images.raw.grey, frames[2].images.raw.grey);
  // What distributions gave is recorded and kept.
  for (const Frame& f : frames) {
    const auto value = [&](const std::string& name) {
      const auto at =
          std::find_if(f.pose.sampled.begin(), f.pose.sampled.end(), [&](const auto& s) { return s.first == name; });
      return at == f.pose.sampled.end() ? -1e9 : at->second;
    };
    EXPECT_EQ(value("sonar.range_max_m"), f.sonar.geometry.range_max_m);
    EXPECT_GE(value("sonar.range_max_m"), 4.0);
    EXPECT_LE(value("sonar.range_max_m"), 6.0);
    EXPECT_LE(std::abs(value("sonar.gain_db")), 3.0);
  }
  // Random poses take the places in turn, have no time and no drift; trajectories run at 0.5 m/s and 2 Hz, from rest:
  // rounding by 1 m leaves them 5/16 m behind.
  EXPECT_EQ(frames[0].pose.place, 0);
  EXPECT_EQ(frames[1].pose.place, 1);
  EXPECT_FALSE(frames[0].pose.time_s.has_value());
  EXPECT_EQ(frames[0].pose.T_world_sonar.matrix(), frames[0].pose.T_world_sonar_est.matrix());
  EXPECT_EQ(frames[8].pose.place, 2);
  EXPECT_EQ(frames[8].pose.number, 2);
  EXPECT_EQ(frames[8].pose.time_s, 1.0);
  EXPECT_TRUE(frames[6].pose.T_world_sonar.translation().isApprox(Vec3(-2, -2, -2), 1e-9));
  EXPECT_TRUE(frames[10].pose.T_world_sonar.translation().isApprox(Vec3(-2, -1 - 5.0 / 16, -2), 1e-9));
  EXPECT_TRUE(frames[6].pose.T_world_sonar_est.isApprox(frames[6].pose.T_world_sonar, 1e-12));  // no drift at t = 0
}

// A range that jumped from ping to ping would give an instrument that nobody swims with, and a map's pings other cells.
TEST_F(Frames, AnInstrumentKeepsItsWindowAlongATrajectory) {
  write("way2.yaml",
        "title: way2\n" + small_place + "waypoints:\n  - [-2, -2, -2, 0, 0, 0]\n  - [-2, 2, -2, 0, 0, 0]\n");
  std::string text = head + "splits:\n" + random_split + swum_split;
  text.replace(text.find("{uniform: [4, 6]}"), 17, "{uniform: [4, 9]}");
  text.replace(text.find("frames: 5"), 9, "frames: 6");
  text.replace(text.find("{scene: way.yaml}"), 17, "{scene: way.yaml}, {scene: way2.yaml}");
  const FrameMaker maker(recipe(text), default_isa);
  std::vector<double> range_max_m;
  for (int i = 0; i < 12; ++i) range_max_m.push_back(maker.sonar_for(i).geometry.range_max_m);
  EXPECT_EQ(std::set<double>(range_max_m.begin(), range_max_m.begin() + 6).size(), 6u);  // random poses: one each
  EXPECT_EQ(std::set<double>(range_max_m.begin() + 6, range_max_m.begin() + 9).size(), 1u);
  EXPECT_EQ(std::set<double>(range_max_m.begin() + 9, range_max_m.end()).size(), 1u);
  EXPECT_NE(range_max_m[6], range_max_m[9]);
  for (const int i : {1, 7, 11}) EXPECT_EQ(maker.make(i).sonar.geometry.range_max_m, range_max_m[i]) << i;
}

TEST_F(Frames, TrajectoryIntoAnObjectIsAConfigErrorWithItsPlace) {
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("way.yaml"), 8, "into.yaml");
  text.replace(text.find("frames: 5"), 9, "frames: 10");
  // 0.25 m a frame from x = -2, the rounding 5/16 m behind: frame 9 is at -0.0625, the block begins at -0.5.
  const FrameMaker maker(recipe(text), default_isa);
  EXPECT_NO_THROW(maker.pose(6));
  EXPECT_THAT(error_of([&] { maker.pose(9); }),
              AllOf(HasSubstr("into"), HasSubstr("(-0.06, 0.00, -2.00) m"), HasSubstr("4.5 s after its start"),
                    HasSubstr("move its waypoints")));
  // The check looks between the frames too: the block's first cell begins at -0.5.
  EXPECT_THAT(error_of([&] { maker.check_trajectory(0); }),
              AnyOf(HasSubstr("(-0.50, 0.00"), HasSubstr("(-0.46, 0.00")));
}

TEST_F(Frames, APathThatSlipsThroughBetweenItsFramesIsRefused) {
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("way.yaml"), 8, "into.yaml");
  text.replace(text.find("speed_mps: 0.5, rate_hz: 2"), 26, "speed_mps: 1.7, rate_hz: 0.5");  // 3.4 m a frame
  text.replace(text.find("frames: 5"), 9, "frames: 2");
  const FrameMaker maker(recipe(text), default_isa);
  EXPECT_NO_THROW(maker.pose(0));
  EXPECT_NO_THROW(maker.pose(1));  // behind the block
  EXPECT_THAT(error_of([&] { maker.check_trajectory(0); }), HasSubstr("runs into something"));
  text.replace(text.find("rate_hz: 0.5"), 12, "rate_hz: 0.5, clearance_m: 1");
  const FrameMaker wide(recipe(text), default_isa);
  EXPECT_THAT(error_of([&] { wide.check_trajectory(0); }), HasSubstr("comes within 1 m of something"));
}

TEST_F(Frames, OnlyARecordLongEnoughIsSwum) {
  write("short.txt", "10 -2 -2 -2 0 0 0 1\n11.5 -2 -1 -2 0 0 0 1\n");  // 1.5 s: frames 0 to 3 at 2 Hz
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("speed_mps: 0.5, rate_hz: 2"), 26, "file: short.txt, rate_hz: 2");
  const FrameMaker maker(recipe(text), default_isa);
  EXPECT_TRUE(maker.pose(3).T_world_sonar.translation().isApprox(Vec3(-2, -1, -2), 1e-12));
  EXPECT_NEAR(maker.pose(1).T_world_sonar.translation().y(), -2 + 1.0 / 3, 1e-12);
  EXPECT_EQ(maker.pose(1).time_s, 0.5);
  const auto short_by_one = AllOf(HasSubstr("recipe.yaml:8: splits.test.trajectory.file"), HasSubstr("covers 4 frames"),
                                  HasSubstr("asks for 5"));
  EXPECT_THAT(error_of([&] { maker.pose(4); }), short_by_one);
  EXPECT_THAT(error_of([&] { maker.check_trajectory(0); }), short_by_one);
  const std::string before = plan_json(maker, default_isa, SampleFormat::folder);
  write("short.txt", "10 -2 -2 -2 0 0 0 1\n11.5 -2 -1.1 -2 0 0 0 1\n");
  EXPECT_NE(plan_json(maker, default_isa, SampleFormat::folder), before);  // a resume would mix two paths
}

TEST_F(Frames, SpeedIsDrawnOnceAPlaceAndRecorded) {
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("speed_mps: 0.5"), 14, "speed_mps: {uniform: [0.2, 0.4]}");
  text.replace(text.find("[{scene: way.yaml}]"), 19, "[{scene: way.yaml, layouts: [0, 1]}]");
  text.replace(text.find("frames: 5"), 9, "frames: 6");
  const FrameMaker maker(recipe(text), default_isa);
  std::vector<double> speeds;
  for (int i = 0; i < 6; ++i) {
    const auto sampled = maker.pose(i).sampled;
    ASSERT_EQ(sampled.size(), 1u);
    EXPECT_EQ(sampled[0].first, "trajectory.speed_mps");
    speeds.push_back(sampled[0].second);
  }
  EXPECT_EQ(speeds[0], speeds[2]);
  EXPECT_EQ(speeds[3], speeds[5]);
  EXPECT_NE(speeds[0], speeds[3]);
  EXPECT_GE(speeds[0], 0.2);
  EXPECT_LE(speeds[0], 0.4);
}

// The second layout is built only after the end.
TEST_F(Frames, EndOfPingsFreesRayCastersAndKeepsTruthAndTrajectories) {
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("[{scene: way.yaml}]"), 19, "[{scene: way.yaml, layouts: [0, 1]}]");
  text.replace(text.find("frames: 5"), 9, "frames: 6");
  const FrameMaker whole(recipe(text), default_isa);
  FrameMaker ended(recipe(text), default_isa);
  ASSERT_NE(ended.place(0).rays.handle(), nullptr);
  ended.end_pings();
  for (const int frame : {0, 2, 3, 5}) {
    const int place = ended.locate(frame).place;
    EXPECT_EQ(ended.pose(frame).T_world_sonar.matrix(), whole.pose(frame).T_world_sonar.matrix());
    EXPECT_EQ(ended.place(place).truth.occupancy, whole.place(place).truth.occupancy);
    EXPECT_EQ(ended.place(place).rays.handle(), nullptr);
  }
  EXPECT_NE(ended.locate(0).place, ended.locate(5).place);
}

TEST_F(Frames, NoRoomIsADataErrorWithACure) {
  std::string text = head + "splits:\n" + random_split;
  text.replace(text.find("clearance_m: 0.3"), 16, "clearance_m: 4.0");
  text.replace(text.find("tries: 2000"), 11, "tries: 5");
  const FrameMaker maker(recipe(text), default_isa);
  EXPECT_THROW(maker.pose(0), DataError);
}

TEST_F(Frames, PlanFollowsTheMeshFilesOfItsScenes) {
  const std::string triangle = "v 0 0 -2\nv 1 0 -2\nv 0 1 -2\nf 1 2 3\n";
  write("own.obj", triangle);
  write("b.yaml", "title: own\n" + small_place + "  - {name: own, mesh: own.obj, material: concrete}\n");
  const FrameMaker maker(recipe(head + "splits:\n" + random_split), default_isa);
  const std::string before = plan_json(maker, default_isa, SampleFormat::folder);
  EXPECT_EQ(plan_json(maker, default_isa, SampleFormat::folder), before);
  write("own.obj", triangle + "v 0 0 -1\nf 1 2 4\n");
  EXPECT_NE(plan_json(maker, default_isa, SampleFormat::folder), before);  // a resume would mix two places
}

}  // namespace
}  // namespace ensonify
