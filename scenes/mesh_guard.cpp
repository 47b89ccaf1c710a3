#include "ensonify/scenes/mesh_guard.hpp"

#include <fmt/format.h>

#include <fstream>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_text.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path, std::uintmax_t size) {
  std::string text(size, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in) throw DataError(fmt::format("{}: can not be read", path.string()));
  return text;
}

}  // namespace

void check_mesh_file(const fs::path& path, MeshFormat format) {
  const std::string file = path.string();
  std::error_code no_throw;
  if (!fs::is_regular_file(path, no_throw)) throw DataError(fmt::format("{}: no such file", file));
  const std::uintmax_t size = fs::file_size(path, no_throw);
  if (size == 0) throw DataError(fmt::format("{}: is empty", file));
  if (size > max_mesh_file_bytes) {
    throw DataError(fmt::format("{}: larger than {} MiB; reduce the mesh", file, max_mesh_file_bytes >> 20));
  }
  const std::string text = read_bytes(path, size);
  const std::string fault = mesh_text_fault(text, format);
  if (!fault.empty()) throw DataError(fmt::format("{}: can not be read as {}: {}", file, format_name(format), fault));
}

}  // namespace ensonify
