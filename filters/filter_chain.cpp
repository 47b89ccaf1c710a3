#include "ensonify/filters/filter_chain.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/filter_registry.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_steps = 32;

void check_finite(const Image2<float>& image) {
  const auto pixels = image.pixels();
  const auto bad = std::ranges::find_if(pixels, [](float x) { return !std::isfinite(x); });
  if (bad == pixels.end()) return;
  const auto at = static_cast<int>(bad - pixels.begin());
  throw DataError(fmt::format("pixel in row {}, column {} is {}; every pixel must be a finite number",
                              at / image.columns(), at % image.columns(), *bad));
}

const float log_scale = 255.0F / std::log(256.0F);

/// Calls change(levels) for every row, in memory of its own: where Eigen maps foreign memory, its alignment would
/// decide which numbers go the scalar way, and so their last bits.
template <typename Change>
void change_rows(Image2<float>& image, const Change& change) {
  Eigen::ArrayXf levels(image.columns());
  for (int i = 0; i < image.rows(); ++i) {
    Eigen::Map<Eigen::ArrayXf> row(image.row(i).data(), image.columns());
    levels = row;
    change(levels);
    row = levels;
  }
}

GreyImage to_log(const GreyImage& image) {
  GreyImage out{image.grey, GreyDepth::real};
  change_rows(out.grey, [](Eigen::ArrayXf& levels) { levels = log_scale * (levels.max(0.0F) + 1.0F).log(); });
  return out;
}

void from_log(Image2<float>& image) {
  change_rows(image, [](Eigen::ArrayXf& levels) { levels = (levels / log_scale).exp() - 1.0F; });
}

/// A model's path in a file starts from the file's folder.
std::string located(const Reader& reader, const std::string& key, const std::string& value) {
  const auto beside = reader.folder() / value;
  return key == "model" && std::filesystem::is_regular_file(beside) ? beside.string() : value;
}

FilterStep read_step(Reader& reader, const std::string& method) {
  FilterStep step;
  try {
    step = make_filter(method);
  } catch (const ConfigError& e) {
    reader.fail("method", e.what());
  }
  for (const std::string& key : reader.keys()) {
    if (key == "method") continue;
    const std::string fault = set_parameter(step, key, located(reader, key, reader.text(key)));
    if (!fault.empty()) reader.fail(key, fault);
  }
  try {
    check_filter(step);
  } catch (const ConfigError& e) {
    reader.fail("", e.what());
  }
  return step;
}

}  // namespace

GreyImage apply(const FilterStep& step, const GreyImage& image, const GreyImage& raw) {
  if (image.grey.empty()) return image;
  const bool log = step.domain == FilterDomain::log;
  const auto applied = [&](const auto& method) {
    if constexpr (std::is_same_v<std::decay_t<decltype(method)>, Mask>) {
      return apply(method, image, raw);
    } else {
      return apply(method, log ? to_log(image) : image);
    }
  };
  GreyImage out{std::visit(applied, step.method), GreyDepth::real};
  if (log) from_log(out.grey);
  return out;
}

GreyImage apply(const FilterChain& chain, const GreyImage& raw) {
  check_finite(raw.grey);
  if (chain.steps.empty()) return raw;
  GreyImage image = apply(chain.steps.front(), raw, raw);
  for (std::size_t i = 1; i < chain.steps.size(); ++i) image = apply(chain.steps[i], image, raw);
  return image;
}

FilterChain load_filter_chain(const ConfigSource& source) {
  Reader file = open_config("filters", source);
  FilterChain chain;
  chain.name = file.text("name");
  file.text_or("about", "");
  for (Reader& step : file.children("steps")) chain.steps.push_back(read_step(step, step.text("method")));
  if (chain.steps.empty() || chain.steps.size() > max_steps) {
    file.fail("steps", fmt::format("1 to {} steps", max_steps));
  }
  file.finish();
  return chain;
}

FilterChain find_filter(const std::string& method_or_chain) {
  const auto methods = filter_methods();
  const bool method = std::ranges::any_of(methods, [&](const MethodInfo& m) { return m.name == method_or_chain; });
  if (method) return {method_or_chain, {make_filter(method_or_chain)}};
  const auto chains = library_names("filters");
  const bool a_file =
      method_or_chain.find_first_of("./") != std::string::npos || std::filesystem::exists(method_or_chain);
  if (a_file || std::ranges::find(chains, method_or_chain) != chains.end()) return load_filter_chain(method_or_chain);
  return {method_or_chain, {make_filter(method_or_chain)}};  // says which method is nearest
}

FilterChain find_filter_or_none(const std::string& name) {
  return name == "none" ? FilterChain{name, {}} : find_filter(name);
}

FilterChain chain_for_maps(FilterChain filter, bool post_process) {
  auto& steps = filter.steps;
  if (!steps.empty() && role_of(steps.back().method) == FilterRole::detects) steps.push_back({Mask{}});
  if (post_process) {
    const bool sharp =
        std::ranges::any_of(steps, [](const FilterStep& step) { return std::holds_alternative<Unsharp>(step.method); });
    if (!sharp) steps.push_back({Unsharp{}});
    steps.push_back({Equalize{}});
  }
  return filter;
}

FilterPreset load_filter_preset(const std::string& path_or_name) {
  Reader file = Reader::from_file(resolve_name("filters/presets", path_or_name));
  FilterPreset preset;
  preset.name = file.text("name");
  preset.about = file.text_or("about", "");
  Reader methods = file.child("methods");
  for (const std::string& name : methods.keys()) {
    Reader parameters = methods.child(name);
    preset.methods.emplace(name, read_step(parameters, name));
    parameters.finish();
  }
  methods.finish();
  file.finish();
  return preset;
}

}  // namespace ensonify
