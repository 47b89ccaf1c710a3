#include "ensonify/generators/verify.hpp"

#include <fmt/format.h>

#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/dataset_reader.hpp"
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
      : dataset_(open_dataset(folder)), on_progress_(on_progress) {}

  VerifyReport run() {
    Sha256 root;
    for (const DatasetSplit& split : dataset_.splits) check_split(split, root);
    check_grids(root);
    if (root.hex() != dataset_.root_hash) fault("the root hash differs from the manifest's");
    return std::move(report_);
  }

 private:
  void fault(const std::string& what) {
    const std::scoped_lock lock(mutex_);
    if (report_.faults.size() < 100) report_.faults.push_back(what);
  }

  void check_split(const DatasetSplit& split, Sha256& root) {
    MetadataIndex metadata;
    try {
      metadata = index_metadata(dataset_, split.blocks.front().split);
    } catch (const Error& e) {
      fault(e.what());
      return;
    }
    std::vector<std::string> hashes(static_cast<std::size_t>(split.frames));
    parallel_for(static_cast<int>(split.blocks.size()), [&](int b) {
      const DatasetBlock& block = split.blocks[static_cast<std::size_t>(b)];
      const std::span block_hashes(&hashes[static_cast<std::size_t>(block.first)],
                                   static_cast<std::size_t>(block.frames));
      try {
        check_block(split, block, read_lines(metadata, block.first, block.frames), block_hashes);
      } catch (const Error& e) {
        fault(e.what());
      }
      Sha256 block_hash;
      for (const std::string& hash : block_hashes) block_hash.add(std::string_view(hash));
      if (block_hash.hex() != block.sha256) {
        fault(fmt::format("{}: frames {} to {} differ from the manifest", split.name, block.first,
                          block.first + block.frames - 1));
      }
    });
    for (const std::string& hash : hashes) root.add(std::string_view(hash));
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
    const json manifest = json::parse(dataset_.manifest);
    for (const json& entry : manifest.at("grids")) {
      const std::string file = entry.at("file");
      try {
        const OccupancyGrid grid = read_grid(dataset_.folder / file);
        const std::string hash = Sha256().add(grid.occupancy).add(grid.observable).hex();
        if (hash != entry.at("sha256")) fault(fmt::format("{} differs from the manifest", file));
        root.add(std::string_view(hash));
        for (const char* extension : {".bt", ".pgm", ".yaml"}) {
          const fs::path sibling = fs::path(dataset_.folder / file).replace_extension(extension);
          if (!fs::is_regular_file(sibling)) fault(fmt::format("{} is missing", sibling.string()));
        }
        ++report_.grids;
      } catch (const Error& e) {
        fault(e.what());
      }
    }
  }

  Dataset dataset_;
  std::function<void(int, int)> on_progress_;
  VerifyReport report_;
  std::mutex mutex_;
};

}  // namespace

VerifyReport verify_dataset(const fs::path& folder, const std::function<void(int, int)>& on_progress) {
  Verifier verifier(folder, on_progress);
  try {
    return verifier.run();
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken manifest: {}", (folder / "dataset.json").string(), e.what()));
  }
}

}  // namespace ensonify
