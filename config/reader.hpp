#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// Allowed interval of a number, ends included.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};
constexpr Limits any_number{};
constexpr Limits positive{std::numeric_limits<double>::min(), std::numeric_limits<double>::max()};
constexpr Limits not_negative{0.0, std::numeric_limits<double>::max()};

/// Strict view of one YAML mapping. Every key asked for is a valid key; finish() refuses the others and names the
/// nearest valid one, so that a field is named once, where it is read. Errors are `ConfigError` with
/// "file:line: key: rule".
class Reader {
 public:
  /// Throws ConfigError where the file is missing, no YAML, or not a mapping.
  static Reader from_file(const std::filesystem::path& path);
  static Reader from_text(const std::string& yaml, const std::string& name);

  bool has(std::string_view key);
  double number(std::string_view key, Limits limits = any_number);
  double number_or(std::string_view key, double fallback, Limits limits = any_number);
  int integer(std::string_view key, int low, int high);
  int integer_or(std::string_view key, int fallback, int low, int high);
  bool boolean_or(std::string_view key, bool fallback);
  std::string text(std::string_view key);
  std::string text_or(std::string_view key, const std::string& fallback);
  /// One of `choices`; anything else names them.
  std::string choice(std::string_view key, const std::vector<std::string>& choices);
  /// Degrees in the file, radians returned. The key ends in _deg.
  double angle_deg(std::string_view key, Limits limits_deg = any_number);
  double angle_deg_or(std::string_view key, double fallback_deg, Limits limits_deg = any_number);
  /// `count` numbers, or any count where count < 0.
  std::vector<double> numbers(std::string_view key, int count = -1, Limits limits = any_number);
  Vec3 vec3(std::string_view key);
  Vec3 vec3_or(std::string_view key, const Vec3& fallback);
  std::vector<std::string> texts(std::string_view key);

  /// A mapping under `key`; call finish() on it too.
  Reader child(std::string_view key);
  /// A sequence of mappings under `key`; empty where the key is absent.
  std::vector<Reader> children(std::string_view key);
  /// The same, where relative paths start from the working folder.
  Reader in_working_folder() const;
  /// The keys of this mapping in file order, for mappings whose keys are names.
  std::vector<std::string> keys() const;
  /// The raw node under `key`, for values that are more than one kind.
  YAML::Node node(std::string_view key);

  /// Throws on every key that was never asked for.
  void finish() const;
  /// Throws ConfigError at the place of `key` (or of the mapping, where key is empty).
  [[noreturn]] void fail(std::string_view key, const std::string& rule) const;
  /// "file:line: path.key"
  std::string where(std::string_view key) const;
  /// The file's path, or the name of the text.
  const std::string& source_name() const { return source_->name; }
  /// Folder that relative paths in this file start from.
  const std::filesystem::path& folder() const { return source_->folder; }

 private:
  struct Source {
    std::string name;
    std::filesystem::path folder;
  };
  Reader(YAML::Node node, std::shared_ptr<const Source> source, std::string path);
  YAML::Node required(std::string_view key);

  YAML::Node node_;
  std::shared_ptr<const Source> source_;
  std::string path_;
  std::set<std::string, std::less<>> asked_;
};

/// The one of `candidates` with the least edit distance to `word`; empty where all are far off.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace ensonify
