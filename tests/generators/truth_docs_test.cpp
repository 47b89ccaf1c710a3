#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "ensonify/generators/truth_channels.hpp"
#include "support/test_folders.hpp"

namespace ensonify {
namespace {

/// First cells of the table in docs/datasets.md that starts with | channel |.
std::set<std::string> documented() {
  std::ifstream file(source_folder() / "docs/datasets.md");
  std::set<std::string> names;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| channel |")) inside = true;
    if (inside && line.empty()) break;
    if (inside && line.starts_with("| `")) names.insert(line.substr(3, line.find('`', 3) - 3));
  }
  return names;
}

TEST(TruthChannels, AreThoseOfTheDocument) {
  Echo echo{Image2<float>(2, 3), {}, {}};
  PingTruth truth;
  truth.elevation_min_rad = truth.elevation_max_rad = truth.elevation_strongest_rad = truth.incidence_rad = echo.direct;
  truth.instance = Image2<std::int32_t>(2, 3, -1);
  std::set<std::string> written;
  for (const auto& [name, image] : truth_channels(echo, {}, truth)) written.insert(name);
  EXPECT_EQ(documented(), written);
}

}  // namespace
}  // namespace ensonify
