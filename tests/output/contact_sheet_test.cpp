#include "ensonify/output/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace ensonify {
namespace {

using Grey = Image2<std::uint8_t>;

TEST(ContactSheet, ShrinkingKeepsTheMean) {
  Grey image(8, 6, 0);
  for (int c = 0; c < 6; ++c) image(0, c) = 200;
  const Grey small = resized(image, 2, 3);
  EXPECT_EQ(small(0, 1), 50);
  EXPECT_EQ(small(1, 1), 0);
}

/// Pixels of one grey level: tells where a picture was drawn, and whether whole.
struct Box {
  int count = 0, left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

Box box_of(const Image2<Rgb>& sheet, std::uint8_t level) {
  Box box;
  for (int r = 0; r < sheet.rows(); ++r) {
    for (int c = 0; c < sheet.columns(); ++c) {
      if (sheet(r, c) != Rgb{level, level, level}) continue;
      ++box.count;
      box.left = std::min(box.left, c);
      box.right = std::max(box.right, c);
      box.top = std::min(box.top, r);
      box.bottom = std::max(box.bottom, r);
    }
  }
  return box;
}

TEST(ContactSheet, DrawsEveryPictureWholeInRowsAndColumns) {
  const Grey a(40, 90, 1), b(40, 90, 2), c(40, 90, 3), d(20, 90, 4);
  const ContactSheet sheet{"title", {{"harbour \xc3\xa9", {{"1", {a, b}}, {"2", {c}}}}, {"tank", {{"3", {d}}}}}};
  const Image2<Rgb> drawn = draw_contact_sheet(sheet);
  // Letters are drawn with grey edges, which may hit these levels: a picture is at least its own size.
  for (const auto& [level, size] : {std::pair{1, 3600}, {2, 3600}, {3, 3600}, {4, 1800}}) {
    EXPECT_GE(box_of(drawn, static_cast<std::uint8_t>(level)).count, size);
  }
  EXPECT_GT(box_of(drawn, 2).left, box_of(drawn, 1).right);
  EXPECT_EQ(box_of(drawn, 2).top, box_of(drawn, 1).top);
  EXPECT_GT(box_of(drawn, 3).left, box_of(drawn, 2).right);
  EXPECT_GT(box_of(drawn, 4).top, box_of(drawn, 1).bottom);
  EXPECT_EQ(box_of(drawn, 4).left, box_of(drawn, 1).left);
  // Above the pictures there is but paper and letters.
  const auto above = drawn.pixels().first(static_cast<std::size_t>(box_of(drawn, 1).top * drawn.columns()));
  EXPECT_GT(std::count_if(above.begin(), above.end(), [](Rgb p) { return p.red < 150; }), 50);
}

TEST(ContactSheet, DrawsNothingWithoutRows) { EXPECT_FALSE(draw_contact_sheet({"empty", {}}).empty()); }

}  // namespace
}  // namespace ensonify
