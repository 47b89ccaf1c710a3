#include "ensonify/output/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>

#include "ensonify/core/error.hpp"
#include "ensonify/output/child_process.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

cv::Mat decoded(const std::vector<std::uint8_t>& png) { return cv::imdecode(png, cv::IMREAD_COLOR); }

// More than any pipe holds, both ways at once: a parent that wrote all before it read would hang.
TEST(ChildProcess, MovesMegabytesBothWays) {
  std::string input(5'000'000, 'x');
  for (std::size_t i = 0; i < input.size(); ++i) input[i] = static_cast<char>(i * 31 % 251);
  EXPECT_EQ(text_of(run_program({"cat"}, bytes_of(input), "")), input);
}

TEST(ChildProcess, SaysWhatWentWrong) {
  using testing::HasSubstr;
  const auto message = [](const std::vector<std::string>& words, const std::string& input) {
    try {
      run_program(words, bytes_of(input), "the cure");
    } catch (const DataError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({"no-such-program-here"}, ""), HasSubstr("the cure"));
  EXPECT_THAT(message({"cat", "/no/such/file"}, ""), HasSubstr("No such file"));
  EXPECT_THAT(message({"true"}, ""), HasSubstr("true failed"));                           // wrote nothing
  EXPECT_THAT(message({"false"}, std::string(1 << 20, 'x')), HasSubstr("false failed"));  // never reads: no SIGPIPE
}

// The line from (0, 0) to (10, 10) must be where the axes say; looked for in the one colour that only it has.
TEST(Plot, LineLiesWhereTheAxesSay) {
  Plot plot;
  plot.series = {{"", {0, 10}, {0, 10}}};
  plot.x_range = plot.y_range = {{0.0, 10.0}};
  const cv::Mat picture = decoded(draw_plots({{plot}, 1, 400, 300}));
  ASSERT_EQ(picture.size(), cv::Size(400, 300));
  int left = 400, right = -1, top = 300, bottom = -1;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b p = picture.at<cv::Vec3b>(y, x);
      if (p[0] < 150 || p[2] > 60) continue;  // #0072b2
      left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  EXPECT_GT(right - left, 300);
  EXPECT_GT(bottom - top, 200);
  const auto is_line = [&](int x, int y) {
    for (int dy = -2; dy <= 2; ++dy) {
      if (picture.at<cv::Vec3b>(y + dy, x)[2] < 120 && picture.at<cv::Vec3b>(y + dy, x)[0] > 120) return true;
    }
    return false;
  };
  EXPECT_TRUE(is_line((left + right) / 2, (top + bottom) / 2));
  EXPECT_TRUE(is_line(left + (right - left) / 4, bottom - (bottom - top) / 4));
}

// Alone at its place in the list, a series looks like no other: there are nine filters and more.
TEST(Plot, ManySeriesAreToldApart) {
  constexpr int many = 20;
  for (const auto style : {Series::Style::line, Series::Style::marked_line, Series::Style::points_with_errors}) {
    std::set<std::string> looks;
    for (int only = 0; only < many; ++only) {
      Plot plot;
      plot.x_range = plot.y_range = {{0.0, 20.0}};
      plot.series.resize(many);
      for (Series& series : plot.series) series.style = style;
      Series& seen = plot.series[static_cast<std::size_t>(only)];
      for (int i = 1; i < 20; ++i) seen.x.push_back(i), seen.y.push_back(i);
      seen.y_low = seen.y_high = seen.y;
      const std::vector<std::uint8_t> picture = draw_plots({{plot}, 1, 400, 300});
      looks.emplace(picture.begin(), picture.end());
    }
    EXPECT_EQ(looks.size(), std::size_t{many}) << static_cast<int>(style);
  }
}

TEST(Plot, BackdropKeepsItsSides) {
  Plot plot;
  plot.backdrop = Backdrop{Image2<Rgb>(2, 2), 0, 4, 0, 4};
  plot.backdrop->picture(0, 0) = {255, 0, 0};  // upper left
  plot.backdrop->picture(0, 1) = {0, 255, 0};
  plot.backdrop->picture(1, 0) = {0, 0, 255};
  plot.backdrop->picture(1, 1) = {255, 0, 255};
  plot.x_range = plot.y_range = {{0.0, 4.0}};
  const cv::Mat picture = decoded(draw_plots({{plot}, 1, 400, 400}));
  const auto at = [&](int x, int y) { return picture.at<cv::Vec3b>(y, x); };
  EXPECT_EQ(at(120, 120), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(at(300, 120), cv::Vec3b(0, 255, 0));
  EXPECT_EQ(at(120, 280), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(at(300, 280), cv::Vec3b(255, 0, 255));
}

// Titles come from files: gnuplot can run programs and write files where a string is not closed.
TEST(Plot, TextIsNeverACommand) {
  const auto trap = std::filesystem::temp_directory_path() / ("ensonify_plot_trap_" + std::to_string(::getpid()));
  for (const std::string& text :
       {"'\nsystem(\"touch " + trap.string() + "\")\n'", "`touch " + trap.string() + "`",
        "' ; !touch " + trap.string() + " ; '", std::string("EOD\nsystem('touch ") + trap.string() + "')"}) {
    Plot plot;
    plot.title = plot.x_label = text;
    plot.series = {{text, {0, 1}, {0, 1}}};
    plot.categories = {text, "b"};
    EXPECT_NO_THROW(draw_plots({{plot}})) << text;
    EXPECT_FALSE(std::filesystem::exists(trap)) << text;
  }
}

TEST(Plot, SvgHoldsTheWords) {
  Plot plot;
  plot.title = "It's <5 % & ü";
  plot.y_label = "share";
  plot.series = {{"bars", {0, 1, 2}, {1, 2, 3}, Series::Style::bars}, {"none", {}, {}}};
  const std::string svg = text_of(draw_plots({{plot, plot}, 2}, PlotFormat::svg));
  EXPECT_THAT(svg, testing::HasSubstr("It's &lt;5 % &amp; ü"));
  EXPECT_THAT(svg, testing::HasSubstr("share"));
  EXPECT_EQ(svg, text_of(draw_plots({{plot, plot}, 2}, PlotFormat::svg)));
}

TEST(Plot, NothingAndNotANumberAreDrawn) {
  Plot plot;
  EXPECT_FALSE(decoded(draw_plots({{plot}})).empty());
  plot.series = {{"", {0, 1, 2}, {0, std::numeric_limits<double>::quiet_NaN(), 2}}};
  EXPECT_FALSE(decoded(draw_plots({{plot}})).empty());
}

TEST(ColourPng, RoundTrip) {
  for (const auto& [rows, columns] : {std::pair{1, 1}, std::pair{3, 7}, std::pair{64, 100}}) {
    Image2<Rgb> image(rows, columns);
    std::uint32_t state = 1;
    for (Rgb& p : image.pixels()) {
      state = state * 1664525u + 1013904223u;
      p = {static_cast<std::uint8_t>(state >> 8), static_cast<std::uint8_t>(state >> 16),
           static_cast<std::uint8_t>(state >> 24)};
    }
    const cv::Mat back = decoded(encode_png(image));
    ASSERT_EQ(back.size(), cv::Size(columns, rows));
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        const cv::Vec3b p = back.at<cv::Vec3b>(r, c);
        ASSERT_EQ(image(r, c), (Rgb{p[2], p[1], p[0]}));
      }
    }
  }
}

}  // namespace
}  // namespace ensonify
