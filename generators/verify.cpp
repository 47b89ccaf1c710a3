#include "ensonify/generators/verify.hpp"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/file_list.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/generators/write_block.hpp"
#include "ensonify/output/grid_files.hpp"
#include "ensonify/output/sha256.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Verifier {
 public:
  Verifier(const fs::path& folder, const std::function<void(int, int)>& on_progress)
      : dataset_(open_dataset(folder)),
        manifest_(parse_json(dataset_.manifest, folder / "dataset.json")),
        on_progress_(on_progress) {}

  VerifyReport run() {
    if (manifest_.contains("manifest_sha256") && !seal_holds(dataset_.manifest)) {
      fault("dataset.json differs from its own manifest_sha256");
    }
    if (manifest_.contains("checksums")) read_checksums();
    Sha256 root;
    for (const DatasetSplit& split : dataset_.splits) check_split(split, root);
    check_grids(root);
    if (!checksums_.empty()) check_files_listed();
    if (root.hex() != dataset_.root_hash) fault("the root hash differs from the manifest's");
    return std::move(report_);
  }

 private:
  void fault(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    if (report_.faults.size() < 100) report_.faults.push_back(what);
  }

  void read_checksums() {
    const fs::path list = dataset_.folder / "checksums.txt";
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
  bool is_image_of_a_frame(const std::string& name) const {
    return dataset_.format == SampleFormat::folder && name.ends_with(".png");
  }

  void check_bytes(const std::string& name, const std::string& sha256) {
    try {
      if (sha256_of_file(dataset_.folder / name) != sha256) fault(fmt::format("{} differs from checksums.txt", name));
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
    for (const std::string& name : strangers(dataset_.folder, known)) {
      fault(fmt::format("{} is no file of the dataset; move it elsewhere", name));
    }
  }

  void check_split(const DatasetSplit& split, Sha256& root) {
    MetadataIndex metadata;
    try {
      metadata = index_metadata(dataset_, split.blocks.front().split);
    } catch (const Error& e) {
      fault(e.what());
      for (const auto& [name, sha256] : checksums_) {
        if (name.starts_with(split.name + "/") && is_image_of_a_frame(name)) check_bytes(name, sha256);
      }
      return;
    }
    std::vector<std::string> hashes(static_cast<std::size_t>(split.frames));
    parallel_for(static_cast<int>(split.blocks.size()), [&](int b) {
      const DatasetBlock& block = split.blocks[static_cast<std::size_t>(b)];
      const std::span block_hashes(&hashes[static_cast<std::size_t>(block.first)],
                                   static_cast<std::size_t>(block.frames));
      for (const DatasetBlock& part : parts_of(block)) {
        try {
          const std::span part_hashes = block_hashes.subspan(static_cast<std::size_t>(part.first - block.first),
                                                             static_cast<std::size_t>(part.frames));
          check_block(split, part, read_lines(metadata, part.first, part.frames), part_hashes);
        } catch (const Error& e) {
          fault(e.what());
        }
      }
      Sha256 block_hash;
      for (const std::string& hash : block_hashes) block_hash.add(std::string_view(hash));
      if (block_hash.hex() != block.sha256) {
        fault(fmt::format("{}: frames {} to {} differ from the manifest", split.name, block.first,
                          block.first + block.frames - 1));
        name_changed_images(split, block);
      }
    });
    for (const std::string& hash : hashes) root.add(std::string_view(hash));
  }

  /// What is read at once: a tar, or the files of one frame, so that every broken one is named.
  std::vector<DatasetBlock> parts_of(const DatasetBlock& block) const {
    if (dataset_.format == SampleFormat::webdataset) return {block};
    std::vector<DatasetBlock> parts;
    for (int i = 0; i < block.frames; ++i) {
      parts.push_back(block);
      parts.back().first = block.first + i;
      parts.back().frames = 1;
    }
    return parts;
  }

  void name_changed_images(const DatasetSplit& split, const DatasetBlock& block) {
    for (int number = block.first; number < block.first + block.frames; ++number) {
      for (const char* kind : {"raw", "clean", "mask", "labels"}) {
        const auto listed = checksums_.find(fmt::format("{}/{}/{:06}.png", split.name, kind, number));
        if (listed != checksums_.end()) check_bytes(listed->first, listed->second);
      }
    }
  }

  void check_block(const DatasetSplit& split, const DatasetBlock& block, const std::vector<std::string>& lines,
                   std::span<std::string> hashes) {
    const auto every = [](int) { return true; };
    read_block(dataset_, block, every, [&](int number, const FramePixels& pixels) {
      const std::string wrong = pixel_fault(dataset_, pixels);
      if (!wrong.empty()) fault(fmt::format("{} {:06}: {}", split.name, number, wrong));
      const auto i = static_cast<std::size_t>(number - block.first);
      hashes[i] = content_hash(pixels, lines[i]);
      const std::scoped_lock lock(mutex_);
      on_progress_(++report_.frames, dataset_.frames());
    });
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
        const fs::path sibling = fs::path(dataset_.folder / file).replace_extension(extension);
        if (!fs::is_regular_file(sibling, error)) fault(fmt::format("{} is missing", sibling.string()));
      }
      try {
        const OccupancyGrid grid = read_grid(dataset_.folder / file);
        const std::string hash = Sha256().add(grid.occupancy).add(grid.observable).hex();
        if (hash != entry.at("sha256")) fault(fmt::format("{} differs from the manifest", file));
        root.add(std::string_view(hash));
        ++report_.grids;
      } catch (const DataError& e) {
        fault(e.what());
      }
    }
  }

  Dataset dataset_;
  json manifest_;
  std::function<void(int, int)> on_progress_;
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
