#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {
namespace {

void refuse_parameters(const py::kwargs& parameters) {
  if (!parameters.empty()) throw py::type_error("parameters go with the name of a method; give a chain's in its steps");
}

FilterChain chain_from(const py::object& source, const py::kwargs& parameters) {
  if (py::isinstance<py::list>(source)) {
    refuse_parameters(parameters);
    py::dict whole;
    whole["name"] = "steps";
    whole["steps"] = source;
    return load_filter_chain(source_from(whole, "filter"));
  }
  const ConfigSource from = source_from(source, "filter");
  const auto* name = std::get_if<std::string>(&from);
  FilterChain chain = name == nullptr ? load_filter_chain(from) : find_filter_or_none(*name);
  if (parameters.empty()) return chain;
  if (chain.steps.size() != 1 || name == nullptr) refuse_parameters(parameters);
  for (const auto& [key, value] : parameters) {
    assign_parameter(chain.steps.front(),
                     fmt::format("{}={}", py::str(key).cast<std::string>(), py::str(value).cast<std::string>()));
  }
  check_filter(chain.steps.front());
  return chain;
}

py::array apply_to(const FilterChain& chain, const py::object& image) {
  const GreyImage raw = grey_from(image, "image");
  GreyImage result;
  {
    const Unlocked unlocked;
    result = apply(chain, raw);
  }
  return moved_to_array(std::move(result.grey));
}

py::object number_or_text(const std::string& value) {
  std::size_t used = 0;
  try {
    const double number = std::stod(value, &used);
    if (used == value.size())
      return number == std::floor(number) ? py::object(py::int_(std::llround(number))) : py::object(py::float_(number));
  } catch (const std::exception&) {  // a word
  }
  return py::str(value);
}

py::list steps_of(const FilterChain& chain) {
  py::list steps;
  for (const FilterStep& step : chain.steps) {
    py::dict entry;
    entry["method"] = name_of(step.method);
    for (const auto& [name, value] : parameter_values(step)) entry[py::str(name)] = number_or_text(value);
    steps.append(entry);
  }
  return steps;
}

}  // namespace

void bind_filters(py::module_& m) {
  py::class_<FilterChain>(m, "Filter", "A despeckler, a detector, or a chain of them.")
      .def(
          py::init(&chain_from), py::arg("source"),
          "A method's name with its parameters (Filter('lee', window=7)), a chain's bundled name or YAML file, a dict\n"
          "of its keys, a list of steps ([{'method': 'lee'}, {'method': 'unsharp'}]), or 'none'. Methods and\n"
          "parameters: docs/filters.md. Raises ConfigError, naming the nearest.")
      .def_readonly("name", &FilterChain::name)
      .def_property_readonly("steps", &steps_of, "List of dicts: method and parameters; Filter() takes it.")
      .def("__call__", &apply_to, py::arg("image"),
           "float32 [bins, beams] on 0..255, not rounded; a detector's result is 0 or 255. `image`: uint8, uint16\n"
           "(65535 is 255) or float32, two-dimensional, C-contiguous; it is not changed.")
      .def("__repr__",
           [](const FilterChain& c) { return fmt::format("<ensonify.Filter {}: {} steps>", c.name, c.steps.size()); });
  m.def(
      "filter_names",
      [] {
        std::vector<std::string> names;
        for (const MethodInfo& method : filter_methods()) names.push_back(method.name);
        for (const std::string& chain : library_names("filters")) names.push_back(chain);
        return names;
      },
      "Names of all methods and bundled chains.");
}

}  // namespace ensonify::python
