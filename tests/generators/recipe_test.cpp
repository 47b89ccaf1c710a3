#include "ensonify/generators/recipe.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/frame.hpp"
#include "support/small_places.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using namespace test;
using testing::AllOf;
using testing::HasSubstr;

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

TEST_F(Recipes, DriftHasItsDefaults) {
  const Recipe r = recipe(head + "drift: {radial_error_m: 2}\nsplits:\n" + random_split);
  EXPECT_EQ(r.drift.radial_error_m, 2.0);
  EXPECT_EQ(r.drift.after_s, 1200.0);
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
  const Recipe told_apart = recipe(
      head + "splits:\n" + random_split +
      "  val:\n    frames: 2\n    places: [{scene: deep/a.yaml, name: deep_a, layout: 3}]\n    random_poses: {}\n");
  EXPECT_EQ(told_apart.splits[1].places[0].name, "deep_a");
  EXPECT_EQ(told_apart.splits[1].places[0].layout, 3u);
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

std::string manifest_of(const Recipe& recipe) {
  return nlohmann::json{{"schema", dataset_schema}, {"recipe", describe(recipe)}}.dump(1);
}

// 200 headings: some degrees become others by an ulp when they are made radians and degrees again; of those that were
// given with up to nine digits none does.
TEST_F(Recipes, AManifestStandsForItsRecipe) {
  std::string waypoints;
  for (int i = 0; i < 200; ++i) waypoints += fmt::format("[{}, 0.1, -2, 0.3, 10.7, {:.1f}], ", 0.01 * i, 0.9 * i - 90);
  write("way.tum", "0 1 1 -2 0 0 0 1\n9 2 1 -2 0 0 0 1\n");
  const Recipe first =
      recipe(head + "splits:\n" + random_split + "  val:\n    frames: 2\n    places: [{scene: way.yaml}]\n" +
             "    trajectory: {waypoints: [" + waypoints + "], attitude_noise: {roll_deg: 2}}\n" +
             "  test:\n    frames: 2\n    places: [{scene: into.yaml, layouts: [4, 5]}]\n" +
             "    trajectory: {file: way.tum, rate_hz: 1}\n");
  const fs::path elsewhere = folder / "set";
  fs::create_directories(elsewhere);
  write("set/dataset.json", manifest_of(first));
  const Recipe again = load_recipe((elsewhere / "dataset.json").string());
  EXPECT_EQ(describe(again), describe(first));
  const auto poses = [](const Recipe& r) {
    return std::get<OwnWaypoints>(std::get<TrajectoryPoses>(r.splits[1].poses).path).T_world_sonar;
  };
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(poses(again)[i].matrix(), poses(first)[i].matrix()) << i;
}

TEST(Recipe, ManifestsOfBundledOnesStandForThem) {
  for (const std::string& name : library_names("generators")) {
    const Recipe first = load_recipe(name);
    EXPECT_EQ(describe(load_recipe(ConfigText{manifest_of(first), "manifest"})), describe(first)) << name;
  }
}

TEST_F(Recipes, OtherFilesWithASchemaAreNone) {
  EXPECT_THAT(refusal("{\"schema\": \"ensonify-stats\", \"recipe\": {}}"),
              AllOf(HasSubstr("recipe.yaml:1: schema"), HasSubstr("ensonify-dataset")));
}

TEST(Recipe, BundledLoad) {
  const Recipe paper = load_recipe("paper");
  EXPECT_EQ(paper.splits.size(), 3u);
  EXPECT_EQ(paper.splits[0].frames, 3000);
  EXPECT_EQ(paper.drift.radial_error_m, 1.1);
  EXPECT_NO_THROW(load_recipe("quick"));
}

}  // namespace
}  // namespace ensonify
