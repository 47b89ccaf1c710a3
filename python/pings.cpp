#include "ensonify/python/pings.hpp"

#include <fmt/format.h>

#include <span>

#include "ensonify/generators/simulator.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/made.hpp"
#include "ensonify/python/per_process.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"
#include "ensonify/sim/observe.hpp"

namespace ensonify::python {
namespace {

/// What makes a simulator; the ray caster is built in the process that first asks for a ping.
class PySimulator {
 public:
  PySimulator(std::shared_ptr<Scene> scene, SonarModel sonar, NoiseProfile noise, int mask_threshold, std::string isa)
      : scene_(std::move(scene)),
        sonar_(std::move(sonar)),
        noise_(std::move(noise)),
        mask_threshold_(mask_threshold),
        isa_(std::move(isa)) {
    if (mask_threshold < 1 || mask_threshold > 255) throw py::value_error("mask_threshold must be 1 to 255");
    check_noise(noise_, sonar_);
  }

  std::unique_ptr<PyPing> ping(const py::object& pose, std::uint64_t seed, std::uint64_t frame,
                               const py::object& velocity, bool truth) {
    PingRequest request{pose_from(pose), {}, ping_keys(seed, frame), truth};
    if (!velocity.is_none()) request.motion = twist_from(velocity);
    const Simulator& simulator = ready();
    const Unlocked unlocked;
    SimulatedPing made = simulator.ping(request);
    auto result = std::make_unique<PyPing>();
    result->sonar = sonar_;
    result->T_world_sonar = request.T_world_sonar;
    if (sonar_.receive.bits == 16) result->raw16 = quantise16(made.images.raw.level);
    result->images = std::move(made.images);
    result->echo = std::move(made.ping.echo);
    result->truth = std::move(made.ping.truth);
    result->sampled = std::move(made.sampled);
    return result;
  }

  const SonarModel& sonar() const { return sonar_; }
  const NoiseProfile& noise() const { return noise_; }
  const std::shared_ptr<Scene>& scene() const { return scene_; }

 private:
  static Twist twist_from(const py::handle& velocity) {
    using Row = py::array_t<double, py::array::c_style | py::array::forcecast>;
    const Row row = Row::ensure(velocity);
    if (!row) PyErr_Clear();
    const std::span<const double> six(row ? row.data() : nullptr, row && row.ndim() == 1 ? row.size() : 0);
    constexpr double fastest = 180;
    if (six.size() != 6 || !std::ranges::all_of(six, [](double v) { return std::abs(v) <= fastest; })) {
      throw py::value_error(
          "velocity must be vx, vy, vz, wx, wy, wz in the sonar's frame, m/s and deg/s, none beyond 180");
    }
    return {{six[0], six[1], six[2]}, {radians(six[3]), radians(six[4]), radians(six[5])}};
  }

  const Simulator& ready() {
    return simulator_.get([&] { return std::make_unique<Simulator>(*scene_, sonar_, noise_, isa_, mask_threshold_); });
  }

  std::shared_ptr<Scene> scene_;
  SonarModel sonar_;
  NoiseProfile noise_;
  int mask_threshold_;
  std::string isa_;
  PerProcess<Simulator> simulator_;
};

py::dict dict_of(const SampledValues& sampled) {
  py::dict result;
  for (const auto& [name, value] : sampled) result[py::str(name)] = value;
  return result;
}

/// A property that is an image of the ping, or None.
template <typename Get>
auto image_property(Get get) {
  return [get](const py::object& self) -> py::object { return view_or_none(get(self.cast<const PyPing&>()), self); };
}

void bind_ping(py::module_& m) {
  py::class_<PyPing> ping(
      m, "Ping",
      "Images and truth of one ping. Arrays have the shape [bins, beams], nearest bin and port-most\n"
      "beam first; they are writable views that keep the ping alive.");
  ping.def_property_readonly(
          "raw",
          [](const py::object& self) -> py::object {
            const auto& p = self.cast<const PyPing&>();
            if (p.raw16) return view_of(*p.raw16, self);
            return view_of(p.images.raw.grey, self);
          },
          "uint8 (uint16 of instruments of 16 bits): what the instrument shows.")
      .def_property_readonly("raw_level", image_property([](auto& p) -> auto& { return p.images.raw.level; }),
                             "float32 0..1: raw before it is quantised.")
      .def_property_readonly("clean", image_property([](auto& p) -> auto& { return p.images.clean.grey; }),
                             "uint8: direct path only, without noise.")
      .def_property_readonly("clean_level", image_property([](auto& p) -> auto& { return p.images.clean.level; }),
                             "float32 0..1: clean before it is quantised.")
      .def_property_readonly("mask", image_property([](auto& p) -> auto& { return p.images.mask; }),
                             "uint8: 255 exactly where clean >= the threshold, else 0.")
      .def_property_readonly("labels", image_property([](auto& p) -> auto& { return p.images.labels; }),
                             "uint8: 0 water, 1 direct, 2 multipath, 3 sidelobe, 4 shadow, 5 outside.")
      .def_property_readonly(
          "direct", image_property([](auto& p) -> auto& { return p.echo.direct; }),
          "float32: mean power of the direct path over the source's at 1 m, before the point spread.")
      .def_property_readonly("multipath", image_property([](auto& p) -> auto& { return p.images.multipath; }),
                             "float32: the same of multipath; None where the noise has none.")
      .def_property_readonly("sidelobe", image_property([](auto& p) -> auto& { return p.images.sidelobe; }),
                             "float32: the same through sidelobes and leaks, after the point spread; None where the\n"
                             "noise models none.")
      .def_property_readonly("elevation",
                             image_property([](auto& p) -> auto& { return p.truth.elevation_strongest_rad; }),
                             "float32, rad: of the strongest echo, NaN where nothing echoes; None without truth.")
      .def_property_readonly("elevation_min",
                             image_property([](auto& p) -> auto& { return p.truth.elevation_min_rad; }),
                             "float32, rad: lowest elevation that echoes in the pixel; None without truth.")
      .def_property_readonly("elevation_max",
                             image_property([](auto& p) -> auto& { return p.truth.elevation_max_rad; }),
                             "float32, rad: highest elevation that echoes in the pixel; None without truth.")
      .def_property_readonly("incidence", image_property([](auto& p) -> auto& { return p.truth.incidence_rad; }),
                             "float32, rad: angle of the strongest echo to the surface's normal; None without truth.")
      .def_property_readonly("instance", image_property([](auto& p) -> auto& { return p.truth.instance; }),
                             "int32: index into Scene.objects of the strongest echo, -1 none; None without truth.")
      .def_property_readonly(
          "shadow_start_bin", [](const PyPing& p) { return copied_to_array(p.truth.shadow_start_bin); },
          "int32 [beams]: bin from which at least half of the elevations are hidden.")
      .def_property_readonly(
          "pose", [](const PyPing& p) { return matrix_of(p.T_world_sonar); }, "T_world_sonar, float64 [4, 4].")
      .def_readonly("sonar", &PyPing::sonar)
      .def(
          "mark_observed",
          [](const PyPing& p, OccupancyGrid& grid) {
            grid.observable.resize(grid.occupancy.size());
            mark_observed(p.truth, p.sonar.geometry, p.T_world_sonar, grid);
          },
          py::arg("grid"),
          "Sets `observable` of a Grid to 1 in the cells that this ping sees: free ones within the nominal frustum "
          "and\n"
          "before the first surface, and surfaces that a ray meets. Clears none; in one thread at a time.")
      .def_property_readonly(
          "sampled", [](const PyPing& p) { return dict_of(p.sampled); }, "Every number that was drawn.")
      .def("__repr__", [](const PyPing& p) {
        return fmt::format("<ensonify.Ping {} x {} of {}>", p.images.mask.rows(), p.images.mask.columns(),
                           p.sonar.name);
      });

  py::class_<PyFrame, PyPing>(m, "Frame", "A ping of a recipe, and where it stands in its set.")
      .def_readonly("index", &PyFrame::index, "Over the whole set; -1 beyond it.")
      .def_readonly("number", &PyFrame::number, "Within the split.")
      .def_readonly("split", &PyFrame::split)
      .def_readonly("place", &PyFrame::place)
      .def_readonly("noise", &PyFrame::noise, "Name of the noise profile.")
      .def_readonly("time_s", &PyFrame::time_s, "None for random poses.")
      .def_property_readonly(
          "pose_est", [](const PyFrame& f) { return matrix_of(f.T_world_sonar_est); },
          "The pose that dead reckoning believes, float64 [4, 4].")
      .def("__repr__", [](const PyFrame& f) {
        return fmt::format("<ensonify.Frame {} of {} in {}: {} x {} of {}>", f.number, f.split, f.place,
                           f.images.mask.rows(), f.images.mask.columns(), f.sonar.name);
      });
}

}  // namespace

std::unique_ptr<PyFrame> py_frame(const FrameMaker& maker, Frame&& frame) {
  auto result = std::make_unique<PyFrame>();
  result->sonar = std::move(frame.sonar);
  result->T_world_sonar = frame.pose.T_world_sonar;
  if (result->sonar.receive.bits == 16) result->raw16 = quantise16(frame.images.raw.level);
  result->images = std::move(frame.images);
  result->echo = std::move(frame.echo);
  result->truth = std::move(frame.truth);
  result->sampled = std::move(frame.pose.sampled);
  result->index = frame.pose.index;
  result->number = frame.pose.index < 0 ? -1 : frame.pose.number;
  result->split = maker.recipe().splits[static_cast<std::size_t>(frame.pose.split)].name;
  result->place = maker.places()[static_cast<std::size_t>(frame.pose.place)].name;
  result->noise = maker.noises()[static_cast<std::size_t>(frame.pose.noise)].name;
  result->time_s = frame.pose.time_s;
  result->T_world_sonar_est = frame.pose.T_world_sonar_est;
  return result;
}

void bind_pings(py::module_& m) {
  bind_ping(m);
  py::class_<PySimulator>(m, "Simulator",
                          "A sonar in a place. The ray caster is built at the first ping, once a process.")
      .def(py::init([](const py::object& scene, const py::object& sonar, const py::object& noise, int mask_threshold,
                       const std::string& isa) {
             return std::make_unique<PySimulator>(made<std::shared_ptr<Scene>>(scene), made<SonarModel>(sonar),
                                                  made<NoiseProfile>(noise), mask_threshold, isa);
           }),
           py::arg("scene"), py::arg("sonar"), py::arg("noise") = "paper", py::kw_only(),
           py::arg("mask_threshold") = default_mask_threshold, py::arg("isa") = default_isa,
           "From objects, or what Scene(), Sonar() and Noise() take. Raises ConfigError where they do not fit.")
      .def("ping", &PySimulator::ping, py::arg("pose"), py::arg("seed") = 0, py::arg("frame") = 0, py::kw_only(),
           py::arg("velocity") = py::none(), py::arg("truth") = true,
           "The ping from T_world_sonar [4, 4] (ensonify.pose makes one): the same bits as `ensonify ping` with the "
           "same\n"
           "seed and frame. Another frame has new receiver noise over the same speckle. `velocity`: vx vy vz wx wy wz\n"
           "in the sonar's frame, m/s and deg/s, while the sound is under way. truth=False leaves out elevation,\n"
           "incidence and instance. The interpreter's lock is released. Raises ValueError for a pose that is none.")
      .def_property_readonly("sonar", &PySimulator::sonar)
      .def_property_readonly("noise", &PySimulator::noise)
      .def_property_readonly("scene", &PySimulator::scene);
}

}  // namespace ensonify::python
