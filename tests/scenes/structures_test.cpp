#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "ensonify/scenes/access.hpp"
#include "ensonify/scenes/debris.hpp"
#include "ensonify/scenes/lattice.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/sheet_piles.hpp"
#include "ensonify/scenes/ship.hpp"
#include "ensonify/scenes/trash_rack.hpp"
#include "ensonify/scenes/tyre.hpp"

namespace ensonify {
namespace {

TEST(Stairs, HaveTheVolumeOfTheirSteps) {
  const TriangleMesh mesh = make_stairs({.steps = 7, .rise_m = 0.2, .run_m = 0.3, .width_m = 1.5});
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume_m3(mesh), 1.5 * 0.2 * 0.3 * 7 * 8 / 2, 1e-5);
}

TEST(Truss, HasItsMembers) {
  const Truss box{.length_m = 10, .bays = 6};
  EXPECT_EQ(truss_members(box).size(), 4u * (1 + 7 + 6)) << "a face: a chord, posts at the nodes, a diagonal a bay";
  Truss triangle = box;
  triangle.triangular = true;
  EXPECT_EQ(truss_members(triangle).size(), 3u * (1 + 7 + 6));
}

TEST(Jacket, HasItsMembersAndItsBatter) {
  Jacket jacket{.height_m = 30, .base_width_m = 16, .top_width_m = 8, .levels = 3};
  const std::vector<Member> members = jacket_members(jacket);
  EXPECT_EQ(members.size(), 4u + 4 * 4 + 4 * 3 * 2) << "legs, frames, two braces a panel";
  EXPECT_EQ(members[0].from_m, Vec3(8, 8, 0));
  EXPECT_EQ(members[0].to_m, Vec3(4, 4, 30));
  jacket.k_braces = true;
  EXPECT_EQ(jacket_members(jacket).size(), members.size());
  jacket.pile_radius_m = 0.5;
  EXPECT_EQ(jacket_members(jacket).size(), members.size() + 4 * 2 * 3);
}

TEST(Jacket, BracesEndOnTheLegs) {
  const Jacket jacket{};
  const std::vector<Member> members = jacket_members(jacket);
  const auto off_leg_m = [&](const Vec3& p) {
    const double share = p.z() / jacket.height_m;
    const double half = 0.5 * ((1 - share) * jacket.base_width_m + share * jacket.top_width_m);
    return std::max(std::abs(std::abs(p.x()) - half), std::abs(std::abs(p.y()) - half));
  };
  for (const Member& member : members) {
    EXPECT_LT(off_leg_m(member.from_m), 1e-9);
    EXPECT_LT(off_leg_m(member.to_m), 1e-9);
  }
}

TEST(SheetPileWall, InterlocksMeetForBothProfiles) {
  for (const bool z_profile : {false, true}) {
    SheetPileWall wall{.length_m = 5, .z_profile = z_profile};
    EXPECT_EQ(sheet_piles(wall), 9);
    const Assembly assembly = build_sheet_pile_wall(wall, RandomKey::from_seed(1));
    ASSERT_EQ(assembly.parts.size(), 9u);
    EXPECT_EQ(unpaired_edges(assembly.meshes[0]), 0u);
    const double half_pitch = 0.5 * wall.pitch_m;
    const double lock_y = z_profile ? 0.5 * (wall.depth_m - wall.thickness_m) : 0;
    for (std::size_t i = 0; i + 1 < assembly.parts.size(); ++i) {
      const Vec3 right = assembly.parts[i].T_object_part * Vec3(half_pitch, lock_y, 0);
      const Vec3 left = assembly.parts[i + 1].T_object_part * Vec3(-half_pitch, -lock_y, 0);
      EXPECT_LT((right - left).norm(), 1e-9) << i;
    }
    Eigen::AlignedBox3d box;
    for (const Part& part : assembly.parts) box.extend(bounding_box_m(assembly.meshes[0], part.T_object_part));
    EXPECT_NEAR(box.sizes().y(), wall.depth_m, 2 * wall.thickness_m);
    EXPECT_NEAR(box.max().z(), 0, 1e-6);
    EXPECT_NEAR(box.min().z(), -8, 1e-6);
  }
}

TEST(SheetPile, HasTheVolumeOfItsSteel) {
  const SheetPileWall wall{.length_m = 0.6, .height_m = 10};
  const TriangleMesh mesh = build_sheet_pile_wall(wall, RandomKey::from_seed(1)).meshes[0];
  // Flange, two webs and what runs along the middle line; the interlocks add a little.
  const double p = wall.pitch_m, web = std::hypot(0.21 * p, 0.5 * (wall.depth_m - wall.thickness_m));
  const double steel = 10 * wall.thickness_m * (0.5 * p + 2 * web + 0.08 * p);
  EXPECT_NEAR(enclosed_volume_m3(mesh), steel, 0.15 * steel);
}

TEST(TrashRack, BarsAreEvenAndInsideTheFrame) {
  const TrashRack rack{.width_m = 2, .height_m = 3, .bar_spacing_m = 0.1, .frame_m = 0.1, .cross_bars = 1};
  EXPECT_EQ(build_trash_rack(rack).parts.size(), 4u + 18 + 1);
}

TEST(Ladder, HasItsRungs) { EXPECT_EQ(build_ladder({.height_m = 3, .rung_spacing_m = 0.3}).parts.size(), 2u + 10); }

TEST(Tyre, IsHollowAndGroovesTakeRubberAway) {
  const Tyre smooth{.blocks = 0}, treaded{};
  const double solid_ring = std::numbers::pi * (0.25 - 0.28 * 0.28) * 0.28;
  EXPECT_LT(enclosed_volume_m3(make_tyre(smooth)), 0.6 * solid_ring);
  EXPECT_LT(enclosed_volume_m3(make_tyre(treaded)), enclosed_volume_m3(make_tyre(smooth)));
  EXPECT_GT(enclosed_volume_m3(make_tyre(treaded)), 0.85 * enclosed_volume_m3(make_tyre(smooth)));
}

RC_GTEST_PROP(Ship, IsClosedHoweverDamaged, ()) {
  Ship ship;
  ship.damage = *rc::gen::inRange(0, 11) / 10.0;
  const RandomKey key = RandomKey::from_seed(*rc::gen::arbitrary<std::uint64_t>());
  const Assembly assembly = build_ship(ship, key);
  for (const TriangleMesh& mesh : assembly.meshes) {
    RC_ASSERT(unpaired_edges(mesh) == 0u);
    RC_ASSERT(enclosed_volume_m3(mesh) > 0.0);
  }
}

TEST(Ship, FloatsAndLosesItsSubstanceWithDamage) {
  Ship ship;
  const Assembly intact = build_ship(ship, RandomKey::from_seed(1));
  const double block = ship.length_m * ship.beam_m * ship.depth_m;
  EXPECT_GT(enclosed_volume_m3(intact.meshes[0]), 0.6 * block) << "the block coefficient of a freighter";
  EXPECT_LT(enclosed_volume_m3(intact.meshes[0]), 0.85 * block);
  ship.damage = 0.3;
  const Assembly holed = build_ship(ship, RandomKey::from_seed(1));
  EXPECT_LT(enclosed_volume_m3(holed.meshes[0]), 0.1 * block) << "is a shell";
  ship.damage = 1;
  const Assembly broken = build_ship(ship, RandomKey::from_seed(1));
  const Eigen::AlignedBox3d aft = bounding_box_m(broken.meshes[0]), fore = bounding_box_m(broken.meshes[1]);
  EXPECT_LT(aft.max().x(), fore.min().x() + 0.06 * ship.length_m) << "two halves";
  EXPECT_GT(fore.max().x(), 0.45 * ship.length_m);
  EXPECT_LT(broken.parts.size(), intact.parts.size() + 10);
}

TEST(DebrisScatter, PiecesLieOnTheGroundClearOfThePath) {
  DebrisScatter scatter;
  scatter.pieces = 80;
  scatter.kinds = {DebrisKind::box, DebrisKind::plank, DebrisKind::tube, DebrisKind::tyre, DebrisKind::slab};
  scatter.where.area_m = Eigen::AlignedBox2d(Eigen::Vector2d(-6, -6), Eigen::Vector2d(6, 6));
  scatter.burial = 0.1;
  const ScatterGround ground{[](double, double) { return -3.0; }, {{-6, 0, -2.5}, {6, 0, -2.5}}};
  const Assembly debris = scatter_debris(scatter, ground, RandomKey::from_seed(2));
  EXPECT_GT(debris.parts.size(), 30u);
  for (const Part& part : debris.parts) {
    const TriangleMesh& mesh = debris.meshes[static_cast<std::size_t>(part.mesh)];
    const Eigen::AlignedBox3d box = bounding_box_m(mesh, part.T_object_part);
    EXPECT_NEAR(box.min().z(), -3 - 0.1 * box.sizes().z(), 1e-6);
    for (const Eigen::Vector3f& v : mesh.vertices_m) {
      ASSERT_GE(distance_to_path_m(part.T_object_part * v.cast<double>(), ground.path_m), 0.8 - 1e-6);
    }
  }
}

}  // namespace
}  // namespace ensonify
