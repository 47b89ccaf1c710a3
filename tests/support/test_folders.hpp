#pragma once

#include <cstdlib>
#include <filesystem>

namespace ensonify {

/// The sources these tests were built from.
inline std::filesystem::path source_folder() { return ENSONIFY_SOURCE_DIR; }

/// Material for tests that is not part of the sources: $ENSONIFY_SHARED, else `shared` beside them. May be absent.
inline std::filesystem::path shared_folder() {
  const char* shared = std::getenv("ENSONIFY_SHARED");
  return shared != nullptr ? shared : source_folder().parent_path() / "shared";
}

}  // namespace ensonify
