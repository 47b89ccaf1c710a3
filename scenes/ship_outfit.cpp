#include "ensonify/scenes/ship_outfit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/loft.hpp"
#include "ensonify/scenes/propeller.hpp"

namespace ensonify {
namespace {

enum UnitMesh { unit_box, unit_tube };

/// Puts parts on the deck. Sizes that are no parameter go with the length, as they do from ship to ship.
class Outfitter {
 public:
  Outfitter(const Ship& ship, RandomKey key) : ship_(ship), form_(ship), random_(key) {
    result_.meshes = {make_box(Vec3::Ones()), make_cylinder(1, 1, 20)};
  }

  double deck_z_m(double x_m) const { return form_.deck_z_m(form_.station_at(x_m)); }
  double deck_half_width_m(double x_m) const { return form_.deck_half_width_m(form_.station_at(x_m)); }

  /// A box with its foot at `foot_m`.
  void box(const Vec3& foot_m, const Vec3& size_m) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(foot_m + Vec3(0, 0, 0.5 * size_m.z())).scale(size_m);
    result_.parts.push_back({unit_box, T});
  }

  void tube(const Vec3& from_m, const Vec3& to_m, double radius_m) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(0.5 * (from_m + to_m)).rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), to_m - from_m));
    T.scale(Vec3(radius_m, radius_m, (to_m - from_m).norm()));
    result_.parts.push_back({unit_tube, T});
  }

  /// A mesh about its own origin.
  void own(TriangleMesh mesh, const Vec3& place_m) {
    result_.parts.push_back({static_cast<int>(result_.meshes.size()), Eigen::Affine3d(Eigen::Translation3d(place_m))});
    result_.meshes.push_back(std::move(mesh));
  }

  /// A block over the whole width of the deck, following its edge and its sheer.
  void raised_deck(double from_x_m, double to_x_m, double height_m) {
    constexpr int pieces = 16;
    const double middle_m = 0.5 * (from_x_m + to_x_m);
    std::vector<Ring> rings;
    for (int i = 0; i <= pieces; ++i) {
      const double x = from_x_m + (to_x_m - from_x_m) * i / pieces;
      const double y = 0.985 * deck_half_width_m(x), low_m = deck_z_m(x) - 0.1 * height_m,
                   high_m = deck_z_m(x) + height_m;
      const double along = x - middle_m;
      rings.push_back({{along, -y, low_m}, {along, y, low_m}, {along, y, high_m}, {along, -y, high_m}});
    }
    own(loft(rings, fan_cap(4)), {middle_m, 0, 0});
  }

  void hatch(const Hatch& hatch) {
    const double length_m = hatch.to_x_m - hatch.from_x_m, middle_m = 0.5 * (hatch.from_x_m + hatch.to_x_m);
    const double height_m = 0.014 * ship_.length_m, plate_m = 0.004 * ship_.length_m, z = deck_z_m(middle_m) - plate_m;
    const double width_m = 2 * hatch.half_width_m;
    if (hatch.covered) {
      box({middle_m, 0, z}, {length_m, width_m, height_m + plate_m});
      constexpr int panels = 4;
      for (int i = 0; i < panels; ++i) {
        const double x = hatch.from_x_m + length_m * (i + 0.5) / panels;
        box({x, 0, z + height_m}, {0.92 * length_m / panels, width_m + 2 * plate_m, 2 * plate_m});
      }
      return;
    }
    for (const double side : {-1.0, 1.0}) {
      box({middle_m, side * hatch.half_width_m, z}, {length_m + plate_m, plate_m, height_m + plate_m});
      box({middle_m + side * 0.5 * length_m, 0, z}, {plate_m, width_m, height_m + plate_m});
    }
  }

  void deckhouse(double x_m) {
    const double length_m = 0.13 * ship_.length_m, tier_m = 0.028 * ship_.length_m;
    const double width_m = std::min(0.86 * ship_.beam_m, 1.9 * deck_half_width_m(x_m));
    double z = deck_z_m(x_m) - 0.3 * tier_m;
    constexpr int tiers = 4;
    for (int i = 0; i < tiers; ++i) {
      const double share = 1 - 0.12 * i;
      box({x_m + 0.5 * length_m * (1 - share), 0, z}, {share * length_m, width_m * (1 - 0.06 * i), 1.3 * tier_m});
      z += tier_m;
    }
    // Bridge with its wings, funnel behind, radar mast above.
    box({x_m + 0.36 * length_m, 0, z}, {0.26 * length_m, ship_.beam_m, 0.95 * tier_m});
    const double funnel_m = 0.16 * length_m;
    TriangleMesh funnel = turn_profile({{1, 0}, {0.9, 1}, {0.8, 1}, {0.8, 0.9}}, 28);
    for (Eigen::Vector3f& v : funnel.vertices_m) {
      v = v.cwiseProduct(Vec3(1.4 * funnel_m, funnel_m, 2.6 * tier_m).cast<float>());
    }
    if (random_.uniform() > 0.7 * ship_.damage) own(std::move(funnel), {x_m - 0.12 * length_m, 0, z});
    mast({x_m + 0.36 * length_m, 0, z}, 0.07 * ship_.length_m, 0.003 * ship_.length_m, false);
  }

  /// A post with cross trees and, for cargo, four booms at rest. A wreck's leans, or has fallen away.
  void mast(const Vec3& foot_m, double height_m, double radius_m, bool cargo) {
    const double lost = random_.uniform(), lean_rad = radians(50) * ship_.damage * random_.uniform();
    const double towards_rad = random_.uniform(0, 2 * std::numbers::pi);
    if (lost < 0.5 * ship_.damage) return;
    const Eigen::AngleAxisd lean(lean_rad, Vec3(std::cos(towards_rad), std::sin(towards_rad), 0));
    const auto place = [&](double x, double y, double z) -> Vec3 { return foot_m + lean * Vec3(x, y, z); };
    tube(place(0, 0, -2 * radius_m), place(0, 0, height_m), radius_m);
    const double yard_m = 0.22 * height_m;
    tube(place(0, -yard_m, 0.72 * height_m), place(0, yard_m, 0.72 * height_m), 0.6 * radius_m);
    if (!cargo) return;
    const double reach_m = 0.75 * height_m;
    for (const double side : {-1.0, 1.0}) {
      for (const double end : {-1.0, 1.0}) {
        if (random_.uniform() < 0.6 * ship_.damage) continue;
        tube(place(0, 0.6 * side * yard_m, 0.12 * height_m),
             place(end * reach_m, 0.8 * side * yard_m, (0.3 + 0.25 * random_.uniform()) * height_m), 0.45 * radius_m);
      }
    }
  }

  void stern_gear() {
    const double screw_m = 0.33 * ship_.draft_m, length_m = ship_.length_m;
    const double shaft_z_m = -ship_.draft_m + 1.15 * screw_m;
    own(make_propeller(screw_m), {form_.stern_x_m(0) - 0.011 * length_m, 0, shaft_z_m});
    tube({form_.stern_x_m(0) - 0.012 * length_m, 0, shaft_z_m}, {form_.stern_x_m(0) + 0.03 * length_m, 0, shaft_z_m},
         0.16 * screw_m);
    const double chord_m = 0.034 * length_m, thick_m = 0.16 * chord_m;
    Polygon foil;  // nose forward
    constexpr int around = 16;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const double along = std::cos(angle);
      foil.emplace_back(0.5 * chord_m * along, 0.5 * thick_m * std::sin(angle) * (0.65 + 0.35 * along));
    }
    own(extrude(foil, -0.97 * ship_.draft_m, 0.08 * ship_.draft_m), {-0.473 * length_m, 0, 0});
  }

  void bulb() {
    const double length_m = 0.055 * ship_.length_m, radius_m = std::min(0.24 * ship_.draft_m, 0.2 * ship_.beam_m);
    TriangleMesh egg = make_sphere(1, 3);
    for (Eigen::Vector3f& v : egg.vertices_m) {
      v = v.cwiseProduct(Vec3(length_m, 0.8 * radius_m, 1.25 * radius_m).cast<float>());
    }
    own(std::move(egg), {form_.stem_x_m(0.3) - 0.45 * length_m, 0, -ship_.draft_m + 1.35 * radius_m});
  }

  Assembly result() { return std::move(result_); }

 private:
  Ship ship_;
  ShipForm form_;
  RandomSequence random_;
  Assembly result_;
};

struct Span {
  double from_x_m, to_x_m;
};

/// Deck that is free for cargo, before and behind the house.
std::vector<Span> cargo_decks(const Ship& ship) {
  const double L = ship.length_m;
  switch (ship.house) {
    case Ship::House::aft:
      return {{-0.27 * L, 0.36 * L}};
    case Ship::House::middle:
      return {{-0.38 * L, -0.1 * L}, {0.09 * L, 0.36 * L}};
    case Ship::House::none:
      break;
  }
  return {{-0.38 * L, 0.36 * L}};
}

/// Evenly divides the cargo decks into `count` pieces, none across a house.
std::vector<Span> divide(const Ship& ship, int count) {
  std::vector<Span> pieces;
  const std::vector<Span> decks = cargo_decks(ship);
  for (std::size_t d = 0; d < decks.size(); ++d) {
    const int here =
        count / static_cast<int>(decks.size()) + (static_cast<int>(d) < count % static_cast<int>(decks.size()) ? 1 : 0);
    const double length_m = (decks[d].to_x_m - decks[d].from_x_m) / std::max(1, here);
    for (int i = 0; i < here; ++i)
      pieces.push_back({decks[d].from_x_m + i * length_m, decks[d].from_x_m + (i + 1) * length_m});
  }
  return pieces;
}

}  // namespace

std::vector<Hatch> ship_hatches(const Ship& ship, RandomKey key) {
  const ShipForm form(ship);
  RandomSequence random(key.child("hatch_covers"));
  std::vector<Hatch> hatches;
  for (const Span& piece : divide(ship, ship.hatches)) {
    const double gap_m = 0.14 * (piece.to_x_m - piece.from_x_m);
    const double narrowest_m = std::min(form.deck_half_width_m(form.station_at(piece.from_x_m)),
                                        form.deck_half_width_m(form.station_at(piece.to_x_m)));
    const double half_m = std::min(hatch_half_width * 0.5 * ship.beam_m, 0.8 * narrowest_m);
    hatches.push_back({piece.from_x_m + gap_m, piece.to_x_m - gap_m, half_m, random.uniform() >= ship.damage});
  }
  return hatches;
}

Assembly ship_outfit(const Ship& ship, const std::vector<Hatch>& hatches, RandomKey key) {
  const double L = ship.length_m;
  Outfitter outfitter(ship, key.child("outfit"));
  outfitter.raised_deck(0.385 * L, 0.494 * L, 0.024 * L);
  if (ship.house == Ship::House::aft) {
    outfitter.raised_deck(-0.499 * L, -0.275 * L, 0.022 * L);
    outfitter.deckhouse(-0.355 * L);
  } else if (ship.house == Ship::House::middle) {
    outfitter.deckhouse(-0.005 * L);
    outfitter.raised_deck(-0.499 * L, -0.4 * L, 0.022 * L);
  }
  for (const Hatch& hatch : hatches) outfitter.hatch(hatch);
  for (const Span& piece : divide(ship, ship.masts)) {
    // Between two hatches, where the masts are half as many as these.
    const double x = 0.5 * (piece.from_x_m + piece.to_x_m);
    outfitter.mast({x, 0, outfitter.deck_z_m(x)}, 0.16 * L, 0.005 * L, true);
  }
  outfitter.mast({0.44 * L, 0, outfitter.deck_z_m(0.44 * L) + 0.02 * L}, 0.06 * L, 0.003 * L, false);
  outfitter.stern_gear();
  if (ship.bulb) outfitter.bulb();
  return outfitter.result();
}

}  // namespace ensonify
