#include "ensonify/output/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <set>

namespace ensonify {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string nasty = "</style><script>alert('x')</script>\" onload=\"y";

Plot curve() {
  Plot plot = titled_plot("title", "x", "y");
  plot.series = {{"s", {0, 1, 2}, {1, 2, 3}, Series::Style::marked_line}};
  return plot;
}

ReportFigure figure(const std::string& text) {
  return {text, text, text, figure_of(curve()), {{text, {text, "y"}, {{text, "1"}}, 1}}};
}

ReportPage page_of(const std::string& text) {
  ContactSheet sheet{text, {{text, {{text, {Image2<std::uint8_t>(4, 4, 9), Image2<std::uint8_t>(4, 4, 7)}}}}}};
  ReportFigure tiles{text, text, text, sheet, {}}, picture{text, text, text, Image2<Rgb>(3, 5), {}};
  return {text,
          text,
          {{text, text}},
          {{text, {text}, {}, {figure(text), figure(text)}, {{text, {text}, {}, {tiles}}}}, {text, {}, {}, {picture}}}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ReportPage, TextFromOutsideStaysText) {
  const std::string html = html_page(page_of(nasty));
  for (const char* bad : {"<script", "\" onload"}) EXPECT_THAT(html, Not(HasSubstr(bad)));
  EXPECT_EQ(count(html, "</style>"), 1U);
  EXPECT_GT(count(html, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot; onload=&quot;y"), 15U);
}

TEST(ReportPage, IdsAreUniqueAndAnchorsLeadSomewhere) {
  const std::string html = html_page(page_of("Some title"));
  std::set<std::string> ids;
  const std::regex id(" id=\"([^\"]*)\""), target(" href=\"#([^\"]*)\"");
  for (std::sregex_iterator i(html.begin(), html.end(), id), end; i != end; ++i) {
    EXPECT_TRUE(ids.insert((*i)[1]).second) << (*i)[1];
  }
  int targets = 0;
  for (std::sregex_iterator i(html.begin(), html.end(), target), end; i != end; ++i, ++targets) {
    EXPECT_TRUE(ids.contains((*i)[1])) << (*i)[1];
  }
  EXPECT_GE(targets, 4);  // two sections, and the marks of two plots
}

TEST(ReportPage, HasOneHeadingAndCountsItsFigures) {
  const std::string html = html_page(page_of("a"));
  EXPECT_EQ(count(html, "<h1>"), 1U);
  EXPECT_EQ(count(html, "<h2 "), 2U);
  EXPECT_EQ(count(html, "<h3 "), 1U);
  for (const char* name : {"Figure 1.", "Figure 2.", "Figure 3.", "Figure 4."})
    EXPECT_EQ(count(html, name), 1U) << name;
  EXPECT_EQ(count(html, "<svg "), 2U);
  EXPECT_EQ(count(html, "<img src=\"data:image/png;base64,"), 3U);
  EXPECT_EQ(html, html_page(page_of("a")));
}

TEST(ReportPage, WithoutGnuplotTheNumbersRemain) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nonexistent", 1);
  const std::string html = html_page(page_of("a"));
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(count(html, "<svg "), 0U);
  EXPECT_THAT(html, HasSubstr("plots need gnuplot (Debian: gnuplot-nox)"));
  EXPECT_EQ(count(html, "its numbers follow"), 2U);
  EXPECT_EQ(count(html, "<table>"), 2U);
}

}  // namespace
}  // namespace ensonify
