#include "ensonify/python/bindings.hpp"

PYBIND11_MODULE(_ensonify, m) {
  using namespace ensonify::python;
  m.doc() = "The compiled part of ensonify; import ensonify instead.";
  bind_core(m);
  bind_scenes(m);
  bind_sensor_models(m);
  bind_noise(m);
  bind_filters(m);
  bind_output(m);
  bind_sim(m);
  bind_mapping(m);
  bind_evaluation(m);
  bind_pings(m);
  bind_recipes(m);
  bind_datasets(m);
  bind_loop(m);
}
