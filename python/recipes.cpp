#include <fmt/format.h>

#include <mutex>
#include <optional>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/generate.hpp"
#include "ensonify/python/interruptible.hpp"
#include "ensonify/python/per_process.hpp"
#include "ensonify/python/pings.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {
namespace {

/// A recipe, and its places once they are built.
class PyRecipe {
 public:
  PyRecipe(const py::object& source, std::optional<std::uint64_t> seed, std::optional<int> pairs, std::string isa)
      : isa_(std::move(isa)), pairs_(pairs.value_or(0)) {
    const ConfigSource from = source_from(source, "recipe");
    word_ = std::holds_alternative<std::string>(from) ? std::get<std::string>(from) : "RECIPE";
    recipe_ = load_recipe(from);
    if (seed) recipe_.seed = *seed;
    if (pairs && *pairs < 1) throw py::value_error("pairs must be 1 or more");
    if (pairs) set_training_pairs(recipe_, *pairs);
  }

  const Recipe& recipe() const { return recipe_; }

  std::unique_ptr<PyFrame> make_frame(int index) {
    if (index < 0) index += recipe_.frames();
    if (index < 0 || index >= recipe_.frames()) {
      throw py::index_error(fmt::format("the recipe has frames 0 to {}", recipe_.frames() - 1));
    }
    const FrameMaker& maker = ready();
    const Unlocked unlocked;
    return py_frame(maker, maker.make(index));
  }

  std::unique_ptr<PyFrame> draw_frame(const std::string& split, std::uint64_t seed,
                                      const std::vector<std::uint64_t>& address) {
    const int at = split_of(split);
    const RandomKey world = RandomKey::from_seed(seed);
    RandomKey frame = world.child("stream");
    for (const std::uint64_t part : address) frame = frame.child(part);
    const FrameMaker& maker = ready();
    const Unlocked unlocked;
    return py_frame(maker, maker.draw(at, world, frame));
  }

  std::string generate_into(const std::filesystem::path& out, const std::string& format, int shard, int shards,
                            bool force, const py::object& progress) {
    GenerateOptions options;
    options.out = out;
    if (format != "folder" && format != "webdataset") throw py::value_error("format must be folder or webdataset");
    options.format = format == "folder" ? SampleFormat::folder : SampleFormat::webdataset;
    if (shards < 1 || shard < 0 || shard >= shards) throw py::value_error("shard must be 0 to shards - 1");
    options.shard = shard;
    options.shards = shards;
    options.force = force;
    options.isa = isa_;
    options.command_line = command_line_of(word_, recipe_, isa_, options.format, pairs_);
    std::mutex mutex;
    std::optional<Progress> latest;
    options.on_progress = [&](const Progress& p) {
      const std::lock_guard lock(mutex);
      latest = p;
    };
    const Outcome outcome = interruptible(
        [&](const std::atomic<bool>& stopped) {
          options.stopped = [&] { return stopped.load(); };
          return generate(recipe_, options);
        },
        [&] {
          if (progress.is_none()) return;
          std::optional<Progress> news;
          {
            const std::lock_guard lock(mutex);
            news.swap(latest);
          }
          if (news) progress(std::string(news->stage), news->done, news->total);
        });
    return outcome == Outcome::complete ? "complete" : "shard_done";
  }

  int split_of(const std::string& name) const {
    std::vector<std::string> names;
    for (const Split& split : recipe_.splits) names.push_back(split.name);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      throw ConfigError(fmt::format("split '{}' is none of the recipe's: {}", name, fmt::join(names, ", ")));
    }
    return static_cast<int>(found - names.begin());
  }

 private:
  const FrameMaker& ready() {
    return maker_.get([&] { return std::make_unique<FrameMaker>(recipe_, isa_); });
  }

  Recipe recipe_;
  std::string word_, isa_;
  int pairs_;
  PerProcess<FrameMaker> maker_;
};

py::dict splits_of(const PyRecipe& recipe) {
  py::dict splits;
  for (const Split& split : recipe.recipe().splits) splits[py::str(split.name)] = split.frames;
  return splits;
}

}  // namespace

void bind_recipes(py::module_& m) {
  py::class_<PyRecipe>(m, "Recipe",
                       "Everything that a dataset follows from. Places are built when first needed, and kept.")
      .def(
          py::init<const py::object&, std::optional<std::uint64_t>, std::optional<int>, std::string>(),
          py::arg("source"), py::kw_only(), py::arg("seed") = py::none(), py::arg("pairs") = py::none(),
          py::arg("isa") = default_isa,
          "From a bundled name (recipe_names()), a YAML file or a dict of its keys; `seed` and the number of training\n"
          "`pairs` override it. Raises ConfigError.")
      .def_property_readonly("name", [](const PyRecipe& r) { return r.recipe().name; })
      .def_property_readonly("seed", [](const PyRecipe& r) { return r.recipe().seed; })
      .def_property_readonly("splits", &splits_of, "dict: frames of each split, in the order of the indices.")
      .def("__len__", [](const PyRecipe& r) { return r.recipe().frames(); })
      .def("make_frame", &PyRecipe::make_frame, py::arg("index"),
           "Frame `index` over the whole set, a pure function: the bits that `ensonify generate` writes. Raises\n"
           "IndexError, DataError.")
      .def("draw_frame", &PyRecipe::draw_frame, py::arg("split"), py::arg("seed"), py::arg("address"),
           "A frame beyond the set: place, pose, settings and noise are drawn with the numbers of `address`, a pure\n"
           "function of all arguments. Raises ConfigError where the split follows trajectories.")
      .def("generate", &PyRecipe::generate_into, py::arg("out"), py::kw_only(), py::arg("format") = "folder",
           py::arg("shard") = 0, py::arg("shards") = 1, py::arg("force") = false, py::arg("progress") = py::none(),
           "Writes the dataset into the folder `out`, or what is missing of it. `progress(stage, done, total)` is "
           "called\n"
           "now and then. Returns 'complete', or 'shard_done' where other shards are missing. KeyboardInterrupt stops\n"
           "it after the frames in work; the same call resumes.");
  m.def(
      "recipe_names", [] { return library_names("generators"); }, "Names of the bundled recipes.");
}

}  // namespace ensonify::python
