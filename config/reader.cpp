#include "ensonify/config/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_file_bytes = 4u << 20;
constexpr std::size_t max_text_bytes = 1000;

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replace}));
    }
  }
  return row.back();
}

/// Whether a key that is there stands for one that is missing. Keys that are read later are valid, and some differ by a
/// few letters only (min_m and max_m): just what is all but the same, or the beginning of it.
bool stands_for(std::string_view present, std::string_view missing) {
  constexpr std::size_t shortest = 3;
  if (present.size() >= shortest && missing.starts_with(present)) return true;
  return edit_distance(present, missing) <= std::max(present.size(), missing.size()) / 4;
}

std::string describe(Limits limits) {
  if (limits.low == positive.low) return "must be above 0";
  if (limits.low == 0.0 && limits.high == not_negative.high) return "must not be negative";
  if (!std::isfinite(limits.low) && !std::isfinite(limits.high)) return "must be a finite number";
  return fmt::format("must lie in [{}, {}]", limits.low, limits.high);
}

/// The bytes of the UTF-8 character that `text` begins with; 0 where it begins with none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text[0]);
  const std::size_t length = byte < 0x80   ? 1
                             : byte < 0xC2 ? 0
                             : byte < 0xE0 ? 2
                             : byte < 0xF0 ? 3
                             : byte < 0xF5 ? 4
                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  const auto follows = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  return std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length), follows) ? length : 0;
}

/// What makes a text unfit to be shown, written into JSON, or taken for a path; empty where nothing does.
std::string text_fault(std::string_view text) {
  if (text.size() > max_text_bytes) return fmt::format("must be at most {} bytes long", max_text_bytes);
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return "must be UTF-8";
    if (static_cast<unsigned char>(text[0]) < ' ' || text[0] == 127) return "must not hold control characters";
    text.remove_prefix(length);
  }
  return {};
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  const std::size_t farthest = word.size() < 4 ? 1 : std::max<std::size_t>(2, word.size() / 3);
  std::size_t best_distance = farthest + 1;
  for (const std::string& candidate : candidates) {
    std::size_t distance = edit_distance(word, candidate);
    const bool begins = !word.empty() && candidate.starts_with(word);
    const bool goes_on = candidate.size() >= 3 && word.starts_with(candidate);
    if (begins || goes_on) distance = std::min(distance, farthest);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

Reader::Reader(YAML::Node node, std::shared_ptr<const Source> source, std::string path)
    : node_(std::move(node)), source_(std::move(source)), path_(std::move(path)) {
  if (!node_.IsMap()) fail("", "must be a mapping of keys to values");
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar()) fail("", "keys must be plain words");
    if (!seen.insert(entry.first.Scalar()).second) fail(entry.first.Scalar(), "is given twice; keep one");
  }
}

Reader Reader::from_file(const std::filesystem::path& path) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    throw ConfigError(fmt::format("{}: no such file", path.string()));
  }
  if (std::filesystem::file_size(path, no_throw) > max_file_bytes) {
    throw ConfigError(fmt::format("{}: larger than {} MiB, not a configuration", path.string(), max_file_bytes >> 20));
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw ConfigError(fmt::format("{}: can not be read", path.string()));
  Reader reader = from_text(text.str(), path.string());
  reader.source_ = std::make_shared<const Source>(Source{path.string(), path.parent_path()});
  return reader;
}

Reader Reader::in_working_folder() const {
  Reader reader = *this;
  reader.source_ = std::make_shared<const Source>(Source{source_->name, {}});
  return reader;
}

Reader Reader::from_text(const std::string& yaml, const std::string& name) {
  auto source = std::make_shared<const Source>(Source{name, {}});
  try {
    std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
    if (documents.empty()) documents.emplace_back();
    if (documents.size() > 1) {
      throw ConfigError(fmt::format("{}: holds {} YAML documents; it must be one", name, documents.size()));
    }
    return {documents[0], std::move(source), ""};
  } catch (const YAML::DeepRecursion&) {
    throw ConfigError(fmt::format("{}: nested 500 deep or more, no configuration", name));
  } catch (const YAML::Exception& e) {
    throw ConfigError(fmt::format("{}:{}: no valid YAML: {}", name, e.mark.line + 1, e.msg));
  }
}

bool Reader::has(std::string_view key) {
  asked_.emplace(key);
  const YAML::Node value = node_[std::string(key)];
  return value.IsDefined() && !value.IsNull();
}

YAML::Node Reader::node(std::string_view key) { return required(key); }

YAML::Node Reader::required(std::string_view key) {
  if (!has(key)) {
    for (const std::string& present : keys()) {
      if (!asked_.contains(present) && stands_for(present, key)) {
        fail(present, fmt::format("did you mean '{}', which is missing here?", key));
      }
    }
    fail("", fmt::format("needs the key '{}'", key));
  }
  return node_[std::string(key)];
}

double Reader::number(std::string_view key, Limits limits) {
  const YAML::Node value = required(key);
  double number = 0;
  if (!value.IsScalar() || !YAML::convert<double>::decode(value, number)) {
    fail(key, fmt::format("must be a plain number (the unit is in the key), not '{}'",
                          value.IsScalar() ? value.Scalar() : "a list or mapping"));
  }
  if (!std::isfinite(number) || number < limits.low || number > limits.high) {
    fail(key, fmt::format("{}, not {}", describe(limits), value.Scalar()));
  }
  return number;
}

double Reader::number_or(std::string_view key, double fallback, Limits limits) {
  return has(key) ? number(key, limits) : fallback;
}

int Reader::integer(std::string_view key, int low, int high) {
  const double value = number(key);
  if (value != std::floor(value) || value < low || value > high) {
    fail(key, fmt::format("must be a whole number in [{}, {}], not {}", low, high, value));
  }
  return static_cast<int>(value);
}

int Reader::integer_or(std::string_view key, int fallback, int low, int high) {
  return has(key) ? integer(key, low, high) : fallback;
}

bool Reader::boolean_or(std::string_view key, bool fallback) {
  if (!has(key)) return fallback;
  const YAML::Node value = required(key);
  bool flag = false;
  if (!value.IsScalar() || !YAML::convert<bool>::decode(value, flag)) fail(key, "must be true or false");
  return flag;
}

std::string Reader::text(std::string_view key) {
  const YAML::Node value = required(key);
  if (!value.IsScalar()) fail(key, "must be a single text");
  if (const std::string fault = text_fault(value.Scalar()); !fault.empty()) fail(key, fault);
  return value.Scalar();
}

std::string Reader::text_or(std::string_view key, const std::string& fallback) {
  return has(key) ? text(key) : fallback;
}

std::string Reader::choice(std::string_view key, const std::vector<std::string>& choices) {
  const std::string value = text(key);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    fail(key, fmt::format("must be one of {}, not '{}'", fmt::join(choices, ", "), value));
  }
  return value;
}

double Reader::angle_deg(std::string_view key, Limits limits_deg) { return radians(number(key, limits_deg)); }

double Reader::angle_deg_or(std::string_view key, double fallback_deg, Limits limits_deg) {
  return radians(number_or(key, fallback_deg, limits_deg));
}

std::vector<double> Reader::numbers(std::string_view key, int count, Limits limits) {
  const YAML::Node value = required(key);
  const std::string shape = count < 0 ? "a list of numbers" : fmt::format("a list of {} numbers", count);
  if (!value.IsSequence() || (count >= 0 && value.size() != static_cast<std::size_t>(count))) {
    fail(key, "must be " + shape);
  }
  std::vector<double> result;
  result.reserve(value.size());
  for (const auto& item : value) {
    double number = 0;
    if (!item.IsScalar() || !YAML::convert<double>::decode(item, number) || !std::isfinite(number)) {
      fail(key, "must be " + shape);
    }
    if (number < limits.low || number > limits.high) fail(key, fmt::format("{}, not {}", describe(limits), number));
    result.push_back(number);
  }
  return result;
}

Vec3 Reader::vec3(std::string_view key) {
  const std::vector<double> v = numbers(key, 3);
  return {v[0], v[1], v[2]};
}

Vec3 Reader::vec3_or(std::string_view key, const Vec3& fallback) { return has(key) ? vec3(key) : fallback; }

std::vector<std::string> Reader::texts(std::string_view key) {
  const YAML::Node value = required(key);
  std::vector<std::string> result;
  if (value.IsSequence()) {
    for (const auto& item : value) {
      if (!item.IsScalar()) fail(key, "must be a list of texts");
      if (const std::string fault = text_fault(item.Scalar()); !fault.empty()) fail(key, fault);
      result.push_back(item.Scalar());
    }
    return result;
  }
  return {text(key)};
}

Reader Reader::child(std::string_view key) {
  const YAML::Node value = required(key);
  if (!value.IsMap()) fail(key, "must be a mapping of keys to values");
  return {value, source_, path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key)};
}

std::vector<Reader> Reader::children(std::string_view key) {
  std::vector<Reader> result;
  if (!has(key)) return result;
  const YAML::Node value = required(key);
  if (!value.IsSequence()) fail(key, "must be a list of mappings");
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string path = fmt::format("{}{}{}[{}]", path_, path_.empty() ? "" : ".", key, i);
    if (!value[i].IsMap()) fail(key, fmt::format("entry {} must be a mapping of keys to values", i));
    result.push_back({value[i], source_, path});
  }
  return result;
}

std::vector<std::string> Reader::keys() const {
  std::vector<std::string> result;
  for (const auto& entry : node_) result.push_back(entry.first.Scalar());
  return result;
}

void Reader::finish() const {
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (asked_.contains(key)) continue;
    const std::vector<std::string> valid(asked_.begin(), asked_.end());
    const std::string nearest = nearest_word(key, valid);
    fail(key, nearest.empty() ? fmt::format("unknown key; valid are {}", fmt::join(valid, ", "))
                              : fmt::format("unknown key; did you mean '{}'?", nearest));
  }
}

std::string Reader::where(std::string_view key) const {
  int line = std::max(node_.Mark().line, 0);
  if (node_.IsMap()) {  // else the error is that it is none
    for (const auto& entry : node_) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) line = entry.first.Mark().line;
    }
  }
  std::string place = fmt::format("{}:{}", source_->name, line + 1);
  if (!path_.empty() || !key.empty()) {
    place += fmt::format(": {}{}{}", path_, path_.empty() || key.empty() ? "" : ".", key);
  }
  return place;
}

void Reader::fail(std::string_view key, const std::string& rule) const {
  throw ConfigError(fmt::format("{}: {}", where(key), rule));
}

}  // namespace ensonify
