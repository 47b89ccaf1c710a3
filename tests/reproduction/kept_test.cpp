#include "ensonify/reproduction/kept.hpp"

#include <gtest/gtest.h>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

class Kept : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }
  const fs::path folder = fs::path(testing::TempDir()) / "ensonify_kept_test";
};

TEST_F(Kept, IsMadeOnceAKey) {
  int made = 0;
  const auto make = [&] { return std::to_string(++made) + "\nand more\n"; };
  EXPECT_EQ(kept_or(folder / "a.json", "key 1", make), "1\nand more\n");
  EXPECT_EQ(kept_or(folder / "a.json", "key 1", make), "1\nand more\n");
  EXPECT_EQ(kept_or(folder / "a.json", "key 2", make), "2\nand more\n");
  EXPECT_FALSE(find_kept(folder / "a.json", "key 1"));
  EXPECT_FALSE(find_kept(folder / "a.json", "key"));
  EXPECT_FALSE(find_kept(folder / "b.json", "key 1"));
}

TEST_F(Kept, AnEmptyFileIsNone) {
  write_file(folder / "a.json", std::string_view());
  EXPECT_FALSE(find_kept(folder / "a.json", ""));
}

TEST_F(Kept, SheetsComeBack) {
  Image2<std::uint8_t> first(2, 3), second(1, 1);
  first(1, 2) = 200;
  second(0, 0) = 7;
  const ContactSheet sheet{"a \"title\"", {{"row", {{"tile", {first, second}}, {"none", {}}}}, {"empty", {}}}};
  keep_sheet(folder / "sheet", "key", sheet);
  const auto back = find_kept_sheet(folder / "sheet", "key");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->title, sheet.title);
  ASSERT_EQ(back->rows.size(), 2U);
  EXPECT_EQ(back->rows[0].label, "row");
  EXPECT_EQ(back->rows[0].tiles.at(0).caption, "tile");
  ASSERT_EQ(back->rows[0].tiles.at(0).pictures.size(), 2U);
  EXPECT_TRUE(std::ranges::equal(back->rows[0].tiles[0].pictures[0].pixels(), first.pixels()));
  EXPECT_TRUE(std::ranges::equal(back->rows[0].tiles[0].pictures[1].pixels(), second.pixels()));
  EXPECT_FALSE(find_kept_sheet(folder / "sheet", "another key"));

  fs::remove(folder / "sheet" / "0001.png");
  EXPECT_THROW(find_kept_sheet(folder / "sheet", "key"), DataError);
}

TEST_F(Kept, AListLeadsNowhereElse) {
  keep_sheet(folder / "sheet", "key", {"", {{"row", {{"tile", {Image2<std::uint8_t>(1, 1)}}}}}});
  keep(folder / "sheet" / "sheet.json", "key",
       R"({"title": "", "rows": [{"label": "", "tiles": [{"caption": "", "pictures": ["../../0000.png"]}]}]})");
  EXPECT_EQ(find_kept_sheet(folder / "sheet", "key")->rows.at(0).tiles.at(0).pictures.size(), 1U);  // its own 0000.png
  keep(folder / "sheet" / "sheet.json", "key", R"({"title": 3})");
  EXPECT_THROW(find_kept_sheet(folder / "sheet", "key"), DataError);
}

}  // namespace
}  // namespace ensonify
