#pragma once

#include "ensonify/core/pose.hpp"
#include "ensonify/python/bindings.hpp"

namespace ensonify::python {

/// A rigid 4 x 4 from anything numpy takes for one. Throws ValueError: another shape, not finite, not rigid, farther
/// out than 100 km, where single precision no longer tells centimetres apart.
Pose pose_from(const py::handle& object, const char* what = "pose");
py::array matrix_of(const Pose& pose);

/// Three finite numbers.
Vec3 vec3_from(const py::handle& object, const char* what);

}  // namespace ensonify::python
