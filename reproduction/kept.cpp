#include "ensonify/reproduction/kept.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

constexpr const char* list_name = "sheet.json";

ContactSheet sheet_of(const json& list, const fs::path& folder) {
  ContactSheet sheet{list.at("title"), {}};
  for (const json& line : list.at("rows")) {
    ContactRow row{line.at("label"), {}};
    for (const json& entry : line.at("tiles")) {
      ContactTile tile{entry.at("caption"), {}};
      for (const json& name : entry.at("pictures")) {
        tile.pictures.push_back(read_png(folder / fs::path(name.get<std::string>()).filename()));
      }
      row.tiles.push_back(std::move(tile));
    }
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace

std::optional<std::string> find_kept(const fs::path& file, const FindingKey& key) {
  if (!fs::exists(file)) return {};
  std::string text = read_text(file);
  const std::size_t end = text.find('\n');
  if (end == std::string::npos || text.substr(0, end) != key) return {};
  return text.substr(end + 1);
}

void keep(const fs::path& file, const FindingKey& key, std::string_view text) {
  write_file(file, fmt::format("{}\n{}", key, text));
}

std::string kept_or(const fs::path& file, const FindingKey& key, const std::function<std::string()>& make) {
  if (auto text = find_kept(file, key)) return *std::move(text);
  std::string text = make();
  keep(file, key, text);
  return text;
}

void keep_sheet(const fs::path& folder, const FindingKey& key, const ContactSheet& sheet) {
  json list{{"title", sheet.title}, {"rows", json::array()}};
  int number = 0;
  for (const ContactRow& row : sheet.rows) {
    json tiles = json::array();
    for (const ContactTile& tile : row.tiles) {
      json names = json::array();
      for (const auto& picture : tile.pictures) {
        const std::string name = fmt::format("{:04}.png", number++);
        write_file(folder / name, encode_png(picture));
        names.push_back(name);
      }
      tiles.push_back({{"caption", tile.caption}, {"pictures", std::move(names)}});
    }
    list["rows"].push_back({{"label", row.label}, {"tiles", std::move(tiles)}});
  }
  keep(folder / list_name, key, list.dump(-1, ' ', false, json::error_handler_t::replace));
}

std::optional<ContactSheet> find_kept_sheet(const fs::path& folder, const FindingKey& key) {
  const auto text = find_kept(folder / list_name, key);
  if (!text) return {};
  try {
    return sheet_of(json::parse(*text), folder);
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: is no whole list ({}); delete its folder, and it is made anew",
                                (folder / list_name).string(), e.what()));
  }
}

}  // namespace ensonify
