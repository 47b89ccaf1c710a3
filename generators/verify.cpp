#include "ensonify/generators/verify.hpp"

#include <fmt/format.h>

#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/file_list.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/generators/write_block.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/output/sha256.hpp"
#include "ensonify/output/tar_shard.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array kinds{"raw", "clean", "mask", "labels"};
void set_image(FramePixels& pixels, const std::string& kind, int bits, std::span<const std::uint8_t> png,
               const fs::path& name) {
  if (kind == "raw" && bits == 16) {
    pixels.raw = decode_png<std::uint16_t>(png, name);
    return;
  }
  Image2<std::uint8_t> image = decode_png<std::uint8_t>(png, name);
  if (kind == "raw")
    pixels.raw = std::move(image);
  else if (kind == "clean")
    pixels.clean = std::move(image);
  else if (kind == "mask")
    pixels.mask = std::move(image);
  else if (kind == "labels")
    pixels.labels = std::move(image);
  else
    throw DataError(fmt::format("{}: not an image of a frame", name.string()));
}

/// What is wrong with the images of one frame; empty where nothing is. bins 0: a recipe may draw the range window a
/// frame, so the number of native bins may differ.
std::string image_fault(const FramePixels& pixels, int threshold, int bins, int beams) {
  const auto size_fault = [&](const auto& image) {
    const bool right = image.columns() == beams && image.rows() == (bins > 0 ? bins : pixels.clean.rows());
    return right ? std::string()
                 : fmt::format("{} x {} pixels, not {} x {}", image.rows(), image.columns(), bins, beams);
  };
  for (const std::string& fault : {std::visit(size_fault, pixels.raw), size_fault(pixels.clean),
                                   size_fault(pixels.mask), size_fault(pixels.labels)}) {
    if (!fault.empty()) return fault;
  }
  const auto clean = pixels.clean.pixels();
  const auto mask = pixels.mask.pixels();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (mask[i] != (clean[i] >= threshold ? 255 : 0)) return fmt::format("mask is not clean >= {}", threshold);
  }
  return {};
}

/// A whole number that a manifest gives, from 0 to `most`.
std::size_t count_of(const json& value, std::size_t most) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
    throw DataError(fmt::format("dataset.json: broken manifest: {} is no whole number from 0 to {}",
                                value.dump().substr(0, 40), most));
  }
  return value.get<std::size_t>();
}

constexpr std::size_t max_manifest_bytes = std::size_t{1} << 28;
constexpr std::size_t max_frames = 100'000'000;
constexpr std::uintmax_t max_line_bytes = 1 << 16;

class Verifier {
 public:
  Verifier(const fs::path& folder, const std::function<void(int, int)>& on_progress)
      : folder_(folder), on_progress_(on_progress) {
    const fs::path manifest = folder / "dataset.json";
    std::error_code error;
    if (!fs::is_regular_file(manifest, error)) {
      throw DataError(fmt::format(
          "{}: no dataset.json: no dataset, or an unfinished one; run generate again to finish it", folder.string()));
    }
    const std::string text = read_text(manifest, max_manifest_bytes);
    manifest_ = parse_json(text, manifest);
    if (manifest_.contains("manifest_sha256") && !seal_holds(text)) {
      fault("dataset.json differs from its own manifest_sha256");
    }
    threshold_ = static_cast<int>(count_of(manifest_.at("mask").at("threshold"), 255));
    bits_ = static_cast<int>(count_of(manifest_.at("sonar").at("receive").at("bits"), 16));
    beams_ = static_cast<int>(manifest_.at("sonar").at("beam_azimuth_rad").size());
    const json& sonar = manifest_.at("recipe").at("sonar");
    const bool varies = sonar.contains("range_max_m") && sonar["range_max_m"].is_object();
    bins_ = varies ? 0 : static_cast<int>(count_of(manifest_.at("sonar").at("range_bins"), max_frames));
    std::size_t total = 0;
    for (const auto& [split, count] : manifest_.at("counts").items()) total += count_of(count, max_frames);
    total_ = static_cast<int>(std::min(total, max_frames));
    folder_format_ = manifest_.at("format") == "folder";
    if (!folder_format_ && manifest_.at("format") != "webdataset") {
      throw DataError("dataset.json: broken manifest: the format is neither folder nor webdataset");
    }
  }

  VerifyReport run() {
    Sha256 root;
    if (manifest_.contains("checksums")) read_checksums();
    for (const auto& [split, first_shard] : splits_in_order()) check_split(split, first_shard, root);
    check_grids(root);
    if (!checksums_.empty()) check_files_listed();
    if (root.hex() != manifest_.at("root_hash")) fault("the root hash differs from the manifest's");
    return std::move(report_);
  }

 private:
  void fault(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    if (report_.faults.size() < 100) report_.faults.push_back(what);
  }

  void read_checksums() {
    const fs::path list = folder_ / "checksums.txt";
    try {
      if (sha256_of_file(list) != manifest_.at("checksums").at("sha256")) {
        return fault("checksums.txt differs from the manifest");  // and has nothing to say about other files
      }
      checksums_ = read_file_list(list);
    } catch (const DataError& e) {
      fault(e.what());
    }
  }

  /// Whether the content hash speaks for this file, so that its bytes may differ: another encoder, the same pixels.
  bool is_image_of_a_frame(const std::string& name) const { return folder_format_ && name.ends_with(".png"); }

  void check_bytes(const std::string& name, const std::string& sha256) {
    try {
      if (sha256_of_file(folder_ / name) != sha256) fault(fmt::format("{} differs from checksums.txt", name));
    } catch (const DataError& e) {
      fault(e.what());
    }
  }

  void check_files_listed() {
    const std::vector<std::pair<std::string, std::string>> files(checksums_.begin(), checksums_.end());
    parallel_for(static_cast<int>(files.size()), [&](int i) {
      const auto& [name, sha256] = files[static_cast<std::size_t>(i)];
      if (!is_image_of_a_frame(name)) check_bytes(name, sha256);
    });
    auto known = checksums_;
    for (const char* own : {"dataset.json", "checksums.txt"}) known.emplace(own, "");
    for (const std::string& name : strangers(folder_, known)) {
      fault(fmt::format("{} is no file of the dataset; move it elsewhere", name));
    }
  }

  std::vector<std::pair<std::string, std::size_t>> splits_in_order() const {
    std::vector<std::pair<std::string, std::size_t>> splits;
    const json& shards = manifest_.at("shards");
    for (std::size_t s = 0; s < shards.size(); ++s) {
      const std::string split = shards[s].at("split");
      if (split != "train" && split != "val" && split != "test") {
        throw DataError(fmt::format("dataset.json: broken manifest: no split '{}'; there are train, val and test",
                                    split.substr(0, 40)));
      }
      if (splits.empty() || splits.back().first != split) splits.emplace_back(split, s);
    }
    return splits;
  }

  std::vector<std::string> read_lines(const fs::path& file, std::size_t expected) const {
    std::error_code error;
    std::vector<std::string> lines;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) / max_line_bytes > expected) return lines;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  void check_split(const std::string& split, std::size_t first_shard, Sha256& root) {
    const auto expected = count_of(manifest_.at("counts").at(split), max_frames);
    const std::vector<std::string> lines = read_lines(folder_ / split / "metadata.jsonl", expected);
    if (lines.size() != expected) {
      fault(fmt::format("{}/metadata.jsonl has {} lines, {} expected", split, lines.size(), expected));
      for (const auto& [name, sha256] : checksums_) {
        if (name.starts_with(split + "/") && is_image_of_a_frame(name)) check_bytes(name, sha256);
      }
      return;
    }
    std::vector<std::string> hashes(lines.size());
    const json& shards = manifest_.at("shards");
    std::size_t last_shard = first_shard;
    while (last_shard < shards.size() && shards[last_shard].at("split") == split) ++last_shard;
    std::vector<std::size_t> starts{0};
    for (std::size_t s = first_shard; s < last_shard; ++s) {
      starts.push_back(starts.back() + count_of(shards[s].at("frames"), max_frames));
    }
    if (starts.back() != lines.size()) {
      fault(fmt::format("{}: the shards of the manifest hold {} frames, not {}", split, starts.back(), lines.size()));
      return;
    }
    parallel_for(static_cast<int>(last_shard - first_shard), [&](int s) {
      const auto number = static_cast<std::size_t>(s);
      const std::size_t first = starts[number], last = starts[number + 1];
      if (folder_format_)
        for (std::size_t i = first; i < last; ++i) check_files(split, i, lines[i], hashes[i]);
      else
        check_tar(split, s, first, last, lines, hashes);
      Sha256 shard_hash;
      for (std::size_t i = first; i < last; ++i) shard_hash.add(std::string_view(hashes[i]));
      if (shard_hash.hex() == shards[first_shard + number].at("sha256")) return;
      fault(fmt::format("{}: frames {} to {} differ from the manifest", split, first, last - 1));
      if (folder_format_) name_changed_images(split, first, last);
    });
    for (const std::string& hash : hashes) root.add(std::string_view(hash));
  }

  void name_changed_images(const std::string& split, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (const char* kind : kinds) {
        const auto listed = checksums_.find(fmt::format("{}/{}/{:06}.png", split, kind, i));
        if (listed != checksums_.end()) check_bytes(listed->first, listed->second);
      }
    }
  }

  void check_frame(const FramePixels& pixels, const std::string& what, const std::string& line, std::string& hash) {
    const std::string wrong = image_fault(pixels, threshold_, bins_, beams_);
    if (!wrong.empty()) fault(fmt::format("{}: {}", what, wrong));
    hash = content_hash(pixels, line);
    const std::scoped_lock lock(mutex_);
    on_progress_(++report_.frames, total_);
  }

  void check_files(const std::string& split, std::size_t number, const std::string& line, std::string& hash) {
    try {
      FramePixels pixels;
      for (const char* kind : kinds) {
        const fs::path file = folder_ / split / kind / fmt::format("{:06}.png", number);
        set_image(pixels, kind, bits_, read_file(file), file);
      }
      check_frame(pixels, fmt::format("{} {:06}", split, number), line, hash);
    } catch (const DataError& e) {
      fault(e.what());
    }
  }

  void check_tar(const std::string& split, int shard, std::size_t first, std::size_t last,
                 const std::vector<std::string>& lines, std::vector<std::string>& hashes) {
    try {
      read_frames_of_tar(split, shard, first, last, lines, hashes);
    } catch (const DataError& e) {
      fault(e.what());
    }
  }

  void read_frames_of_tar(const std::string& split, int shard, std::size_t first, std::size_t last,
                          const std::vector<std::string>& lines, std::vector<std::string>& hashes) {
    const fs::path path = folder_ / split / fmt::format("{}-{:06}.tar", split, shard);
    FramePixels pixels;
    std::size_t images = 0;
    std::size_t number = first;
    read_tar(path, [&](const std::string& member, const std::vector<std::uint8_t>& bytes) {
      if (number >= last) throw DataError(fmt::format("{}: more frames than the manifest says", path.string()));
      const std::string stem = fmt::format("{:06}.", number);
      if (!member.starts_with(stem)) throw DataError(fmt::format("{}: unexpected member {}", path.string(), member));
      const std::string kind = member.substr(stem.size(), member.find('.', stem.size()) - stem.size());
      if (kind != "json") {
        set_image(pixels, kind, bits_, bytes, path / member);
        ++images;
        return;
      }
      if (images != kinds.size()) throw DataError(fmt::format("{}: {} lacks images", path.string(), member));
      check_frame(pixels, fmt::format("{} {:06}", split, number), lines[number], hashes[number]);
      pixels = {};
      images = 0;
      ++number;
    });
    if (number != last) fault(fmt::format("{}: frames are missing", path.string()));
  }

  void check_grids(Sha256& root) {
    for (const json& entry : manifest_.at("grids")) {
      const std::string file = entry.at("file");
      if (!stays_inside(file) || !file.starts_with("grids/") || !file.ends_with(".npz")) {
        throw DataError(
            fmt::format("dataset.json: broken manifest: '{}' is no grids/<place>.npz", file.substr(0, 100)));
      }
      for (const char* extension : {".bt", ".pgm", ".yaml"}) {
        std::error_code error;
        const fs::path sibling = fs::path(folder_ / file).replace_extension(extension);
        if (!fs::is_regular_file(sibling, error)) fault(fmt::format("{} is missing", sibling.string()));
      }
      try {
        const OccupancyGrid grid = read_grid(folder_ / file);
        const std::string hash = Sha256().add(grid.occupancy).add(grid.observable).hex();
        if (hash != entry.at("sha256")) fault(fmt::format("{} differs from the manifest", file));
        root.add(std::string_view(hash));
        ++report_.grids;
      } catch (const DataError& e) {
        fault(e.what());
      }
    }
  }

  fs::path folder_;
  std::function<void(int, int)> on_progress_;
  json manifest_;
  int threshold_ = 0;
  int bits_ = 8;
  int beams_ = 0;
  int bins_ = 0;
  int total_ = 0;
  bool folder_format_ = true;
  std::map<std::string, std::string> checksums_;
  VerifyReport report_;
  std::mutex mutex_;
};

}  // namespace

VerifyReport verify_dataset(const fs::path& folder, const std::function<void(int, int)>& on_progress) {
  try {
    return Verifier(folder, on_progress).run();
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken manifest: {}", (folder / "dataset.json").string(), e.what()));
  }
}

}  // namespace ensonify
