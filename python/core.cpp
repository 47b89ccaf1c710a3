#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <cstdlib>
#include <memory>

#include "ensonify/core/error.hpp"
#include "ensonify/core/memory.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/poses.hpp"
#include "ensonify/python/sources.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {

std::string type_name(const py::handle& object) {
  return py::str(py::type::handle_of(object).attr("__name__")).cast<std::string>();
}

GreyImage grey_from(const py::handle& object, const char* what) {
  if (py::isinstance<py::array_t<std::uint8_t>>(object)) {
    return to_grey(image_from(require_array<std::uint8_t>(object, what, 2)));
  }
  if (py::isinstance<py::array_t<std::uint16_t>>(object)) {
    return to_grey(image_from(require_array<std::uint16_t>(object, what, 2)));
  }
  if (py::isinstance<py::array>(object) && !py::isinstance<py::array_t<float>>(object)) {
    throw py::type_error(fmt::format("{} must have dtype uint8, uint16 or float32 (levels 0..255), not {}", what,
                                     py::str(object.attr("dtype")).cast<std::string>()));
  }
  return {image_from(require_array<float>(object, what, 2)), GreyDepth::real};
}

Pose pose_from(const py::handle& object, const char* what) {
  using Matrix = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const bool complex = py::isinstance<py::array>(object) && object.attr("dtype").attr("kind").cast<char>() == 'c';
  const Matrix matrix = object.is_none() || complex ? Matrix() : Matrix::ensure(object);
  if (!matrix || object.is_none() || complex) {
    PyErr_Clear();
    throw py::type_error(
        fmt::format("{} must be a 4 x 4 matrix (ensonify.pose makes one), not {}", what, type_name(object)));
  }
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4) {
    throw py::value_error(fmt::format("{} must be a 4 x 4 matrix, T_world_sonar; ensonify.pose makes one", what));
  }
  Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.data());
  constexpr double far_off_m = 1e5, rounding = 1e-5;
  if (!m.allFinite()) throw py::value_error(fmt::format("{} holds a number that is not finite", what));
  const Eigen::Matrix3d r = m.topLeftCorner<3, 3>();
  if (!m.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)) ||
      !(r * r.transpose()).isApprox(Eigen::Matrix3d::Identity(), rounding) || r.determinant() < 0) {
    throw py::value_error(fmt::format("{} must be rigid: a rotation, a translation, and the last row 0 0 0 1", what));
  }
  if (m.topRightCorner<3, 1>().cwiseAbs().maxCoeff() > far_off_m) {
    throw py::value_error(fmt::format("{} must not lie farther out than 100000 m", what));
  }
  Pose pose;
  pose.matrix() = m;
  return pose;
}

py::array matrix_of(const Pose& pose) {
  py::array_t<double> matrix({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.mutable_data()) = pose.matrix();
  return matrix;
}

Vec3 vec3_from(const py::handle& object, const char* what) {
  using Row = py::array_t<double, py::array::c_style | py::array::forcecast>;
  const Row row = Row::ensure(object);
  if (!row || row.ndim() != 1 || row.shape(0) != 3 || !std::isfinite(row.at(0) + row.at(1) + row.at(2))) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{} must be three finite numbers", what));
  }
  return {row.at(0), row.at(1), row.at(2)};
}

namespace {

/// numpy's scalars and arrays become what they hold.
std::string json_of(const py::handle& object, const std::string& what) {
  const py::cpp_function plain([what](const py::object& value) -> py::object {
    if (!py::hasattr(value, "tolist")) {
      throw py::type_error(fmt::format("{} holds a {}, which YAML has no word for", what, type_name(value)));
    }
    return value.attr("tolist")();
  });
  const py::object dumps = py::module_::import("json").attr("dumps");
  try {
    return dumps(object, py::arg("allow_nan") = false, py::arg("default") = plain).cast<std::string>();
  } catch (py::error_already_set& e) {
    if (!e.matches(PyExc_ValueError)) throw;
    throw ConfigError(fmt::format("{}: must hold finite numbers, and not itself", what));
  }
}

}  // namespace

ConfigSource source_from(const py::handle& object, const std::string& what) {
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  if (py::isinstance<py::dict>(object)) {
    return ConfigText{json_of(object, what), what};
  }
  if (py::hasattr(object, "__fspath__")) return py::str(object.attr("__fspath__")()).cast<std::string>();
  throw py::type_error(
      fmt::format("{} must be a bundled name, a path or a dict of the YAML's keys, not {}", what, type_name(object)));
}

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

namespace {

/// How many threads the module may use: a setting of the process, as the pool itself is.
void set_threads(int count) {
  static std::unique_ptr<tbb::global_control> limit;
  if (count < 0) throw py::value_error("count must be 1 or more, or 0 for all cores");
  limit.reset();
  if (count > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(count));
  }
}

/// Ends the pool's threads where nothing uses them; the next parallel loop starts them again.
void end_threads() {
  const Unlocked unlocked;
  tbb::task_scheduler_handle handle{tbb::attach{}};
  tbb::finalize(handle, std::nothrow);
}

}  // namespace

void bind_core(py::module_& m) {
  // Up to half of a ping's time is the kernel's otherwise. Who has told the allocator what to do is left alone.
  if (!std::getenv("MALLOC_MMAP_THRESHOLD_") && !std::getenv("MALLOC_TRIM_THRESHOLD_")) keep_freed_pages();

  py::register_exception<ConfigError>(m, "ConfigError", PyExc_ValueError).doc() =
      "An argument or a configuration value breaks its rule. A ValueError.";
  py::register_exception<DataError>(m, "DataError", PyExc_RuntimeError).doc() =
      "The work failed on data: a broken file, a full disk. A RuntimeError.";

  m.def(
      "pose",
      [](double x_m, double y_m, double z_m, double roll_deg, double pitch_deg, double yaw_deg) {
        const Pose pose = pose_from_xyz_rpy({x_m, y_m, z_m}, radians(roll_deg), radians(pitch_deg), radians(yaw_deg));
        const py::array matrix = matrix_of(pose);
        pose_from(matrix);
        return matrix;
      },
      py::arg("x_m"), py::arg("y_m"), py::arg("z_m"), py::kw_only(), py::arg("roll_deg") = 0, py::arg("pitch_deg") = 0,
      py::arg("yaw_deg") = 0,
      "T_world_sonar, float64 [4, 4]: R = Rz(yaw) Ry(pitch) Rx(roll). World: metres, east north up, z = 0 at the "
      "water\n"
      "surface. Sonar: x forward, y left, z up; positive pitch is nose down. Raises ValueError for what is not "
      "finite.");
  m.def(
      "roll_pitch_yaw_deg",
      [](const py::object& pose) {
        const auto [roll, pitch, yaw] = roll_pitch_yaw(pose_from(pose));
        return py::make_tuple(degrees(roll), degrees(pitch), degrees(yaw));
      },
      py::arg("pose"), "Roll, pitch and yaw of a pose in degrees, pitch within +-90.");
  m.def("_end_threads", &end_threads);
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_unlocked));
  m.def("_config_path", [](const std::string& kind, const std::string& name) { return resolve_name(kind, name); });
  m.attr("__version__") = ENSONIFY_VERSION;
  m.def("set_threads", &set_threads, py::arg("count"),
        "At most so many threads for all that this process computes with ensonify; 0: all cores. No result depends on\n"
        "it. Training with several workers wants 1 in each.");
}

}  // namespace ensonify::python
