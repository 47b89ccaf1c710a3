#include "ensonify/filters/filter_registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

std::optional<double> parse_number(const std::string& text) {
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::string limits_rule(const char* kind, const Limits& limits) {
  return fmt::format("{} from {:g} to {:g}", kind, limits.low, limits.high);
}

// A kind of value: its rule in words, its value as text, and how text becomes the value (false: against the rule).

std::string rule_of(double, const Limits& limits) { return limits_rule("a number", limits); }
std::string rule_of(const std::optional<double>&, const Limits& limits) { return limits_rule("a number", limits); }
std::string rule_of(int, const Limits& limits) { return limits_rule("a whole number", limits); }
std::string rule_of(WindowSize, const Limits& limits) { return limits_rule("an odd number", limits); }
std::string rule_of(const ModelFile&, const Limits&) { return "a .onnx file or a bundled name"; }
template <typename Choice>
requires std::is_enum_v<Choice> std::string rule_of(Choice, const Limits&) {
  return fmt::format("{}", fmt::join(choice_names(Choice{}), " or "));
}

std::string text_of(double value) { return fmt::format("{:.6g}", value); }
std::string text_of(const std::optional<double>& value) { return value ? text_of(*value) : ""; }
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(WindowSize window) { return std::to_string(window.pixels); }
std::string text_of(const ModelFile& model) { return model.name(); }
template <typename Choice>
requires std::is_enum_v<Choice> std::string text_of(Choice choice) {
  return choice_names(choice)[static_cast<std::size_t>(choice)];
}

/// Read back, the same value: not rounded for readers.
template <typename Value>
std::string exact_text_of(const Value& value) {
  if constexpr (std::is_same_v<Value, double>) return fmt::format("{}", value);
  if constexpr (std::is_same_v<Value, std::optional<double>>) return value ? fmt::format("{}", *value) : "";
  return text_of(value);
}

bool parse(const std::string& text, const Limits& limits, double& value) {
  const auto number = parse_number(text);
  if (!number || *number < limits.low || *number > limits.high) return false;
  value = *number;
  return true;
}
bool parse(const std::string& text, const Limits& limits, std::optional<double>& value) {
  double number = 0;
  if (!parse(text, limits, number)) return false;
  value = number;
  return true;
}
bool parse(const std::string& text, const Limits& limits, int& value) {
  double number = 0;
  if (!parse(text, limits, number) || number != std::floor(number)) return false;
  value = static_cast<int>(number);
  return true;
}
bool parse(const std::string& text, const Limits& limits, WindowSize& window) {
  int side = 0;
  if (!parse(text, limits, side) || side % 2 == 0) return false;
  window.pixels = side;
  return true;
}
bool parse(const std::string& text, const Limits&, ModelFile& model) {
  if (text.empty()) return false;
  model = ModelFile(text);
  return true;
}
template <typename Choice>
requires std::is_enum_v<Choice>
bool parse(const std::string& text, const Limits&, Choice& choice) {
  const auto names = choice_names(Choice{});
  const auto found = std::ranges::find(names, text);
  if (found == names.end()) return false;
  choice = static_cast<Choice>(found - names.begin());
  return true;
}

/// Calls visit(parameter, reference to its value) for every parameter of the method.
template <typename Method, typename Visit>
void for_parameters(Method& method, const Visit& visit) {
  for (const auto& p : std::remove_const_t<Method>::parameters()) {
    std::visit([&](auto member) { visit(p, method.*member); }, p.member);
  }
}

constexpr const char* domain_about = "log: on 255 ln(1 + I) / ln 256";

/// A network has learned the scale on which it was trained.
bool has_domain(const FilterMethod& method) {
  return role_of(method) == FilterRole::despeckles && !std::holds_alternative<UnetClean>(method);
}

template <std::size_t... Kinds>
std::vector<FilterMethod> every_method(std::index_sequence<Kinds...>) {
  return {FilterMethod(std::in_place_index<Kinds>)...};
}
std::vector<FilterMethod> every_method() {
  return every_method(std::make_index_sequence<std::variant_size_v<FilterMethod>>{});
}

std::string instead(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(word, words);
  return nearest.empty() ? fmt::format("there are {}", fmt::join(words, ", "))
                         : fmt::format("did you mean '{}'?", nearest);
}

}  // namespace

MethodInfo method_info(const FilterMethod& method) {
  MethodInfo info{name_of(method), "", role_of(method), {}, true};
  std::visit(
      [&](const auto& m) {
        info.source = m.source;
        for_parameters(m, [&](const auto& p, const auto& value) {
          const std::string otherwise = *p.otherwise ? p.otherwise : text_of(value);
          info.parameters.push_back({p.name, otherwise, rule_of(value, p.limits), p.unit, p.about});
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, ModelFile>) info.ready = !value.name().empty();
        });
      },
      method);
  if (has_domain(method)) {
    info.parameters.push_back({"domain", text_of(FilterDomain{}), rule_of(FilterDomain{}, {}), "", domain_about});
  }
  return info;
}

std::vector<MethodInfo> filter_methods() {
  std::vector<MethodInfo> infos;
  for (const FilterMethod& method : every_method()) infos.push_back(method_info(method));
  return infos;
}

FilterStep make_filter(const std::string& name) {
  std::vector<std::string> names;
  for (const FilterMethod& method : every_method()) {
    if (name == name_of(method)) return {method};
    names.push_back(name_of(method));
  }
  throw ConfigError(fmt::format("no filter method '{}'; {}", name, instead(name, names)));
}

std::string set_parameter(FilterStep& step, const std::string& parameter, const std::string& value) {
  std::vector<std::string> names;
  std::optional<std::string> fault;
  const auto try_set = [&](const char* name, const Limits& limits, auto& target) {
    names.emplace_back(name);
    if (parameter != name) return;
    fault = parse(value, limits, target) ? std::string()
                                         : fmt::format("{}: {} must be {}, not '{}'", name_of(step.method), parameter,
                                                       rule_of(target, limits), value);
  };
  std::visit(
      [&](auto& m) { for_parameters(m, [&](const auto& p, auto& target) { try_set(p.name, p.limits, target); }); },
      step.method);
  if (has_domain(step.method)) try_set("domain", {}, step.domain);
  if (fault) return *fault;
  if (names.empty()) return fmt::format("{} has no parameters", name_of(step.method));
  return fmt::format("{} has no parameter '{}'; {}", name_of(step.method), parameter, instead(parameter, names));
}

void assign_parameter(FilterStep& step, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw ConfigError(fmt::format("'{}': write a parameter as key=value, for example window=7", assignment));
  }
  const std::string fault = set_parameter(step, assignment.substr(0, equals), assignment.substr(equals + 1));
  if (!fault.empty()) throw ConfigError(fault);
}

void check_filter(const FilterStep& step) {
  if (const auto* diffusion = std::get_if<Anisodiff>(&step.method)) check(*diffusion);
  if (const auto* network = std::get_if<Unet>(&step.method)) check(*network);
  if (const auto* network = std::get_if<UnetClean>(&step.method)) check(*network);
  if (const auto* network = std::get_if<Pix2Pix>(&step.method)) check(*network);
  const auto check_classes = [](const char* name, double cu, double cmax) {
    if (cmax > cu) return;
    throw ConfigError(fmt::format("{}: cmax = {:g} must be above cu = {:g}", name, cmax, cu));
  };
  if (const auto* lee = std::get_if<LeeEnhanced>(&step.method)) check_classes(lee->name, lee->cu, lee->cmax);
  if (const auto* map = std::get_if<GammaMap>(&step.method); map && map->cmax)
    check_classes(map->name, map->cu, *map->cmax);
}

std::vector<std::pair<std::string, std::string>> parameter_values(const FilterStep& step) {
  std::vector<std::pair<std::string, std::string>> values;
  std::visit(
      [&](const auto& m) {
        for_parameters(m, [&](const auto& p, const auto& value) {
          if (std::string text = exact_text_of(value); !text.empty()) values.emplace_back(p.name, std::move(text));
        });
      },
      step.method);
  if (has_domain(step.method)) values.emplace_back("domain", text_of(step.domain));
  return values;
}

}  // namespace ensonify
