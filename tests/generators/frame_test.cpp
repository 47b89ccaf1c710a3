#include "ensonify/generators/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/dataset_plan.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

const std::string small_place = R"(
bounds: {min: [-4, -4, -4], max: [4, 4, 0]}
navigable: {min: [-3, -3, -3], max: [3, 3, -1]}
grid_resolution_m: 0.1
objects:
  - {name: block, shape: box, length_m: 1, width_m: 1, height_m: 1, pose: [0, 0, -2], material: concrete}
  - {name: wall, shape: box, length_m: 0.3, width_m: 7, height_m: 3.5, pose: [3.7, 0, -2], material: concrete}
)";

const std::string random_split = R"(  train:
    frames: 6
    places: [{scene: a.yaml}, {scene: b.yaml}]
    random_poses: {pitch_deg: {uniform: [-5, 25]}, clearance_m: 0.3, least_seen_share: 0.02, tries: 2000}
)";
const std::string swum_split = R"(  test:
    frames: 5
    places: [{scene: way.yaml}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
)";
const std::string head = R"(name: test
sonar: {model: oculus_m1200d_hf, range_min_m: 0.1, range_max_m: {uniform: [4, 6]}, range_bins: 128, gain_db: {uniform: [-3, 3]}}
noise: paper
)";

class Frames : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("ensonify_frames_" + std::to_string(::getpid()));
  void SetUp() override {
    fs::create_directories(folder);
    for (const char* name : {"a.yaml", "b.yaml"}) write(name, "title: place\n" + small_place);
    write("way.yaml",
          "title: way\n" + small_place + "waypoints:\n  - [-2, -2, -2, 0, 0, 0]\n  - [-2, 2, -2, 0, 0, 0]\n");
    write("into.yaml",
          "title: into\n" + small_place + "waypoints:\n  - [-2, 0, -2, 0, 0, 0]\n  - [2, 0, -2, 0, 0, 0]\n");
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  Recipe recipe(const std::string& text) const {
    write("recipe.yaml", text);
    return load_recipe((folder / "recipe.yaml").string());
  }
  std::string refusal(const std::string& text) const {
    try {
      recipe(text);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return {};
  }
};

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

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

using Recipes = Frames;

TEST_F(Recipes, Refusals) {
  EXPECT_EQ(refusal(head + "splits:\n" + random_split), "");
  EXPECT_THAT(refusal(head), HasSubstr("needs the key 'splits'"));
  EXPECT_THAT(refusal(head + "splits: {}\n"), HasSubstr("at least one of train, val, test"));
  EXPECT_THAT(refusal(head + "splits:\n  training: {frames: 1}\n"), HasSubstr("training: unknown key; did you mean"));
  EXPECT_THAT(refusal(head + "splits:\n" + random_split +
                      "  val:\n    frames: 2\n    places: [{scene: a.yaml}]\n    random_poses: {}\n"),
              HasSubstr("splits must not share a layout"));
  EXPECT_THAT(refusal(head + "splits:\n  val:\n    frames: 2\n    places: []\n    random_poses: {}\n"),
              HasSubstr("at least one scene"));
  EXPECT_THAT(refusal(head + "splits:\n  val:\n    frames: 3\n    places: [{scene: a.yaml}, {scene: b.yaml}]\n    "
                             "trajectory: {}\n"),
              HasSubstr("multiple of the 2 places"));
  EXPECT_THAT(refusal(head + "splits:\n  val:\n    frames: 2\n    places: [{scene: a.yaml}]\n"),
              HasSubstr("random_poses"));
  EXPECT_THAT(refusal(head + "splits:\n  val:\n    frames: 0\n    places: [{scene: a.yaml}]\n    random_poses: {}\n"),
              HasSubstr("frames: must be a whole number"));
  EXPECT_THAT(refusal(head + "splits:\n  val:\n    frames: 2\n    places: [{scene: a.yaml, layouts: [0.5]}]\n    "
                             "random_poses: {}\n"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(refusal(head + "mask: {threshold: 0}\nsplits:\n" + random_split), HasSubstr("mask.threshold"));
}

TEST_F(Recipes, EveryWindowThatCanBeDrawnIsTheInstruments) {
  const auto said = [&](const std::string& sonar) {
    return refusal("name: test\nsonar: {model: oculus_m1200d_hf, " + sonar + "}\nnoise: paper\nsplits:\n" +
                   random_split);
  };
  EXPECT_EQ(said("range_max_m: {uniform: [4, 10]}"), "");
  const auto beyond = AllOf(HasSubstr("recipe.yaml:2: sonar.range_max_m"), HasSubstr("0.1 to 10 m of oculus_m1200d_hf"),
                            HasSubstr("not 11"));
  EXPECT_THAT(said("range_max_m: 11"), beyond);
  EXPECT_THAT(said("range_max_m: {uniform: [4, 11]}"), beyond);
  EXPECT_THAT(said("range_max_m: {choice: [11, 4]}"), beyond);
  EXPECT_THAT(said("range_max_m: {normal: [8, 1]}"), beyond);
  EXPECT_THAT(said("range_min_m: 4, range_max_m: {uniform: [3, 10]}"),
              AllOf(HasSubstr("recipe.yaml:2: sonar.range_max_m"), HasSubstr("begins at 4 m")));
  EXPECT_THAT(said("range_min_m: 0.05"), AllOf(HasSubstr("recipe.yaml:2: sonar.range_min_m"), HasSubstr("not 0.05")));
  EXPECT_THAT(said("range_min_m: 12"), HasSubstr("recipe.yaml:2: sonar.range_min_m"));
}

TEST_F(Recipes, NamesThatAreNoneAreNamedWithTheirLine) {
  const auto said = [&](const std::string& word, const std::string& other) {
    std::string text = head + "splits:\n" + swum_split;
    text.replace(text.find(word), word.size(), other);
    return refusal(text);
  };
  EXPECT_THAT(said("oculus_m1200d_hf", "oculus_m1200_hf"),
              AllOf(HasSubstr("recipe.yaml:2: sonar.model: oculus_m1200_hf"), HasSubstr("no bundled sonar"),
                    HasSubstr("did you mean 'oculus_m1200d_hf'")));
  EXPECT_THAT(said("noise: paper", "noise: papr"),
              AllOf(HasSubstr("recipe.yaml:3: noise: papr"), HasSubstr("no bundled noise profile")));
  EXPECT_THAT(said("noise: paper", "noise: [paper, nonne]"), HasSubstr("recipe.yaml:3: noise: nonne"));
  EXPECT_THAT(said("way.yaml", "test_tnk"),
              AllOf(HasSubstr("recipe.yaml:7: splits.test.places[0].scene: test_tnk"), HasSubstr("no bundled scene"),
                    HasSubstr("did you mean 'test_tank'")));
  write("cube.obj", "v 0 0 -2\nv 1 0 -2\nv 0 1 -2\nf 1 2 3\n");
  EXPECT_THAT(said("way.yaml", "cube.obj"), AllOf(HasSubstr("recipe.yaml:7: splits.test.places[0].scene"),
                                                  HasSubstr("no scene YAML"), HasSubstr("mesh: cube.obj")));
}

TEST_F(Recipes, KeysThatExcludeEachOther) {
  const std::string both = "  val:\n    frames: 2\n    places: [{scene: a.yaml}]\n    random_poses: {}\n";
  EXPECT_EQ(refusal(head + "splits:\n" + both), "");
  EXPECT_THAT(refusal(head + "splits:\n" + both + "    frames_per_place: 2\n"),
              AllOf(HasSubstr("recipe.yaml:6: splits.val.frames"), HasSubstr("does not go with 'frames_per_place'")));
  EXPECT_THAT(refusal(head + "splits:\n" + both + "    trajectory: {}\n"),
              AllOf(HasSubstr("splits.val.random_poses"), HasSubstr("does not go with 'trajectory'")));
}

TEST_F(Recipes, ScenesOfOneFileNameAreNoSharedPlace) {
  fs::create_directories(folder / "deep");
  write("deep/a.yaml", "title: another\n" + small_place);
  const std::string said = refusal(head + "splits:\n" + random_split +
                                   "  val:\n    frames: 2\n    places: [{scene: deep/a.yaml}]\n    random_poses: {}\n");
  EXPECT_THAT(said, AllOf(HasSubstr("deep/a.yaml would both be the place"), HasSubstr("rename one")));
  EXPECT_THAT(said, testing::Not(HasSubstr("used twice")));
}

TEST_F(Recipes, TrajectoryRefusals) {
  const auto said = [&](const std::string& keys) {
    std::string text = head + "splits:\n" + swum_split;
    text.replace(text.find("speed_mps: 0.5, rate_hz: 2"), 26, keys);
    return refusal(text);
  };
  EXPECT_EQ(said("path: waypoints"), "");
  EXPECT_EQ(said("waypoints: [[0, 0, -1, 0, 0, 0], [1, 0, -1, 0, 0, 0]]"), "");
  EXPECT_THAT(said("path: spiral"), AllOf(HasSubstr("recipe.yaml:8"), HasSubstr("must be waypoints")));
  EXPECT_THAT(said("waypoints: [[0, 0, -1, 0, 0, 0]]"), HasSubstr("needs at least two"));
  EXPECT_THAT(said("waypoints: [[x, 0, 0, -1, 0, 0, 0], [1, 0, -1, 0, 0, 0]]"), HasSubstr("entry 0 must be"));
  EXPECT_THAT(said("waypoints: [[x, 0, 0, -1, 0, 0], [1, 0, -1, 0, 0, 0]]"), HasSubstr("entry 0 must be"));
  EXPECT_THAT(said("waypoints: [[0, 0, -1, 0, 0, 0], [1, 0, -1, 0, 0, .nan]]"), HasSubstr("entry 1 must be"));
  EXPECT_THAT(said("orbit: {center: [0, 0, -2], radius_m: 2, depth_m: 2}, file: a.txt"),
              AllOf(HasSubstr("one path too many"), HasSubstr("keep one of orbit, file")));
  EXPECT_THAT(said("orbit: {radius_m: 2, depth_m: 2}"), HasSubstr("either 'object' or 'center'"));
  EXPECT_THAT(said("orbit: {object: a, center: [0, 0, 0], radius_m: 2, depth_m: 2}"), HasSubstr("either"));
  EXPECT_THAT(said("orbit: {object: a, radius: 2, depth_m: 2}"), HasSubstr("did you mean 'radius_m'"));
  EXPECT_THAT(said("orbit: {object: a, radius_m: 0, depth_m: 2}"), HasSubstr("radius_m: must lie in"));
  EXPECT_THAT(said("lawnmower: {depth_m: -2, spacing_m: 1}"), HasSubstr("depth_m: must lie in"));
  EXPECT_THAT(said("lawnmower: {depth_m: 2, spacing_m: 1, area: [1, 0, 0, 1]}"), HasSubstr("x0 < x1"));
  EXPECT_THAT(said("wall: {object: a, standoff_m: 1, depth_m: 1, side: left}"),
              HasSubstr("one of all, east, north, west, south"));
  EXPECT_THAT(said("attitude_noise: {roll_deg: 60}"), HasSubstr("attitude_noise.roll_deg: must lie in [0, 45]"));
  EXPECT_THAT(said("speed_mps: {uniform: [0, 1]}"), HasSubstr("must lie in [0.001, 20]"));
  EXPECT_THAT(said("rate_hz: 0.001, clearance: 1"), HasSubstr("did you mean 'clearance_m'"));
  write("a.txt", "0 0 0 -2 0 0 0 1\n");
  EXPECT_THAT(said("file: a.txt, speed_mps: 1"), HasSubstr("does not go with 'file'"));
  std::string text = head + "splits:\n" + swum_split;
  text.replace(text.find("frames: 5"), 9, "frames: 262200");
  EXPECT_THAT(refusal(text), HasSubstr("longer than the 131072 s"));
}

TEST_F(Recipes, WhatAPlaceDoesNotHaveIsNamedWithTheLineOfTheRecipe) {
  const auto said = [&](const std::string& keys) {
    std::string text = head + "splits:\n" + swum_split;
    text.replace(text.find("speed_mps: 0.5, rate_hz: 2"), 26, keys);
    const FrameMaker maker(recipe(text), default_isa);
    return error_of([&] { maker.check_trajectory(0); });
  };
  EXPECT_THAT(said("orbit: {object: blok, radius_m: 2, depth_m: 2}"),
              AllOf(HasSubstr("recipe.yaml:8: splits.test.trajectory.orbit"), HasSubstr("did you mean 'block'")));
  EXPECT_THAT(said("wall: {object: block, standoff_m: 1, depth_m: 1}"),
              AllOf(HasSubstr("nothing between 0.75 and 1.25 m"), HasSubstr("it spans 1.50 to 2.50 m")));
  EXPECT_THAT(said("wall: {object: wall, standoff_m: 1, depth_m: 2, side: east}"),
              HasSubstr("lies in the navigable box on that side"));
  EXPECT_THAT(said("lawnmower: {depth_m: 1, spacing_m: 1, area: [0, 0, 9, 1]}"), HasSubstr("within the bounds"));
  EXPECT_THAT(said("lawnmower: {depth_m: 9, spacing_m: 1}"), HasSubstr("leaves the bounds of the scene"));
  EXPECT_THAT(said("lawnmower: {depth_m: 1, spacing_m: 0.01, area: [0, 0, 1, 4], heading_deg: 0}, clearance_m: 10"),
              HasSubstr("comes within 10 m"));
}

TEST_F(Recipes, PairsKeepTheRulesOfFrames) {
  const auto said = [&](std::string split, int pairs) {
    split.replace(split.find("test:"), 5, "train:");
    Recipe r = recipe(head + "splits:\n" + split + "  val:\n    frames: 2\n    places: [{scene: a.yaml}]\n" +
                      "    random_poses: {}\n");
    return error_of([&] { set_training_pairs(r, pairs); });
  };
  std::string two = swum_split;
  two.replace(two.find("frames: 5"), 9, "frames_per_place: 4");
  two.replace(two.find("[{scene: way.yaml}]"), 19, "[{scene: way.yaml, layouts: [0, 1]}]");
  EXPECT_EQ(said(two, 2), "");
  for (const int pairs : {1, 7}) {
    EXPECT_THAT(said(two, pairs), AllOf(HasSubstr("pairs " + std::to_string(pairs)),
                                        HasSubstr("multiple of the 2 places of a trajectory split")));
  }
  EXPECT_THAT(said(two, 1), HasSubstr("such as 2"));
  EXPECT_THAT(said(two, 524400), HasSubstr("longer than the 131072 s"));
  EXPECT_THAT(said(two, 0), HasSubstr("must lie in [1, 99999998]"));
  EXPECT_THAT(said(two, 100'000'000), AllOf(HasSubstr("at most 100000000 frames"), HasSubstr("the other splits 2")));
  Recipe swum = recipe(head + "splits:\n" + swum_split);
  EXPECT_THAT(error_of([&] { set_training_pairs(swum, 5); }), HasSubstr("pairs 5: the recipe has no split 'train'"));
}

// 10^8 frames in each of 30 layouts is more than an int holds.
TEST_F(Recipes, FramesPerPlaceDoNotOverflow) {
  const std::string layouts =
      "[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31,32,33,34,35,36,37,38,39,"
      "40,41,42]";
  EXPECT_NE(refusal(head + "splits:\n  val:\n    frames_per_place: 100000000\n    places: [{scene: a.yaml, layouts: " +
                    layouts + "}]\n    random_poses: {}\n"),
            "");
}

TEST(Recipe, BundledLoad) {
  const Recipe paper = load_recipe("paper");
  EXPECT_EQ(paper.splits.size(), 3u);
  EXPECT_EQ(paper.splits[0].frames, 3000);
  EXPECT_EQ(paper.drift.radial_error_m, 1.1);
  EXPECT_NO_THROW(load_recipe("quick"));
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
