#include "ensonify/mapping/inverse_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

void require_valid_shape(const ArcShape& shape, const char* kind) {
  if (!(shape.footprint_cells >= 0 && shape.footprint_cells <= 100)) {
    throw ConfigError(fmt::format("{}: footprint_cells {} lies outside 0..100; 1 pools what falls into one cell", kind,
                                  shape.footprint_cells));
  }
  if (!(shape.elevation_share > 0 && shape.elevation_share <= 1)) {
    throw ConfigError(fmt::format("{}: elevation_share {} lies outside (0, 1]; 1 is the nominal field of view", kind,
                                  shape.elevation_share));
  }
}

template <std::size_t... I>
InverseModel named(std::string_view kind, std::index_sequence<I...>) {
  std::optional<InverseModel> found;
  std::string known;
  const auto consider = [&](auto model) {
    known += fmt::format("{}{}", known.empty() ? "" : ", ", model.kind);
    if (kind == model.kind) found = model;
  };
  (consider(std::variant_alternative_t<I, InverseModel>{}), ...);
  if (!found) throw ConfigError(fmt::format("inverse sensor model '{}' is unknown; there are {}", kind, known));
  return *found;
}

}  // namespace

InverseModel inverse_model_named(std::string_view kind) {
  return named(kind, std::make_index_sequence<std::variant_size_v<InverseModel>>{});
}

const char* kind_of(const InverseModel& model) {
  return std::visit([](const auto& m) { return m.kind; }, model);
}

const LogOddsStep& step_of(const InverseModel& model) {
  return std::visit([](const auto& m) -> const LogOddsStep& { return m.step; }, model);
}

UpdateLaw law_of(const InverseModel& model) {
  return std::holds_alternative<Carve>(model) ? UpdateLaw::freed_for_good : UpdateLaw::add;
}

void require_valid(const InverseModel& model) {
  require_valid(step_of(model));
  std::visit(
      [](const auto& m) {
        if constexpr (requires { m.shape; }) require_valid_shape(m.shape, m.kind);
      },
      model);
}

}  // namespace ensonify
