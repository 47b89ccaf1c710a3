#include "ensonify/scenes/scene_objects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ensonify/scenes/growth.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene_shapes.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_triangles = 10'000'000;
constexpr std::size_t max_instances = 200'000;

/// One copy of an object: its parts refer to meshes of the scene.
struct Placed {
  std::vector<Part> parts;
  Eigen::Affine3d T_world_object = Eigen::Affine3d::Identity();
};

Eigen::Affine3d read_place(Reader& reader, RandomSequence& random, int copy) {
  Pose place = reader.has("pose") ? read_pose(reader, "pose", random) : Pose::Identity();
  if (reader.has("jitter")) {
    const std::vector<double> j = reader.numbers("jitter", 6, {0, 1e4});
    std::array<double, 6> offset{};
    for (std::size_t i = 0; i < 6; ++i) offset[i] = random.uniform(-j[i], j[i]);
    const Vec3 position = place.translation() + Vec3(offset[0], offset[1], offset[2]);
    const Pose turn = pose_from_xyz_rpy(Vec3::Zero(), radians(offset[3]), radians(offset[4]), radians(offset[5]));
    place.linear() = place.linear() * turn.linear();
    place.translation() = position;
  }
  place.translation() += copy * reader.vec3_or("step_m", Vec3::Zero());
  return Eigen::Affine3d(place.matrix());
}

int import_once(SceneDraft& draft, Reader& reader) {
  MeshImportOptions options;
  options.scale = reader.number_or("scale", 1, {1e-6, 1e6});
  std::string unit = "as the file says", axis = unit;
  if (reader.has("unit")) {
    unit = reader.choice("unit", {"m", "cm", "mm", "inch"});
    options.unit_m = unit == "m" ? 1.0 : unit == "cm" ? 0.01 : unit == "mm" ? 0.001 : 0.0254;
  }
  if (reader.has("up_axis")) {
    axis = reader.choice("up_axis", {"x", "y", "z"});
    options.up_axis = axis == "x" ? UpAxis::x : axis == "y" ? UpAxis::y : UpAxis::z;
  }
  const std::filesystem::path path = mesh_path(reader);
  const std::string cache_key = fmt::format("{}|{}|{}|{}", path.string(), options.scale, unit, axis);
  if (const auto known = draft.imported.find(cache_key); known != draft.imported.end()) return known->second;
  const int index = add_mesh(draft, reader, import_mesh(path, options, draft.scene.warnings));
  draft.imported[cache_key] = index;
  draft.scene.mesh_files.push_back(path);
  return index;
}

/// Ground and path as the object frame sees them, for objects that stand upright.
ScatterGround ground_seen_from(const SceneDraft& draft, const Eigen::Affine3d& T_world_object) {
  const Eigen::Affine3d T_object_world = T_world_object.inverse();
  ScatterGround ground;
  ground.height_m = [&seabed = draft.seabed, T_world_object](double x_m, double y_m) {
    const Vec3 p_world = T_world_object * Vec3(x_m, y_m, 0);
    return seabed.empty() ? 0.0 : seabed.at(p_world.x(), p_world.y()) - T_world_object.translation().z();
  };
  for (const Pose& waypoint : draft.scene.waypoints) ground.path_m.push_back(T_object_world * waypoint.translation());
  return ground;
}

/// Lowers or lifts the object so that its lowest point is `height_m` above the seabed under its origin.
void rest_on_seabed(const SceneDraft& draft, Placed& placed) {
  Vec3 origin = placed.T_world_object.translation();
  const double height_m = origin.z();
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const Part& part : placed.parts) {
    const TriangleMesh& mesh = draft.scene.meshes[static_cast<std::size_t>(part.mesh)];
    lowest_m = std::min(lowest_m, bounding_box_m(mesh, placed.T_world_object * part.T_object_part).min().z());
  }
  placed.T_world_object.translation().z() += draft.seabed.at(origin.x(), origin.y()) + height_m - lowest_m;
}

void add_parts(SceneDraft& draft, const Reader& reader, Assembly assembly, Placed& placed) {
  const int first = static_cast<int>(draft.scene.meshes.size());
  for (TriangleMesh& mesh : assembly.meshes) add_mesh(draft, reader, std::move(mesh));
  for (const Part& part : assembly.parts) placed.parts.push_back({first + part.mesh, part.T_object_part});
}

/// Overgrows the object where it has the key `growth`.
Assembly grown(Reader& reader, RandomSequence& random, RandomKey key, const Assembly& assembly) {
  if (!reader.has("growth")) return assembly;
  Reader child = reader.child("growth");
  const FieldSampler field{child, random};
  Growth growth;
  growth.thickness_m = field.number("thickness_m", {0, 10});
  growth.patch_m = field.number_or("patch_m", std::max(0.01, 4 * growth.thickness_m), {5e-3, 100});
  growth.coverage = field.number_or("coverage", 1, {0, 1});
  child.finish();
  try {
    return overgrow(assembly, growth, key.child("growth"));
  } catch (const GrowthTooFine& fault) {
    child.fail("patch_m", fault.what());
  }
}

Placed place_copy(SceneDraft& draft, Reader& reader, RandomKey key, int copy) {
  RandomSequence random(key);
  Placed placed;
  placed.T_world_object = read_place(reader, random, copy);
  if (reader.has("mesh")) {
    if (reader.has("shape")) reader.fail("shape", "an object has either a shape or a mesh");
    const int mesh = import_once(draft, reader);
    if (reader.has("growth")) {
      add_parts(draft, reader,
                grown(reader, random, key, assembly_of(draft.scene.meshes[static_cast<std::size_t>(mesh)])), placed);
    } else {
      placed.parts.push_back({mesh, Eigen::Affine3d::Identity()});
    }
  } else {
    const std::string shape = reader.choice("shape", shape_names());
    const ScatterGround ground = ground_seen_from(draft, placed.T_world_object);
    const Assembly assembly = build_shape(shape, FieldSampler{reader, random}, key, ground);
    add_parts(draft, reader, grown(reader, random, key, assembly), placed);
  }
  if (reader.boolean_or("on_seabed", false)) {
    if (draft.seabed.empty()) reader.fail("on_seabed", "needs a seabed in the scene");
    rest_on_seabed(draft, placed);
  }
  return placed;
}

}  // namespace

std::filesystem::path mesh_path(Reader& reader) {
  const std::filesystem::path path = reader.folder() / reader.text("mesh");
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) {
    reader.fail("mesh", fmt::format("{}: no such file", path.string()));
  }
  return path;
}

int use_material(SceneDraft& draft, Reader& reader, std::string_view key, const std::string& name) {
  auto& used = draft.scene.materials;
  const auto named = [&](const Material& material) { return material.name == name; };
  if (const auto found = std::find_if(used.begin(), used.end(), named); found != used.end()) {
    return static_cast<int>(found - used.begin());
  }
  const auto known = std::find_if(draft.known_materials.begin(), draft.known_materials.end(), named);
  if (known == draft.known_materials.end()) {
    std::vector<std::string> names;
    for (const Material& material : draft.known_materials) names.push_back(material.name);
    const std::string nearest = nearest_word(name, names);
    reader.fail(key, nearest.empty() ? fmt::format("no material '{}'; there are {}", name, fmt::join(names, ", "))
                                     : fmt::format("no material '{}'; did you mean '{}'?", name, nearest));
  }
  used.push_back(*known);
  return static_cast<int>(used.size()) - 1;
}

int add_mesh(SceneDraft& draft, const Reader& reader, TriangleMesh mesh) {
  draft.triangles += mesh.triangles.size();
  if (draft.triangles > max_triangles) {
    reader.fail("", fmt::format("the scene grows beyond {} triangles here", max_triangles));
  }
  draft.scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(draft.scene.meshes.size()) - 1;
}

void add_instance(SceneDraft& draft, const Reader& reader, Instance instance) {
  if (draft.scene.instances.size() >= max_instances) {
    reader.fail("", fmt::format("the scene grows beyond {} instances here", max_instances));
  }
  draft.scene.instances.push_back(std::move(instance));
}

void add_object(SceneDraft& draft, Reader& reader, RandomKey layout_key) {
  const std::string name = reader.text("name");
  const RandomKey key = layout_key.child(name);
  const int material = use_material(draft, reader, "material", reader.text("material"));
  const bool obstacle = reader.boolean_or("obstacle", true);
  RandomSequence random(key.child("count"));
  const int count = FieldSampler{reader, random}.count_or("count", 1, 0, 1000);
  // Read even where this layout has none, so that an error in the file shows in every layout.
  const std::size_t meshes_before = draft.scene.meshes.size();
  for (int copy = 0; copy < std::max(1, count); ++copy) {
    const Placed placed = place_copy(draft, reader, key.child(static_cast<std::uint64_t>(copy)), copy);
    if (copy == 0) reader.finish();
    if (count == 0) break;
    const bool single = count == 1 && placed.parts.size() == 1;
    for (std::size_t i = 0; i < placed.parts.size(); ++i) {
      std::string instance_name = name;
      if (count > 1) instance_name += fmt::format("_{}", copy);
      if (!single && placed.parts.size() > 1) instance_name += fmt::format("_{}", i);
      add_instance(draft, reader,
                   {std::move(instance_name), placed.parts[i].mesh, material,
                    placed.T_world_object * placed.parts[i].T_object_part, obstacle});
    }
  }
  if (count == 0 && !reader.has("mesh")) draft.scene.meshes.resize(meshes_before);
}

}  // namespace ensonify
