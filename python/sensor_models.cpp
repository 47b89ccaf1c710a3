#include <fmt/format.h>

#include <optional>

#include "ensonify/python/arrays.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify::python {

void bind_sensor_models(py::module_& m) {
  py::class_<SonarModel>(m, "Sonar", "An instrument and its range window.")
      .def(py::init([](const py::object& source, std::optional<double> range_min_m, std::optional<double> range_max_m,
                       std::optional<int> range_bins) {
             for (const auto& range : {range_min_m, range_max_m}) {
               if (range && !(*range > 0 && *range < 1e6))
                 throw py::value_error("ranges must be above 0 and below 1000000 m");
             }
             if (range_bins && (*range_bins < 0 || *range_bins > 16384)) {
               throw py::value_error("range_bins must be 1 to 16384, or 0 for the device's own");
             }
             return load_sonar(source_from(source, "sonar"), {range_min_m, range_max_m, range_bins});
           }),
           py::arg("source"), py::kw_only(), py::arg("range_min_m") = py::none(), py::arg("range_max_m") = py::none(),
           py::arg("range_bins") = py::none(),
           "From a bundled name (sonar_names()), a YAML file or a dict of its keys. What is not given stays as the\n"
           "instrument has it; range_bins 0: the device's own bins. Raises ConfigError.")
      .def_readonly("name", &SonarModel::name)
      .def_readonly("title", &SonarModel::title)
      .def_readonly("frequency_hz", &SonarModel::frequency_hz)
      .def_readonly("bandwidth_hz", &SonarModel::bandwidth_hz)
      .def_readonly("ping_rate_hz", &SonarModel::ping_rate_hz)
      .def_property_readonly("beams", [](const SonarModel& s) { return s.geometry.beams(); })
      .def_property_readonly("range_bins", [](const SonarModel& s) { return s.geometry.range_bins; })
      .def_property_readonly("range_min_m", [](const SonarModel& s) { return s.geometry.range_min_m; })
      .def_property_readonly("range_max_m", [](const SonarModel& s) { return s.geometry.range_max_m; })
      .def_property_readonly(
          "elevation_fov_rad", [](const SonarModel& s) { return s.geometry.elevation_fov_rad; },
          "Nominal, between the -3 dB points.")
      .def_property_readonly(
          "azimuth_rad", [](const SonarModel& s) { return copied_to_array(s.geometry.beam_azimuth_rad); },
          "float64 [beams]: bearing of every column, port (positive) first.")
      .def_property_readonly(
          "range_m",
          [](const SonarModel& s) {
            std::vector<double> centres;
            for (int k = 0; k < s.geometry.range_bins; ++k) {
              centres.push_back(s.geometry.bin_centre_m(k));
            }
            return copied_to_array(centres);
          },
          "float64 [range_bins]: centre of every row, nearest first.")
      .def("__repr__", [](const SonarModel& s) {
        return fmt::format("<ensonify.Sonar {}: {} bins x {} beams, {:.3g} to {:.4g} m>", s.name, s.geometry.range_bins,
                           s.geometry.beams(), s.geometry.range_min_m, s.geometry.range_max_m);
      });
  m.def(
      "sonar_names", [] { return library_names("sensor_models"); }, "Names of the bundled instruments.");
}

}  // namespace ensonify::python
