#pragma once

#include <memory>
#include <string>

namespace ensonify {

class LearnedModel;

/// A model by its path or bundled name, read when it is first used, once for all copies of this value.
class ModelFile {
 public:
  ModelFile() = default;
  explicit ModelFile(std::string path_or_name);

  /// As it was named; empty: none is.
  std::string name() const;

  /// Throws ConfigError where none is named or there is no such file, else as LearnedModel does.
  const LearnedModel& loaded() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace ensonify
