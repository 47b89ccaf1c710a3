#include "ensonify/scenes/material_library.hpp"

#include <algorithm>

#include "ensonify/config/library.hpp"

namespace ensonify {

std::vector<Material> read_materials(Reader& table) {
  std::vector<Material> materials;
  for (const std::string& name : table.keys()) {
    Reader entry = table.child(name);
    Material material;
    material.name = name;
    material.lambert_db = entry.number("lambert_db", {-100, 10});
    material.specular_db = entry.number_or("specular_db", material.specular_db, {-100, 30});
    material.specular_exponent = entry.number_or("specular_exponent", material.specular_exponent, {2, 1e5});
    material.source = entry.text_or("source", "assumed");
    if (entry.has("colour")) {
      const std::vector<double> rgb = entry.numbers("colour", 3, {0, 255});
      std::transform(rgb.begin(), rgb.end(), material.colour.begin(),
                     [](double v) { return static_cast<float>(v / 255); });
    }
    entry.finish();
    materials.push_back(material);
  }
  return materials;
}

std::vector<Material> bundled_materials() {
  Reader file = Reader::from_file(library_folder("scenes") / "materials" / "materials.yaml");
  Reader table = file.child("materials");
  std::vector<Material> materials = read_materials(table);
  file.finish();
  return materials;
}

}  // namespace ensonify
