#pragma once

#include <array>
#include <optional>
#include <variant>

#include "ensonify/config/reader.hpp"
#include "ensonify/filters/model_file.hpp"

/// How a method of the filter room lists its parameters: once, beside its struct. Command line, YAML and documentation
/// go over that list.
namespace ensonify {

enum class FilterRole {
  despeckles,  ///< grey image -> grey image
  detects,     ///< grey image -> mask of 0 and 255
  finishes,    ///< a step after a despeckler, as the paper has them
};

/// `published`: centred window, mirrored border, formulas of the papers. `pyradar`: as PyRadar and findpeaks compute
/// it.
enum class FilterVariant { published, pyradar };
enum class WaveletRule { visu, bayes };
/// How the cells on both sides of a cell give its background (Gandhi and Kassam 1988).
enum class CfarRule { ca, soca, goca, os };
/// What a network that finds echoes gives: their mask of 0 and 255, or their probability times 255.
enum class EchoOutput { mask, probability };

constexpr std::array<const char*, 2> choice_names(FilterVariant) { return {"published", "pyradar"}; }
constexpr std::array<const char*, 2> choice_names(WaveletRule) { return {"visu", "bayes"}; }
constexpr std::array<const char*, 4> choice_names(CfarRule) { return {"ca", "soca", "goca", "os"}; }
constexpr std::array<const char*, 2> choice_names(EchoOutput) { return {"mask", "probability"}; }

/// Side of a square window in pixels: odd, so that it has a centre.
struct WindowSize {
  int pixels = 5;
  int radius() const { return pixels / 2; }
};

template <typename Method>
struct FilterParameter {
  const char* name;
  std::variant<double Method::*, std::optional<double> Method::*, int Method::*, WindowSize Method::*,
               FilterVariant Method::*, WaveletRule Method::*, CfarRule Method::*, EchoOutput Method::*,
               ModelFile Method::*>
      member;
  const char* about;
  Limits limits = any_number;
  const char* unit = "";
  const char* otherwise = "";  ///< in words, where an optional number is left out
};

constexpr Limits window_limits{3, 101};

template <typename Method>
constexpr FilterParameter<Method> window_parameter() {
  return {"window", &Method::window, "side of the square window, odd", window_limits, "px"};
}
template <typename Method>
constexpr FilterParameter<Method> variant_parameter() {
  return {"variant", &Method::variant, "the papers' formulas, or PyRadar's with its even window"};
}

}  // namespace ensonify
