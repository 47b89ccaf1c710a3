#pragma once

#include <functional>
#include <vector>

#include "ensonify/scenes/ship_form.hpp"

namespace ensonify {

/// The hull as a grid of plates: `stations` cells from stern to stem, and one cell a point of the section around.
class ShipShell {
 public:
  ShipShell(const Ship& ship, int stations);

  int stations() const { return stations_; }
  int points() const { return static_cast<int>(section_.size()); }
  /// Deck cells that lie within a hatch across.
  bool below_hatch(int point) const;
  /// Middle of a cell.
  Vec3 cell_m(int station, int point) const;

  /// The whole outer surface, closed by deck and transom.
  TriangleMesh solid() const;
  /// A shell of `plate_m` of those cells that `kept(station, point)` names, closed all round. Plates that would hang
  /// together by a corner only are cut away.
  TriangleMesh plates(const std::function<bool(int, int)>& kept, bool with_transom, double plate_m) const;

 private:
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  std::uint32_t index(int station, int point) const;
  Triangles cell(int station, int point) const;
  Triangles transom() const;

  ShipForm form_;
  std::vector<ShipForm::SectionPoint> section_;
  int stations_;
  Vec3 size_m_;
  Vec3 centre_m_;
  std::vector<Vec3> outer_m_;
};

}  // namespace ensonify
