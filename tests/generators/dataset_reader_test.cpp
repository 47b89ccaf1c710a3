#include "ensonify/generators/dataset_reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/pixel_sums.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/output/tar_shard.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* manifest = R"({"format": "FORMAT", "root_hash": "aa", "mask": {"threshold": 8},
"recipe": {"name": "hand", "title": "by hand", "sonar": {}, "splits": {"train": {"places": [
  {"name": "pool_layout3", "scene": "some/pool.yaml", "layout": 3}]}}},
"sonar": {"beam_azimuth_rad": [0.1, 0, -0.1], "range_bins": 2, "receive": {"bits": 8}},
"counts": {"train": 3}, "shards": [{"split": "train", "frames": 2, "sha256": "b"}, {"split": "train", "frames": 1, "sha256": "c"}]})";

constexpr const char* line = R"({"place":"pool_layout3","range_min_m":0.5,"range_max_m":2.5,"time":null,
"T_world_sonar":[[0,-1,0,4],[1,0,0,5],[0,0,1,-6],[0,0,0,1]],
"T_world_sonar_est":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]],"sampled":{"sonar.gain_db":1.5}})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string one_line(const std::string& text) {
  std::string result;
  std::copy_if(text.begin(), text.end(), std::back_inserter(result), [](char c) { return c != '\n'; });
  return result + "\n";
}

/// Frame `number` has grey level 10 + number in its first pixel.
FramePixels frame(int number) {
  FramePixels pixels{Image2<std::uint8_t>(2, 3, 20), Image2<std::uint8_t>(2, 3), Image2<std::uint8_t>(2, 3),
                     Image2<std::uint8_t>(2, 3)};
  pixels.clean(0, 0) = static_cast<std::uint8_t>(10 + number);
  pixels.mask(0, 0) = 255;
  pixels.labels(0, 0) = 1;
  return pixels;
}

class DatasetReader : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    const bool tars = GetParam() == std::string("webdataset");
    write_file(folder_ / "dataset.json", replaced(manifest, "FORMAT", GetParam()));
    write_file(folder_ / "train/metadata.jsonl", one_line(line) + one_line(line) + one_line(line));
    const DatasetPaths paths{folder_};
    for (const auto& [shard, first, last] : {std::tuple{0, 0, 2}, {1, 2, 3}}) {
      std::optional<TarShard> tar;
      if (tars) tar.emplace(paths.tar("train", shard));
      for (int n = first; n < last; ++n) {
        const FramePixels pixels = frame(n);
        const auto put = [&](const std::string& kind, const Image2<std::uint8_t>& image) {
          if (tar) tar->add(fmt::format("{:06}.{}.png", n, kind), encode_png(image));
          if (!tar) write_file(paths.image("train", kind, n), encode_png(image));
        };
        put("raw", std::get<0>(pixels.raw));
        put("clean", pixels.clean);
        put("mask", pixels.mask);
        put("labels", pixels.labels);
        if (tar) tar->add(fmt::format("{:06}.json", n), std::vector<std::uint8_t>{'{', '}'});
      }
      if (tar) tar->finish();
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <typename Read>
  std::string refusal(const Read& read) {
    try {
      read();
    } catch (const DataError& e) {
      return e.what();
    }
    return "no refusal";
  }

  fs::path folder_ = fs::temp_directory_path() / fmt::format("ensonify_reader_{}", ::getpid());
};

TEST_P(DatasetReader, GivesWhatIsThere) {
  const Dataset dataset = open_dataset(folder_);
  ASSERT_EQ(dataset.splits.size(), 1u);
  EXPECT_EQ(dataset.frames(), 3);
  EXPECT_EQ(dataset.splits[0].places[0].scene, "pool");
  EXPECT_EQ(dataset.splits[0].places[0].layout, 3u);
  for (int n = 0; n < 3; ++n) {
    const FramePixels pixels = read_pixels(dataset, 0, n);
    EXPECT_EQ(pixels.clean, frame(n).clean);
    EXPECT_EQ(pixels.raw, frame(n).raw);
    EXPECT_EQ(pixel_fault(dataset, pixels), "");
  }
  std::vector<int> visited;
  for (const DatasetBlock& block : dataset.splits[0].blocks) {
    read_block(
        dataset, block, [](int n) { return n != 1; },
        [&](int n, const FramePixels& pixels) {
          EXPECT_EQ(pixels.clean, frame(n).clean);
          visited.push_back(n);
        });
  }
  EXPECT_EQ(visited, (std::vector{0, 2}));
  const FrameInfo info = read_frames(index_metadata(dataset, 0), 2, 1).at(0);
  EXPECT_EQ(info.number, 2);
  EXPECT_EQ(info.place, "pool_layout3");
  EXPECT_EQ(info.T_world_sonar.translation(), Vec3(4, 5, -6));
  EXPECT_FALSE(info.time_s);
  EXPECT_EQ(info.sampled, (std::vector<std::pair<std::string, double>>{{"sonar.gain_db", 1.5}}));
  EXPECT_THAT(refusal([&] { read_truth(dataset, 0, 0); }), HasSubstr("truth: true"));
}

TEST_P(DatasetReader, RefusesABrokenManifest) {
  const std::string good = replaced(manifest, "FORMAT", GetParam());
  for (const auto& [from, to, rule] :
       {std::tuple{R"("split": "train")", R"("split": "../train")", "no split '../train'"},
        {R"("train": 3)", R"("train": 4)", "hold 3 frames, not 4"},
        {R"("frames": 2)", R"("frames": -2)", "-2 is no whole number"},
        {R"("frames": 2)", R"("frames": "two")", "broken manifest: \"two\" is no whole number"},
        {R"("range_bins": 2)", R"("range_binz": 2)", "range_bins"},
        {R"("layout": 3)", R"("layout": 3])", "broken manifest"}}) {
    write_file(folder_ / "dataset.json", replaced(good, from, to));
    EXPECT_THAT(refusal([&] { open_dataset(folder_); }), testing::AllOf(HasSubstr("dataset.json"), HasSubstr(rule)));
  }
  fs::remove(folder_ / "dataset.json");
  EXPECT_THAT(refusal([&] { open_dataset(folder_); }), HasSubstr("no dataset.json"));
}

TEST_P(DatasetReader, RefusesBrokenMetadataByLine) {
  const Dataset dataset = open_dataset(folder_);
  for (const auto& [from, to, rule] : {std::tuple{"[1,0,0,5]", "[2,0,0,5]", "must be a rotation"},
                                       {"[1,0,0,5]", "[1,0,5]", "line 2"},
                                       {"[1,0,0,5]", "[1,0,0,1e999]", "line 2"},
                                       {R"("range_max_m":2.5)", R"("range_max_m":0.5)", "range_min_m < range_max_m"},
                                       {R"("place":"pool_layout3")", R"("place":7)", "line 2"},
                                       {R"("time":null)", R"("time":)", "line 2"}}) {
    write_file(folder_ / "train/metadata.jsonl", one_line(line) + one_line(replaced(line, from, to)) + one_line(line));
    const MetadataIndex index = index_metadata(dataset, 0);
    EXPECT_THAT(refusal([&] { read_frames(index, 0, 3); }),
                testing::AllOf(HasSubstr("jsonl, line 2"), HasSubstr(rule)));
  }
  for (const std::string& text : {std::string(), one_line(line), one_line(line) + one_line(line) + line}) {
    write_file(folder_ / "train/metadata.jsonl", text);
    EXPECT_THAT(refusal([&] { index_metadata(dataset, 0); }), HasSubstr("must have 3 lines"));
  }
}

TEST_P(DatasetReader, FindsPixelsThatBreakARule) {
  const Dataset dataset = open_dataset(folder_);
  FramePixels wrong = frame(0);
  wrong.mask(1, 1) = 255;
  EXPECT_THAT(pixel_fault(dataset, wrong), HasSubstr("mask is not clean >= 8"));
  wrong = frame(0);
  wrong.labels(1, 1) = 6;
  EXPECT_THAT(pixel_fault(dataset, wrong), HasSubstr("a label is 6"));
  wrong = frame(0);
  wrong.labels = Image2<std::uint8_t>(3, 3);
  EXPECT_THAT(pixel_fault(dataset, wrong), HasSubstr("3 x 3 pixels, not 2 x 3"));
}

INSTANTIATE_TEST_SUITE_P(Formats, DatasetReader, testing::Values("folder", "webdataset"),
                         [](const auto& format) { return std::string(format.param); });

TEST(PixelSums, AveragesSixteenBitsOverMetres) {
  FramePixels pixels = frame(0);
  Image2<std::uint16_t> deep(2, 3, 0x0203);
  deep(1, 2) = 0xffff;
  pixels.raw = deep;
  // Rows of 1 m from 1 m on, in bins of 2 m from 0 on: row 0 (1.5 m) is in bin 0, row 1 (2.5 m) in bin 1.
  const PixelSums sums = sum_pixels(pixels, 1, 3, {0, 6, 3});
  EXPECT_EQ(sums.raw[2], 5u);
  EXPECT_EQ(sums.raw[255], 1u);
  EXPECT_EQ(sums.bin_pixels, (std::vector<std::uint64_t>{3, 3, 0}));
  EXPECT_EQ(sums.bin_raw, (std::vector<std::uint64_t>{3 * 0x0203, 2 * 0x0203 + 0xffff, 0}));
  EXPECT_EQ(sums.bin_mask, (std::vector<std::uint64_t>{1, 0, 0}));
  EXPECT_EQ(sums.without_echo, 0u);
}

}  // namespace
}  // namespace ensonify
