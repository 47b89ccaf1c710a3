#include "ensonify/output/html_text.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ensonify/output/curve_table.hpp"
#include "ensonify/output/report_table.hpp"

namespace ensonify {
namespace {

TEST(HtmlText, EscapesWhatCouldBecomeATagOrEndAnAttribute) {
  EXPECT_EQ(escaped("<script>alert(\"1\" & '2')</script>"),
            "&lt;script&gt;alert(&quot;1&quot; &amp; &#39;2&#39;)&lt;/script&gt;");
  EXPECT_EQ(escaped("&lt;"), "&amp;lt;");
  EXPECT_EQ(escaped(std::string("a\0b\x01\x7f\n", 6)), "ab\n");
}

TEST(HtmlText, KeepsLettersAndMarksWhatIsNone) {
  const std::string letters = "Größe µ – 深度 \xF0\x9F\x90\x9F";
  EXPECT_EQ(escaped(letters), letters);
  const std::string no_letter = "\xEF\xBF\xBD";
  EXPECT_EQ(escaped("a\xFFz"), "a" + no_letter + "z");
  EXPECT_EQ(escaped("\xC3"), no_letter);                                  // cut short
  EXPECT_EQ(escaped("\xC0\xBC"), no_letter + no_letter);                  // "<" the long way
  EXPECT_EQ(escaped("\xED\xA0\x80"), no_letter + no_letter + no_letter);  // half of a pair
  EXPECT_EQ(escaped("\xC3<b>"), no_letter + "&lt;b&gt;");                 // swallows no tag
}

TEST(HtmlText, AnchorsAreWords) {
  EXPECT_EQ(anchor_of("Grey levels & range (m)"), "grey-levels-range-m");
  EXPECT_EQ(anchor_of("\"><script>"), "script");
  EXPECT_EQ(anchor_of("深"), "x");
}

// RFC 4648, section 10.
TEST(HtmlText, PngBytesAsBase64) {
  const auto of = [](std::string_view text) {
    const std::string uri = png_uri({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return uri.substr(std::string_view("data:image/png;base64,").size());
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(of("\xFF\xFE\xFD"), "//79");
}

TEST(ReportTable, NumbersHaveTheirDigits) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fixed(1.005, 1), "1.0");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-0.1, 2), "-0.10");
  EXPECT_EQ(fixed(none, 2), "–");
  EXPECT_EQ(percent(0.12345), "12.3");
  EXPECT_EQ(significant(123456.0, 3), "1.23e+05");
  EXPECT_EQ(significant(none, 3), "–");
}

TEST(ReportTable, HeadsNameColumnsAndRows) {
  const std::string html = html_table({"A & B", {"name", "x [m]"}, {{"<b>", "1.5"}}, 1});
  EXPECT_NE(html.find("<caption><span>A &amp; B</span></caption>"), html.npos) << html;
  EXPECT_NE(html.find("<th scope=\"col\" class=\"head\">name</th><th scope=\"col\">x [m]</th>"), html.npos) << html;
  EXPECT_NE(html.find("<tr><th scope=\"row\">&lt;b&gt;</th><td>1.5</td></tr>"), html.npos) << html;
  EXPECT_EQ(html.find("<details>"), html.npos);
}

TEST(ReportTable, LongOnesAreFoldedUnlessTheyAreWhatThePageIsFor) {
  ReportTable table{"Many", {"x"}, std::vector<std::vector<std::string>>(50, {"1"}), 1};
  EXPECT_NE(html_table(table).find("<summary>Many (50 rows)</summary>"), std::string::npos);
  table.open = true;
  EXPECT_EQ(html_table(table).find("<details>"), std::string::npos);
}

TEST(CurveTable, ALineAnXAndAColumnASeries) {
  Plot plot = titled_plot("", "t", "share");
  plot.series = {{"a", {2, 1}, {0.25, 0.5}}, {"b", {2, 3}, {1, 0}}};
  const ReportTable table = curve_table(plot, 0, 2);
  EXPECT_EQ(table.columns, (std::vector<std::string>{"t", "a", "b"}));
  const std::vector<std::vector<std::string>> rows{{"1", "0.50", "–"}, {"2", "0.25", "1.00"}, {"3", "–", "0.00"}};
  EXPECT_EQ(table.rows, rows);
}

}  // namespace
}  // namespace ensonify
