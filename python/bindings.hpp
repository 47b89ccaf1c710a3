#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

/// One function a room adds its classes to the module `ensonify._ensonify`, in an order in which each knows the types
/// that its signatures name.
namespace ensonify::python {

namespace py = pybind11;

void bind_core(py::module_& m);
void bind_scenes(py::module_& m);
void bind_sensor_models(py::module_& m);
void bind_noise(py::module_& m);
void bind_sim(py::module_& m);
void bind_filters(py::module_& m);
void bind_output(py::module_& m);
void bind_mapping(py::module_& m);
void bind_evaluation(py::module_& m);
void bind_pings(py::module_& m);
void bind_recipes(py::module_& m);
void bind_datasets(py::module_& m);
void bind_loop(py::module_& m);

}  // namespace ensonify::python
