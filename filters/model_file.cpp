#include "ensonify/filters/model_file.hpp"

#include <fmt/format.h>

#include <mutex>
#include <optional>

#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/learned_model.hpp"

namespace ensonify {
namespace {

constexpr const char* cure = "docs/learned_filter.md says how to train one";

}  // namespace

struct ModelFile::Shared {
  std::string name;
  std::mutex mutex;
  std::optional<LearnedModel> model;
};

ModelFile::ModelFile(std::string path_or_name) : shared_(std::make_shared<Shared>()) {
  shared_->name = std::move(path_or_name);
}

std::string ModelFile::name() const { return shared_ ? shared_->name : ""; }

const LearnedModel& ModelFile::loaded() const {
  if (!shared_) throw ConfigError(fmt::format("model must be given: the .onnx file of a trained network; {}", cure));
  const std::lock_guard lock(shared_->mutex);
  if (!shared_->model) {
    try {
      shared_->model.emplace(resolve_name("filters/models", shared_->name, ".onnx"));
    } catch (const ConfigError& e) {
      throw ConfigError(fmt::format("model {}; {}", e.what(), cure));
    }
  }
  return *shared_->model;
}

}  // namespace ensonify
