#include "ensonify/generators/write_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/generators/truth_channels.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/output/sha256.hpp"
#include "ensonify/output/tar_shard.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify {
namespace {

using nlohmann::json;

FramePixels pixels_of(const Frame& frame) {
  const PingImages& images = frame.images;
  FramePixels pixels{images.raw.grey, images.clean.grey, images.mask, images.labels};
  if (frame.sonar.receive.bits == 16) pixels.raw = quantise16(images.raw.level);
  return pixels;
}

/// Every image of a frame under the name of its folder, as PNG.
std::vector<std::pair<std::string, std::vector<std::uint8_t>>> encode(const FramePixels& pixels) {
  return {{"raw", std::visit([](const auto& raw) { return encode_png(raw); }, pixels.raw)},
          {"clean", encode_png(pixels.clean)},
          {"mask", encode_png(pixels.mask)},
          {"labels", encode_png(pixels.labels)}};
}

FrameRecord record_of(const FrameMaker& maker, const Frame& frame, const FramePixels& pixels) {
  std::string line = metadata_line(maker, frame.pose, frame.sonar, pixels.mask);
  std::string hash = content_hash(pixels, line);
  return {frame.pose.index, std::move(hash), std::move(line)};
}

void write_record(const DatasetPaths& paths, const Block& block, const BlockRecord& record) {
  json frames = json::array();
  for (const FrameRecord& r : record.frames) {
    frames.push_back({{"index", r.index}, {"sha256", r.sha256}, {"line", r.line}});
  }
  json files = json::array();
  for (const WrittenFile& f : record.files)
    files.push_back({{"name", f.name}, {"bytes", f.bytes}, {"sha256", f.sha256}});
  write_file(paths.block(block.index), json{{"frames", frames}, {"files", files}}.dump());
}

/// What lies at `path` now that it is written.
WrittenFile written(const DatasetPaths& paths, const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) throw disk_error(path, error.message());
  return {path.lexically_relative(paths.root).generic_string(), bytes, sha256_of_file(path)};
}

}  // namespace

std::string metadata_line(const FrameMaker& maker, const FramePose& pose, const SonarModel& sonar,
                          const Image2<std::uint8_t>& mask) {
  const Recipe& recipe = maker.recipe();
  const PlaceRef& place = maker.places()[static_cast<std::size_t>(pose.place)];
  const auto file = [&](const char* kind, const char* extension) {
    return fmt::format("{}/{:06}.{}", kind, pose.number, extension);
  };
  nlohmann::ordered_json line;
  line["file_name"] = file("raw", "png");
  line["mask_file_name"] = file("mask", "png");
  line["clean_file_name"] = file("clean", "png");
  line["labels_file_name"] = file("labels", "png");
  if (recipe.cell_truth) line["truth_file_name"] = file("truth", "exr");
  line["index"] = pose.index;
  line["scene"] = std::filesystem::path(place.scene).stem().string();
  line["layout"] = place.layout;
  line["place"] = place.name;
  line["sonar"] = sonar.name;
  line["range_min_m"] = sonar.geometry.range_min_m;
  line["range_max_m"] = sonar.geometry.range_max_m;
  line["noise"] = maker.noises()[static_cast<std::size_t>(pose.noise)].name;
  line["time"] = pose.time_s ? json(*pose.time_s) : json(nullptr);
  line["T_world_sonar"] = describe(pose.T_world_sonar);
  line["T_world_sonar_est"] = describe(pose.T_world_sonar_est);
  line["seed"] = recipe.seed;
  line["mask_share"] = static_cast<double>(std::count(mask.pixels().begin(), mask.pixels().end(), 255)) /
                       static_cast<double>(mask.size());
  line["sampled"] = json::object();
  for (const auto& [name, value] : pose.sampled) line["sampled"][name] = value;
  return line.dump();
}

std::string content_hash(const FramePixels& pixels, const std::string& line) {
  static_assert(std::endian::native == std::endian::little);
  const auto bytes = [](const auto& image) {
    const auto p = image.pixels();
    return std::span(reinterpret_cast<const std::uint8_t*>(p.data()), p.size_bytes());
  };
  return Sha256()
      .add(std::visit(bytes, pixels.raw))
      .add(bytes(pixels.clean))
      .add(bytes(pixels.mask))
      .add(bytes(pixels.labels))
      .add(std::string_view(line))
      .hex();
}

FrameRecord write_frame(const FrameMaker& maker, const DatasetPaths& paths, const Frame& frame,
                        std::vector<WrittenFile>& files) {
  const FramePixels pixels = pixels_of(frame);
  const std::string& split = maker.recipe().splits[static_cast<std::size_t>(frame.pose.split)].name;
  for (const auto& [kind, png] : encode(pixels)) {
    const auto file = paths.image(split, kind, frame.pose.number);
    write_file(file, png);
    files.push_back({file.lexically_relative(paths.root).generic_string(), png.size(), Sha256().add(png).hex()});
  }
  if (maker.recipe().cell_truth) {
    const auto file = paths.image(split, "truth", frame.pose.number);
    write_exr(file, truth_channels(frame.echo, frame.images, frame.truth), truth_comment);
    files.push_back(written(paths, file));
  }
  return record_of(maker, frame, pixels);
}

bool write_block(const FrameMaker& maker, const DatasetPaths& paths, const Block& block, SampleFormat format,
                 const std::function<bool()>& after_frame) {
  BlockRecord record;
  std::vector<ObservedCells> observed;
  const std::string& split = maker.recipe().splits[static_cast<std::size_t>(block.split)].name;
  std::optional<TarShard> tar;
  if (format == SampleFormat::webdataset) tar.emplace(paths.tar(split, block.number_in_split));
  for (int index = block.first; index < block.first + block.frames; ++index) {
    const Frame frame = maker.make(index);
    observed.push_back({frame.pose.place, observed_cells(frame.truth, frame.sonar.geometry, frame.pose.T_world_sonar,
                                                         maker.place(frame.pose.place).truth)});
    if (tar) {
      const FramePixels pixels = pixels_of(frame);
      for (const auto& [kind, png] : encode(pixels)) {
        tar->add(fmt::format("{:06}.{}.png", frame.pose.number, kind), png);
      }
      record.frames.push_back(record_of(maker, frame, pixels));
      const std::string& line = record.frames.back().line;
      tar->add(fmt::format("{:06}.json", frame.pose.number),
               {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
    } else {
      record.frames.push_back(write_frame(maker, paths, frame, record.files));
    }
    if (!after_frame()) return false;
  }
  if (tar) {
    tar->finish();
    record.files.push_back(written(paths, paths.tar(split, block.number_in_split)));
  }
  write_file(paths.observed(block.index), pack(observed));
  write_record(paths, block, record);
  return true;
}

BlockRecord read_block_record(const DatasetPaths& paths, const Block& block) {
  const auto file = paths.block(block.index);
  BlockRecord result;
  try {
    const json record = parse_json(read_text(file), file);
    for (const json& frame : record.at("frames")) {
      result.frames.push_back({frame.at("index"), frame.at("sha256"), frame.at("line")});
    }
    for (const json& f : record.at("files")) result.files.push_back({f.at("name"), f.at("bytes"), f.at("sha256")});
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken record: {}; delete it to make the block again", file.string(), e.what()));
  }
  if (static_cast<int>(result.frames.size()) != block.frames) {
    throw DataError(fmt::format("{}: {} frames recorded, {} expected; delete it to make the block again", file.string(),
                                result.frames.size(), block.frames));
  }
  return result;
}

bool is_done(const DatasetPaths& paths, const Block& block) {
  try {
    const BlockRecord record = read_block_record(paths, block);
    std::error_code error;
    if (!std::filesystem::is_regular_file(paths.observed(block.index), error)) return false;
    return std::all_of(record.files.begin(), record.files.end(), [&](const WrittenFile& f) {
      return std::filesystem::file_size(paths.root / f.name, error) == f.bytes && !error;
    });
  } catch (const DataError&) {
    return false;  // no record, or a broken one: the block is made anew
  }
}

std::vector<ObservedCells> read_observed(const DatasetPaths& paths, const Block& block) {
  const auto file = paths.observed(block.index);
  return unpack(read_file(file), file);
}

}  // namespace ensonify
