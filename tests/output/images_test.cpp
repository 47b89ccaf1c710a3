#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/exr.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

class Images : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("ensonify_images_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
};

template <typename T>
Image2<T> noisy(int rows, int columns) {
  Image2<T> image(rows, columns);
  const RandomKey key = RandomKey::from_seed(6);
  std::uint32_t i = 0;
  for (T& v : image.pixels()) v = static_cast<T>(random_words(key, i++)[0]);
  return image;
}

using Png = Images;
using Exr = Images;

TEST_F(Png, EightBitRoundTrip) {
  for (const auto& [rows, columns] : {std::pair{1, 1}, std::pair{1, 7}, std::pair{512, 512}, std::pair{703, 3}}) {
    const auto image = noisy<std::uint8_t>(rows, columns);
    EXPECT_EQ(decode_png<std::uint8_t>(encode_png(image), "x"), image);
    const auto bytes = encode_png(image);
    const cv::Mat other = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);  // by another library
    ASSERT_EQ(other.type(), CV_8UC1);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) ASSERT_EQ(other.at<std::uint8_t>(r, c), image(r, c));
    }
  }
  write_file(folder / "a.png", encode_png(noisy<std::uint8_t>(9, 5)));
  EXPECT_EQ(read_png(folder / "a.png"), noisy<std::uint8_t>(9, 5));
}

/// ISA-L up to 2.30 keeps one early position of the data under a hash of where its own state lies in memory, one of
/// 8192 buckets. Each of these rows repeats the four bytes at that position, so that a thread whose memory gives
/// another bucket packs some 2.4 of 20 000 rows otherwise: such a packer passes here once in 130 runs (e^-4.9, of both
/// threads).
TEST_F(Png, SameBytesWhereverThePackerWorks) {
  constexpr int rows = 20000;
  const auto pack_all = [] {
    std::vector<std::vector<std::uint8_t>> packed;
    const RandomKey key = RandomKey::from_seed(11);
    for (std::uint32_t i = 0; i < rows; ++i) {
      Image2<std::uint8_t> row(1, 64);
      for (int c = 0; c < row.columns(); ++c) row(0, c) = static_cast<std::uint8_t>(random_words(key, i, c)[0]);
      std::copy_n(row.row(0).begin() + 1, 4, row.row(0).begin() + 31);
      packed.push_back(encode_png(row));
    }
    return packed;
  };
  auto elsewhere = std::async(std::launch::async, pack_all);
  EXPECT_TRUE(pack_all() == elsewhere.get());  // not EXPECT_EQ, which would print them all
}

TEST_F(Png, SixteenBitIsReadByOpenCv) {
  const auto image = noisy<std::uint16_t>(37, 53);
  const cv::Mat other = cv::imdecode(encode_png(image), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(other.type(), CV_16UC1);
  for (int r = 0; r < 37; ++r) {
    for (int c = 0; c < 53; ++c) ASSERT_EQ(other.at<std::uint16_t>(r, c), image(r, c));
  }
  EXPECT_THROW(decode_png<std::uint8_t>(encode_png(image), "x"), DataError);  // not 8 bits: no silent loss
}

TEST_F(Png, TruncatedOrGarbage) {
  const auto whole = encode_png(noisy<std::uint8_t>(40, 40));
  for (std::size_t keep = 0; keep < whole.size(); keep += 13) {
    EXPECT_THROW(decode_png<std::uint8_t>({whole.data(), keep}, "x"), DataError) << keep;
  }
  EXPECT_THROW(decode_png<std::uint8_t>({whole.data(), whole.size() - 1}, "x"), DataError);
  const std::vector<std::uint8_t> garbage(500, 0x5a);
  EXPECT_THROW(decode_png<std::uint8_t>(garbage, "x"), DataError);
  std::vector<std::uint8_t> huge = whole;  // claims 2^31 x 2^31 pixels
  for (const std::size_t at : {16u, 20u}) huge[at] = 0x7f;
  EXPECT_THROW(decode_png<std::uint8_t>(huge, "x"), DataError);
  cv::Mat colour(4, 4, CV_8UC3, cv::Scalar(1, 2, 3));
  std::vector<std::uint8_t> rgb;
  cv::imencode(".png", colour, rgb);
  EXPECT_THROW(decode_png<std::uint8_t>(rgb, "x"), DataError);
  EXPECT_THROW(read_png(folder / "missing.png"), DataError);
}

// A flipped bit in the pixel data breaks a chunk's CRC; the reader must not hand over other pixels.
TEST_F(Png, FlippedBitIsNoticed) {
  const auto image = noisy<std::uint8_t>(40, 40);
  const auto whole = encode_png(image);
  int unnoticed = 0;
  for (std::size_t at = 60; at + 20 < whole.size(); at += 101) {
    auto broken = whole;
    broken[at] ^= 0x10;
    try {
      unnoticed += decode_png<std::uint8_t>(broken, "x") != image;
    } catch (const DataError&) {
    }
  }
  EXPECT_EQ(unnoticed, 0);
}

TEST_F(Exr, RoundTripWithNanAndInfinity) {
  Image2<float> power(17, 23);
  for (std::size_t i = 0; i < power.size(); ++i)
    power.pixels()[i] = static_cast<float>(std::pow(10.0, -0.07 * static_cast<double>(i)));
  Image2<float> angle(17, 23, std::numeric_limits<float>::quiet_NaN());
  angle(3, 4) = -0.25F;
  angle(5, 6) = std::numeric_limits<float>::infinity();
  write_exr(folder / "a.exr", {{"direct", power}, {"elevation.min", angle}}, "comment");
  const auto back = read_exr(folder / "a.exr");
  ASSERT_EQ(back.size(), 2u);
  for (const auto& [name, image] : back) {
    const Image2<float>& truth = name == "direct" ? power : angle;
    ASSERT_EQ(image.rows(), 17);
    ASSERT_EQ(image.columns(), 23);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (std::isnan(truth.pixels()[i])) {
        EXPECT_TRUE(std::isnan(image.pixels()[i]));
      } else {
        EXPECT_EQ(image.pixels()[i], truth.pixels()[i]);
      }
    }
  }
  EXPECT_THROW(write_exr(folder / "b.exr", {{"a", power}, {"b", Image2<float>(2, 2)}}, ""), DataError);
  EXPECT_FALSE(fs::exists(folder / "b.exr"));
}

TEST_F(Exr, TruncatedOrGarbage) {
  write_exr(folder / "a.exr", {{"direct", Image2<float>(64, 64, 0.5F)}}, "");
  const auto whole = read_file(folder / "a.exr");
  for (const std::size_t keep :
       {std::size_t{0}, std::size_t{3}, std::size_t{100}, whole.size() / 2, whole.size() - 5}) {
    write_file(folder / "cut.exr", std::span(whole).first(keep));
    EXPECT_THROW(read_exr(folder / "cut.exr"), DataError) << keep;
  }
  write_file(folder / "garbage.exr", std::string(1000, 'x'));
  EXPECT_THROW(read_exr(folder / "garbage.exr"), DataError);
  EXPECT_THROW(read_exr(folder / "missing.exr"), DataError);
}

}  // namespace
}  // namespace ensonify
