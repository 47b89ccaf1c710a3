#include "ensonify/generators/recipe_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include "ensonify/config/library.hpp"

namespace ensonify {
namespace {

/// A mesh has no water, no bounds and no navigable box.
void refuse_mesh(const Reader& entry, const std::string& scene) {
  const std::string extension = std::filesystem::path(scene).extension().string();
  if (extension.empty() || extension == ".yaml" || extension == ".yml") return;
  entry.fail("scene", fmt::format("{} is no scene YAML; write one whose objects name the mesh, such as "
                                  "{{name: thing, mesh: {}, material: steel}}",
                                  scene, std::filesystem::path(scene).filename().string()));
}

/// What the files of a place are called in the dataset: `name`, else the stem of the scene's file.
std::string place_name(Reader& entry, const std::string& scene) {
  constexpr std::size_t longest = 100;
  const bool own = entry.has("name");
  const std::string name = own ? entry.text("name") : std::filesystem::path(scene).stem().string();
  const bool harmless = std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return c <= ' ' || c == 127 ||
           std::string_view("\\\"'*?:<>|/").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (name.empty() || name.size() > longest || name[0] == '.' || name[0] == '-' || !harmless) {
    entry.fail(
        own ? "name" : "scene",
        fmt::format("{}names files of the dataset: it must be 1 to {} bytes without blanks, control characters or "
                    "any of \\ \" ' * ? : < > |, and not begin with . or -",
                    own ? "" : "the file name, without extension, ", longest));
  }
  return name;
}

std::vector<std::uint64_t> layouts_of(Reader& entry) {
  if (entry.has("layout")) {
    if (entry.has("layouts")) entry.fail("layout", "does not go with 'layouts'; keep one of the two");
    return {static_cast<std::uint64_t>(entry.integer("layout", 0, 1'000'000'000))};
  }
  if (!entry.has("layouts")) return {0};
  std::vector<std::uint64_t> layouts;
  for (const double layout : entry.numbers("layouts", -1, {0.0, 1e9})) {
    layouts.push_back(static_cast<std::uint64_t>(layout));
    if (layout != static_cast<double>(layouts.back())) entry.fail("layouts", "must be a list of whole numbers");
  }
  if (layouts.empty()) entry.fail("layouts", "needs at least one layout number");
  return layouts;
}

}  // namespace

std::vector<PlaceRef> read_places(Reader& split) {
  std::vector<PlaceRef> places;
  for (Reader& entry : split.children("places")) {
    const std::string scene = resolve_beside(entry, "scene", "scenes", entry.text("scene"));
    refuse_mesh(entry, scene);
    const std::string name = place_name(entry, scene);
    const std::vector<std::uint64_t> layouts = layouts_of(entry);
    for (const std::uint64_t layout : layouts) {
      places.push_back({layouts.size() == 1 ? name : fmt::format("{}_layout{}", name, layout), scene, layout});
    }
    entry.finish();
  }
  if (places.empty()) split.fail("places", "needs at least one scene");
  return places;
}

void tell_apart(std::vector<Split>& all) {
  std::map<std::string, int> count;
  for (const Split& split : all) {
    for (const PlaceRef& place : split.places) ++count[place.name];
  }
  for (Split& split : all) {
    for (PlaceRef& place : split.places) {
      if (count[place.name] > 1) place.name = fmt::format("{}_layout{}", place.name, place.layout);
    }
  }
}

void refuse_shared_places(const Reader& splits, const std::vector<Split>& all) {
  std::set<std::pair<std::string, std::uint64_t>> seen;
  std::map<std::string, std::string> scene_of_name;
  for (const Split& split : all) {
    for (const PlaceRef& place : split.places) {
      if (!seen.emplace(place.scene, place.layout).second) {
        splits.fail(split.name, fmt::format("place {} layout {} is used twice; splits must not share a layout",
                                            place.scene, place.layout));
      }
      const auto [other, fresh] = scene_of_name.emplace(place.name, place.scene);
      if (!fresh) {
        splits.fail(split.name, fmt::format("{} and {} would both be the place {}, which names files of the dataset; "
                                            "rename one of the two, or give it another name",
                                            other->second, place.scene, place.name));
      }
    }
  }
}

}  // namespace ensonify
