#include <fmt/format.h>

#include <optional>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/explore_files.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/looks.hpp"
#include "ensonify/python/made.hpp"
#include "ensonify/python/per_process.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {
namespace {

PlanarPose planar_from(const py::handle& object, const char* what) {
  const Vec3 v = vec3_from(object, what);
  constexpr double far_off_m = 1e5;
  if (v.cwiseAbs().maxCoeff() > far_off_m) throw py::value_error(fmt::format("{} must not be beyond 100000", what));
  return {v.x(), v.y(), v.z()};
}

class PyLoop {
 public:
  PyLoop(std::shared_ptr<Scene> scene, SonarModel sonar, NoiseProfile noise, const ExploreChoice& choice,
         Vehicle vehicle, const SiteRequest& request, std::optional<Drift> drift, std::string isa)
      : scene_(std::move(scene)),
        sonar_(std::move(sonar)),
        noise_(std::move(noise)),
        isa_(std::move(isa)),
        vehicle_(vehicle),
        settings_(explore_settings(choice)),
        site_(explore_site(*scene_, sonar_, settings_.model, vehicle_, request)) {
    settings_.drift = drift;
    check_noise(noise_, sonar_);
  }
  PyLoop(const PyLoop&) = delete;
  PyLoop& operator=(const PyLoop&) = delete;

  void reset(std::uint64_t seed) {
    close();
    settings_.seed = seed;
    world_.emplace(ready(), site_, vehicle_, settings_);
    looked_ = false;
  }

  std::unique_ptr<PyLook> look() {
    ExploreWorld& world = open_world();
    const Work work(busy_);
    if (looked_) throw std::runtime_error("the vehicle has looked from here: call move() before the next look()");
    {
      const Unlocked unlocked;
      world.look();
    }
    looked_ = true;
    lent_.emplace(world.moment().grid);
    return look_at(world.moment(), world.map(), *lent_);
  }

  void move(const py::object& wanted) {
    ExploreWorld& world = open_world();
    if (!looked_) throw std::runtime_error("call look() first: what the vehicle has seen says where it may go");
    const PlanarPose to = planar_from(wanted, "wanted");
    lent_.reset();
    world.move(limited_step(world.at(), to, vehicle_.limits));
    looked_ = false;
  }

  std::unique_ptr<PyRun> explore_with(const py::object& guest, std::optional<int> steps, std::uint64_t seed,
                                      const py::object& after_step) {
    close();
    const Work work(busy_);
    ExploreSettings settings = settings_;
    settings.seed = seed;
    if (steps && *steps < 1) throw py::value_error("steps must be 1 or more");
    if (steps) settings.steps = *steps;
    ExploreHooks hooks;
    if (!guest.is_none()) {
      hooks.guest = [&](const ExploreMoment& moment) {
        const Locked locked;
        const LentGrid lent(moment.grid);
        return reply_from(guest(py::cast(look_at(moment, slice_of(moment.grid), lent))));
      };
    }
    hooks.after_step = [&](const ExploreMoment&, const Slice&, const std::vector<ExploreStep>& so_far) {
      const Locked locked;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (after_step.is_none()) return true;
      const py::object answer = after_step(so_far.back().step, scores_of(so_far.back()));
      return answer.is_none() || answer.cast<bool>();
    };
    const Simulator& simulator = ready();
    const Unlocked unlocked;
    ExploreRun run = explore(simulator, site_, vehicle_, settings, hooks);
    nlohmann::json summary = summary_of(run, site_, vehicle_);
    return std::make_unique<PyRun>(PyRun{std::move(run), std::move(summary)});
  }

  void close() {
    refuse_while(busy_);
    lent_.reset();
    world_.reset();
  }

  const ExploreSite& site() const { return site_; }
  const Vehicle& vehicle() const { return vehicle_; }
  const SonarModel& sonar() const { return sonar_; }

 private:
  const Simulator& ready() {
    return simulator_.get([&] { return std::make_unique<Simulator>(*scene_, sonar_, noise_, isa_); });
  }
  static void refuse_while(bool busy) {
    if (busy) throw std::runtime_error("the loop is at work, in another thread or for the guest that asks");
  }
  /// Set and read under the interpreter's lock.
  class Work {
   public:
    explicit Work(bool& busy) : busy_(busy) {
      refuse_while(busy);
      busy = true;
    }
    ~Work() { busy_ = false; }
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

   private:
    bool& busy_;
  };

  ExploreWorld& open_world() {
    refuse_while(busy_);
    if (!world_) throw std::runtime_error("the loop is closed: call reset() first");
    return *world_;
  }
  std::unique_ptr<PyLook> look_at(const ExploreMoment& moment, const Slice& columns, const LentGrid& lent) const {
    const double time_s = moment.step / vehicle_.limits.ping_rate_hz;
    const ExploreStep scores{moment.step,
                             time_s,
                             moment.T_world_sonar,
                             moment.T_world_sonar_est,
                             score_slice(columns, site_.reachable),
                             moment.clearance_m,
                             moment.path_m};
    return std::make_unique<PyLook>(PyLook{moment.step, time_s, moment.T_world_sonar, moment.T_world_sonar_est,
                                           moment.ping, columns, scores, lent.pointer()});
  }
  GuestReply reply_from(const py::object& answer) const {
    GuestReply reply;
    if (answer.is_none()) return reply;
    if (!py::isinstance<py::dict>(answer)) {
      throw py::type_error("the guest must return None or a dict with one or more of wanted, map and done");
    }
    for (const auto& [key, value] : answer.cast<py::dict>()) {
      const std::string name = py::str(key).cast<std::string>();
      if (name == "wanted") {
        reply.wanted = planar_from(value, "wanted");
      } else if (name == "map") {
        const Slice like{site_.truth.frame, std::vector<ColumnState>(site_.truth.columns.size(), ColumnState::unknown)};
        if (!py::isinstance<LogOddsMap>(value)) {
          throw py::type_error(fmt::format("the guest's map must be an ensonify.Map, not {}", type_name(value)));
        }
        const auto& map = value.cast<const LogOddsMap&>();
        if (!is_finite(map)) throw DataError("the guest's map holds NaN or infinity; unknown cells hold 0");
        reply.map = columns_of(map, like, site_.map_frame);
      } else if (name == "done") {
        if (!py::isinstance<py::bool_>(value)) {
          throw py::type_error(fmt::format("the guest's done must be a bool, not {}", type_name(value)));
        }
        reply.done = value.cast<bool>();
      } else {
        throw ConfigError(fmt::format("the guest's answer has the key '{}', which is none of wanted, map, done", name));
      }
    }
    return reply;
  }

  std::shared_ptr<Scene> scene_;
  SonarModel sonar_;
  NoiseProfile noise_;
  std::string isa_;
  Vehicle vehicle_;
  ExploreSettings settings_;
  ExploreSite site_;
  PerProcess<Simulator> simulator_;
  std::optional<ExploreWorld> world_;
  bool looked_ = false;
  std::optional<LentGrid> lent_;  ///< after world_, which holds the grid
  bool busy_ = false;
};

std::unique_ptr<PyLoop> make_loop(const py::object& scene, const py::object& sonar, const py::object& noise,
                                  const std::string& filter, const std::string& model, double threshold, double p_free,
                                  double p_occupied, double range_max_m, std::optional<double> resolution_m,
                                  const py::object& start, double radius_m, double height_m, double margin_m,
                                  double speed_mps, double turn_rate_degps, double ping_rate_hz,
                                  std::optional<double> known_free_m, double drift_m, int steps,
                                  const std::string& isa) {
  for (const double v : {range_max_m, radius_m, height_m, speed_mps, turn_rate_degps, ping_rate_hz}) {
    if (!(v > 0 && std::isfinite(v))) {
      throw py::value_error(
          "range_max_m, radius_m, height_m, speed_mps, turn_rate_degps and ping_rate_hz must be above 0");
    }
  }
  if (!(margin_m >= 0 && drift_m >= 0 && known_free_m.value_or(0) >= 0 &&
        std::isfinite(margin_m + drift_m + known_free_m.value_or(0))) ||
      steps < 1) {
    throw py::value_error("margin_m, known_free_m and drift_m must not be negative, steps at least 1");
  }
  ExploreChoice choice;
  choice.filter = filter;
  choice.model = model;
  choice.threshold = threshold;
  choice.p_free = p_free;
  choice.p_occupied = p_occupied;
  choice.steps = steps;
  SiteRequest request;
  request.resolution_m = resolution_m;
  request.known_free_m = known_free_m;
  if (!start.is_none()) request.start = pose_from(start, "start");
  Vehicle vehicle{radius_m, height_m, margin_m, {speed_mps, radians(turn_rate_degps), ping_rate_hz}};
  RangeWindow window;
  window.range_max_m = range_max_m;
  const SonarModel model_of_sonar =
      py::isinstance<SonarModel>(sonar) ? sonar.cast<SonarModel>() : load_sonar(source_from(sonar, "sonar"), window);
  std::optional<Drift> drift;
  if (drift_m > 0) drift = Drift{drift_m, 1200};
  auto place = made<std::shared_ptr<Scene>>(scene);
  auto profile = made<NoiseProfile>(noise);
  const Unlocked unlocked;
  return std::make_unique<PyLoop>(std::move(place), model_of_sonar, std::move(profile), choice, vehicle, request, drift,
                                  isa);
}

}  // namespace

void bind_loop(py::module_& m) {
  bind_looks(m);
  const ExploreChoice choice;
  const Vehicle vehicle;
  py::class_<PyLoop>(
      m, "ClosedLoop",
      "A vehicle with a sonar in a place: ping, filter, map, move. Drive it by look() and move(), or let\n"
      "explore() do it. What `ensonify explore` does, with the same numbers.")
      .def(py::init(&make_loop), py::arg("scene"), py::kw_only(), py::arg("sonar") = choice.sonar,
           py::arg("noise") = choice.noise, py::arg("filter") = choice.filter, py::arg("model") = choice.model,
           py::arg("threshold") = choice.threshold, py::arg("p_free") = choice.p_free,
           py::arg("p_occupied") = choice.p_occupied, py::arg("range_max_m") = choice.range_max_m,
           py::arg("resolution_m") = py::none(), py::arg("start") = py::none(), py::arg("radius_m") = vehicle.radius_m,
           py::arg("height_m") = vehicle.height_m, py::arg("margin_m") = vehicle.margin_m,
           py::arg("speed_mps") = vehicle.limits.speed_mps, py::arg("turn_rate_degps") = 30,
           py::arg("ping_rate_hz") = vehicle.limits.ping_rate_hz, py::arg("known_free_m") = py::none(),
           py::arg("drift_m") = 0, py::arg("steps") = choice.steps, py::arg("isa") = default_isa,
           "As the options of `ensonify explore` (docs/explore.md); range_max_m counts where `sonar` is no Sonar.\n"
           "Raises ConfigError, ValueError.")
      .def("reset", &PyLoop::reset, py::arg("seed") = 0, "Back to the start, with an empty map.")
      .def("look", &PyLoop::look,
           "Pings, filters and maps. Raises RuntimeError before reset(), and twice in one place.")
      .def("move", &PyLoop::move, py::arg("wanted"),
           "To (x, y, yaw), metres and radians, as the vehicle believes, as far as a step's limits allow.")
      .def("explore", &PyLoop::explore_with, py::arg("guest") = py::none(), py::kw_only(),
           py::arg("steps") = py::none(), py::arg("seed") = 0, py::arg("after_step") = py::none(),
           "The whole loop. `guest(look)` is your mapper or planner: it returns None, or a dict with one or more of\n"
           "wanted (x, y, yaw), map (a Map, to be scored and planned on) and done; the rest ours do.\n"
           "`after_step(step, scores)` ends the run by returning False. Raises what they raise, and KeyboardInterrupt.")
      .def("close", &PyLoop::close, "Ends what reset() began.")
      .def_property_readonly("sonar", &PyLoop::sonar)
      .def_property_readonly("start", [](const PyLoop& l) { return matrix_of(l.site().start); })
      .def_property_readonly(
          "steps_m_rad",
          [](const PyLoop& l) { return py::make_tuple(l.vehicle().limits.step_m(), l.vehicle().limits.step_rad()); },
          "How far and how much it moves and turns in a step at most.")
      .def_property_readonly(
          "columns_origin_m",
          [](const PyLoop& l) {
            return py::make_tuple(l.site().truth.frame.origin_m.x(), l.site().truth.frame.origin_m.y());
          },
          "Least corner of columns [0, 0].")
      .def_property_readonly("resolution_m", [](const PyLoop& l) { return l.site().truth.frame.resolution_m; });
}

}  // namespace ensonify::python
