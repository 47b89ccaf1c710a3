#include "ensonify/output/inline_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ensonify/core/error.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string head = "<?xml version='1.0'?>\n<!DOCTYPE svg>\n<svg viewBox='0 0 9 9' width=\"9\" height='9'>";

std::string drawn(const std::string& inside) { return inline_svg(head + inside + "</svg>", "f1-", "alt"); }

std::string gnuplots(Series::Style style) {
  Plot plot = titled_plot("a <b> & 'c'", "x", "y");
  plot.series = {{"s", {0, 1, 2}, {1, 2, 3}, style, {0, 1, 2}, {2, 3, 4}}, {"t", {0, 1, 2}, {3, 2, 1}}};
  const auto svg = draw_plots({{plot}}, PlotFormat::svg);
  return {svg.begin(), svg.end()};
}

TEST(InlineSvg, KeepsShapesPlacesAndPaints) {
  EXPECT_EQ(drawn("<g stroke-width='2'><path d='M0,0 L1,1' stroke = 'rgb(  0, 114, 178)'/></g>"),
            "<svg viewBox=\"0 0 9 9\" width=\"9\" height=\"9\" role=\"img\" aria-label=\"alt\"><g stroke-width=\"2\">"
            "<path d=\"M0,0 L1,1\" stroke=\"var(--c-0072b2, #0072b2)\"></path></g></svg>");
}

TEST(InlineSvg, BlackFollowsThePageAndTheBackgroundIsThePages) {
  const std::string svg = drawn(
      "<rect x='0' y='0' width='9' height='9' fill='#ffffff'/><text fill='black'>a</text>"
      "<path stroke='rgb(0,0,0)' fill='none' d=''/><path fill='#CCCCCC' d=''/>");
  EXPECT_THAT(svg, Not(HasSubstr("rect")));
  EXPECT_THAT(svg, HasSubstr("<text fill=\"currentColor\">a</text>"));
  EXPECT_THAT(svg, HasSubstr("stroke=\"currentColor\" fill=\"none\""));
  EXPECT_THAT(svg, HasSubstr("var(--c-cccccc, #cccccc)"));
}

TEST(InlineSvg, NothingThatRunsLoadsOrLeadsAwayIsLeft) {
  const std::string svg = drawn(
      "<script>alert(1)</script><style>*{}</style><foreignObject><b>x</b></foreignObject><a xlink:href='http://x'>"
      "<text>in a link</text></a><g onclick='alert(1)' style='fill:url(http://x)' class='c'><text>t</text></g>"
      "<image xlink:href='http://x/y.png'/><use href='http://x#y'/><path fill='url(http://x)' d=''/><!-- c -->"
      "<![CDATA[<script>]]>");
  for (const char* bad : {"script", "http", "onclick", "style", "class", "foreign", "link", "url", "--"}) {
    EXPECT_THAT(svg, Not(HasSubstr(bad)));
  }
  EXPECT_THAT(svg, HasSubstr("<g><text>t</text></g>"));
}

TEST(InlineSvg, AttributesCanNotBeLeftByTheirQuotes) {
  const std::string svg = drawn("<text x='\" onload=\"alert(1)'>t</text>");
  EXPECT_THAT(svg, HasSubstr("x=\"&quot; onload=&quot;alert(1)\""));
  EXPECT_THAT(inline_svg(head + "</svg>", "p-", "<b> \"q\""), HasSubstr("aria-label=\"&lt;b&gt; &quot;q&quot;\""));
}

TEST(InlineSvg, UsedIdsGetThePrefixAndOthersGo) {
  const std::string svg = drawn(
      "<defs><circle id='a' r='1'/><use xlink:href='#a' id='b'/><use xlink:href='#c' id='d'/><path id='c' d=''/></defs>"
      "<g id='gnuplot_plot_1'><use xlink:href='#b'/></g>");
  EXPECT_THAT(svg, HasSubstr("<circle id=\"f1-a\" r=\"1\">"));
  EXPECT_THAT(svg, HasSubstr("<use href=\"#f1-a\" id=\"f1-b\">"));
  EXPECT_THAT(svg, HasSubstr("<use href=\"#f1-b\">"));
  for (const char* gone : {"f1-c", "f1-d", "gnuplot"}) EXPECT_THAT(svg, Not(HasSubstr(gone)));
}

TEST(InlineSvg, GnuplotsDrawingsComeThroughSmaller) {
  for (const auto style : {Series::Style::line, Series::Style::marked_line, Series::Style::points,
                           Series::Style::points_with_errors, Series::Style::bars_with_errors}) {
    const std::string before = gnuplots(style);
    const std::string svg = inline_svg(before, "f9-", "alt");
    EXPECT_LT(svg.size(), 0.7 * static_cast<double>(before.size()));
    EXPECT_THAT(svg, HasSubstr("a &lt;b&gt; &amp; 'c'"));
    EXPECT_THAT(svg, HasSubstr("--c-0072b2"));
    for (const char* bad : {"xmlns", "id=\"g", "#ffffff", "black", "font-family", "<title", "Gnuplot"}) {
      EXPECT_THAT(svg, Not(HasSubstr(bad)));
    }
    EXPECT_EQ(svg, inline_svg(gnuplots(style), "f9-", "alt"));
  }
}

TEST(InlineSvg, BrokenOnesAreRefused) {
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "<g>";
  for (const std::string& text :
       std::vector<std::string>{"", "svg", "<svg", "<svg>", "<svg><g></svg>", "<svg a></svg>", "<svg a=b></svg>",
                                "<svg a='></svg>", "<p></p>", "<svg><!-- </svg>", "<svg><g x='1'", "<svg>" + deep}) {
    EXPECT_THROW(inline_svg(text, "", ""), DataError) << text;
  }
}

}  // namespace
}  // namespace ensonify
