#pragma once

#include <string>

#include "ensonify/config/library.hpp"
#include "ensonify/python/bindings.hpp"

namespace ensonify::python {

/// A path, a bundled name, or a dict with the keys of the YAML file. `what` names a dict in messages. Throws TypeError
/// for anything else, ValueError for a dict that JSON can not hold.
ConfigSource source_from(const py::handle& object, const std::string& what);

/// Text as Python's own dicts and lists.
py::object from_json(const std::string& text);

}  // namespace ensonify::python
