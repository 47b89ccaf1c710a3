#include "ensonify/generators/dataset_card.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ensonify/generators/json_text.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

using nlohmann::json;

const char* size_category(int frames) {
  if (frames < 1000) return "n<1K";
  if (frames < 10'000) return "1K<n<10K";
  if (frames < 100'000) return "10K<n<100K";
  if (frames < 1'000'000) return "100K<n<1M";
  return "1M<n<10M";
}

/// The rows of the images, and where they begin and end.
std::string describe_rows(const Recipe& recipe, const json& sonar) {
  const double begin_m = sonar["range_min_m"].get<double>();
  if (!recipe.range_max_m || std::holds_alternative<Constant>(*recipe.range_max_m)) {
    return fmt::format("{} range bins (rows, nearest first, {} to {} m)", sonar["range_bins"].get<int>(), begin_m,
                       sonar["range_max_m"].get<double>());
  }
  const Limits ends = ends_of(*recipe.range_max_m);
  const auto bins = [&](double end_m) {
    return load_sonar(recipe.sonar, {recipe.range_min_m, end_m, recipe.range_bins}).geometry.range_bins;
  };
  const int fewest = bins(ends.low);
  const int most = bins(ends.high);
  return fmt::format("{} range bins (rows, nearest first, from {} m to an end that is drawn, {} to {} m)",
                     fewest == most ? fmt::format("{}", fewest) : fmt::format("{} to {}", fewest, most), begin_m,
                     ends.low, ends.high);
}

}  // namespace

void write_dataset_card(const DatasetPaths& paths, const json& manifest, const Recipe& recipe) {
  int frames = 0;
  std::string configs;
  std::string counts;
  const bool folder = manifest["format"] == "folder";
  for (const auto& [split, count] : manifest["counts"].items()) {
    frames += count.get<int>();
    const std::string name = split == "val" ? "validation" : split;
    configs += fmt::format("  - split: {}\n    path: \"{}\"\n", name, folder ? split + "/**" : split + "/*.tar");
    counts += fmt::format("| {} | {} |\n", split, count.get<int>());
  }
  std::string places;
  for (const json& grid : manifest["grids"]) places += fmt::format("- {}\n", grid["place"].get<std::string>());
  const json& sonar = manifest["sonar"];
  write_file(
      paths.root / "README.md",
      fmt::format(
          R"(---
pretty_name: {quoted_title}
task_categories:
- image-segmentation
- image-to-image
tags:
- sonar
- underwater
- synthetic
size_categories:
- {size}
configs:
- config_name: default
  data_files:
{configs}---

# {title}

Simulated pings of a multibeam imaging sonar ({sonar}), made by ensonify {version}.
Every frame: the noisy image (`raw`), its noise-free direct-path twin (`clean`), the binary mask (255 exactly where
`clean` >= {threshold}), and labels (0 water, 1 direct echo, 2 multipath, 3 sidelobe, 4 shadow, 5 outside).
Images are {rows} by {beams} beams (columns, port first).
`metadata.jsonl` in every split gives the true pose (`T_world_sonar`, world ENU, sonar x forward, y left, z up, metres)
and, on trajectories, the dead-reckoned one (`T_world_sonar_est`). `grids/` holds the ground-truth occupancy of every
place: `occupancy` 0 free, 1 surface, 2 interior; `observable` 1 where this set's pings could see the cell.

| split | frames |
|---|---|
{counts}
Places (splits share none):

{places}
## Make it again

The same tool version, recipe, seed and `--isa {isa}` give the same pixels on any number of threads or machines:

```
{command}
```

Where the recipe itself is not at hand, `dataset.json` stands for it: it holds every value.

Content hash (SHA-256 over decoded pixels, metadata and grids): `{hash}`
)",
          // JSON's quoting is YAML's too.
          fmt::arg("quoted_title", manifest["recipe"]["title"].dump()),
          fmt::arg("title", manifest["recipe"]["title"].get<std::string>()), fmt::arg("size", size_category(frames)),
          fmt::arg("configs", configs), fmt::arg("sonar", sonar["title"].get<std::string>()),
          fmt::arg("version", ENSONIFY_VERSION), fmt::arg("threshold", manifest["mask"]["threshold"].get<int>()),
          fmt::arg("rows", describe_rows(recipe, sonar)), fmt::arg("beams", sonar["beam_azimuth_rad"].size()),
          fmt::arg("counts", counts), fmt::arg("places", places), fmt::arg("isa", manifest["isa"].get<std::string>()),
          fmt::arg("command", manifest["command_line"].get<std::string>()),
          fmt::arg("hash", manifest["root_hash"].get<std::string>())));
}

void write_croissant(const DatasetPaths& paths, const json& manifest) {
  json distribution = json::array();
  json fields = json::array();
  const bool folder = manifest["format"] == "folder";
  for (const auto& [split, count] : manifest["counts"].items()) {
    const std::string set = split + (folder ? "-images" : "-shards");
    distribution.push_back({{"@type", "cr:FileSet"},
                            {"@id", set},
                            {"name", set},
                            {"encodingFormat", folder ? "image/png" : "application/x-tar"},
                            {"includes", folder ? split + "/*/*.png" : split + "/*.tar"}});
    distribution.push_back({{"@type", "cr:FileObject"},
                            {"@id", split + "-metadata"},
                            {"name", split + "-metadata"},
                            {"contentUrl", split + "/metadata.jsonl"},
                            {"encodingFormat", "application/jsonlines"}});
    for (const char* field : {"file_name", "mask_file_name", "clean_file_name", "labels_file_name", "T_world_sonar"}) {
      fields.push_back({{"@type", "cr:Field"},
                        {"@id", fmt::format("{}/{}", split, field)},
                        {"name", field},
                        {"dataType", "sc:Text"},
                        {"source",
                         {{"fileObject", {{"@id", split + "-metadata"}}},
                          {"extract", {{"jsonPath", fmt::format("$.{}", field)}}}}}});
    }
  }
  const json croissant{
      {"@context",
       {{"@vocab", "https://schema.org/"}, {"sc", "https://schema.org/"}, {"cr", "http://mlcommons.org/croissant/"}}},
      {"@type", "sc:Dataset"},
      {"conformsTo", "http://mlcommons.org/croissant/1.0"},
      {"name", manifest["recipe"]["name"]},
      {"description", manifest["recipe"]["title"]},
      {"version", manifest["tool"]["version"]},
      {"distribution", distribution},
      {"recordSet",
       json::array({{{"@type", "cr:RecordSet"}, {"@id", "frames"}, {"name", "frames"}, {"field", fields}}})}};
  write_file(paths.root / "croissant.json", json_text(croissant));
}

}  // namespace ensonify
