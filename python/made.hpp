#pragma once

#include "ensonify/python/sources.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify::python {

/// A T, or `T(source)` where a name, a path or a dict was given.
template <typename T>
T made(const py::object& given) {
  if (py::isinstance<T>(given)) return given.cast<T>();
  return py::type::of<T>()(given).template cast<T>();
}
template <>
inline std::shared_ptr<Scene> made(const py::object& given) {
  if (py::isinstance<Scene>(given)) return given.cast<std::shared_ptr<Scene>>();
  return py::type::of<Scene>()(given).cast<std::shared_ptr<Scene>>();
}

}  // namespace ensonify::python
