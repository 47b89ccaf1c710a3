#pragma once

#include <string_view>
#include <variant>

#include "ensonify/mapping/log_odds.hpp"

/// The closed set of inverse sensor models: what one ping says of the cells around. At threshold t a pixel z echoes if
/// z >= t. Equations and reasons: docs/mapping.md. A new model is a struct here, an entry in InverseModel, and an
/// overload in mark_ping.cpp.
namespace ensonify {

/// Lin et al. (ICRA 2023): elevation is taken as 0. Lines from the sonar to the last bin of every beam are free but for
/// cells that hold the centre of an echoing pixel.
struct Points {
  static constexpr const char* kind = "points";
  LogOddsStep step = {};
};

/// How models that know of the elevation arc see a pixel.
struct ArcShape {
  /// A cell takes the strongest of the pixels whose centres lie within half this many cells of its own, in range and
  /// across; 0: only the pixel that holds its centre.
  double footprint_cells = 1;
  /// Share of the nominal elevation field of view that counts, in (0, 1].
  double elevation_share = 1;
};

/// Every cell of the frustum takes its pixel: echo is occupied, none is free, in the shadow too.
struct Arc {
  static constexpr const char* kind = "arc";
  LogOddsStep step = {};
  ArcShape shape = {};
};

/// As `Arc`, but beyond the first return of its beam a cell without echo is left as it was.
struct ArcShadow {
  static constexpr const char* kind = "arc_shadow";
  LogOddsStep step = {};
  ArcShape shape = {};
};

/// The marks of `ArcShadow`, under the law freed_for_good: occupied is what echoed and was never found free.
struct Carve {
  static constexpr const char* kind = "carve";
  LogOddsStep step = {};
  ArcShape shape = {};
};

/// Echoes at their true elevation, which only a simulator knows: the upper bound. Free are the lines to them, and the
/// arcs that `ArcShadow` frees.
struct Oracle {
  static constexpr const char* kind = "oracle";
  LogOddsStep step = {};
  ArcShape shape = {};
};

using InverseModel = std::variant<Points, Arc, ArcShadow, Carve, Oracle>;

/// With default parameters. Throws ConfigError for another name than those of the structs.
InverseModel inverse_model_named(std::string_view kind);
const char* kind_of(const InverseModel& model);
const LogOddsStep& step_of(const InverseModel& model);
UpdateLaw law_of(const InverseModel& model);

/// Throws ConfigError for a parameter out of its range.
void require_valid(const InverseModel& model);

}  // namespace ensonify
