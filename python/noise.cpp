#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ensonify/generators/describe.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/python/sources.hpp"

namespace ensonify::python {

void bind_noise(py::module_& m) {
  py::class_<NoiseProfile>(m, "Noise",
                           "A chain of disturbances from the echo to the image; numbers may be distributions.")
      .def(py::init([](const py::object& source) { return load_noise(source_from(source, "noise")); }),
           py::arg("source"),
           "From a bundled name (noise_names()), a YAML file or a dict of its keys. Raises ConfigError.")
      .def_readonly("name", &NoiseProfile::name)
      .def(
          "to_dict", [](const NoiseProfile& p) { return from_json(describe(p).dump()); },
          "All stages with all their numbers: a dict that Noise() takes.")
      .def("__repr__", [](const NoiseProfile& p) {
        return fmt::format("<ensonify.Noise {}: {} stages>", p.name, p.stages.size());
      });
  m.def(
      "noise_names", [] { return library_names("noise"); }, "Names of the bundled noise profiles.");
}

}  // namespace ensonify::python
