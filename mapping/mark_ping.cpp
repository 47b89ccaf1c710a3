#include "ensonify/mapping/mark_ping.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/mark_arcs.hpp"
#include "ensonify/mapping/mark_points.hpp"

namespace ensonify {
namespace {

template <typename M>
struct Marker {
  const PosedImage& ping;
  const ClassImage& classes;
  const GridFrame& frame;
  MarkBox<M>& marks;

  Frustum frustum(const ArcShape& shape) const { return {ping.geometry, shape.elevation_share, ping.T_world_sonar}; }

  void arcs(const ArcShape& shape, Shadow shadow) const { arcs(shape, shadow, frustum(shape).reach(frame), true); }
  void arcs(const ArcShape& shape, Shadow shadow, const CellBox& within, bool echoes_count) const {
    marks.reset(within);
    const double footprint_m = shape.footprint_cells * frame.resolution_m;
    mark_arcs(evidence_of<M>(classes, ping.geometry, footprint_m, shadow, echoes_count), ping.geometry, frustum(shape),
              frame, marks);
  }

  void operator()(const Points&) const {
    marks.reset(reach_of_beams(ping, frame));
    mark_points(ping, classes, frame, marks);
  }
  void operator()(const Arc& m) const { arcs(m.shape, Shadow::ignored); }
  void operator()(const ArcShadow& m) const { arcs(m.shape, Shadow::of_all_echoes); }
  void operator()(const Carve& m) const { arcs(m.shape, Shadow::of_all_echoes); }
  void operator()(const Oracle& m) const {
    // True points may lie beyond the nominal field of view.
    arcs(m.shape, Shadow::of_all_echoes, reach_of_ranges(ping, frame), false);
    mark_true_points(ping, classes, frame, marks);
  }
};

void require_pose(const Pose& pose, const SonarGeometry& g, const GridFrame& frame) {
  const Eigen::Matrix3d r = pose.linear();
  const Vec3 p = pose.translation();
  if (!p.allFinite() || !r.allFinite()) {
    throw DataError(
        "pose of the ping holds values that are no finite numbers (NaN or infinite); leave the ping out or "
        "repair its pose");
  }
  if (!(r * r.transpose()).isIdentity(1e-4) || r.determinant() < 0) {
    throw DataError(
        "pose of the ping: its 3 x 3 part is no rotation; rows must be orthogonal, of length 1, right-handed");
  }
  const double cells = ((p - frame.origin_m).cwiseAbs().maxCoeff() + g.range_max_m) / frame.resolution_m;
  if (!(cells < farthest_cell / 2)) {
    throw DataError(
        fmt::format("ping from ({}, {}, {}) m reaches 2^28 cells or more from the map's corner; check its pose, "
                    "its range and the map's resolution of {} m",
                    p.x(), p.y(), p.z(), frame.resolution_m));
  }
}

}  // namespace

void require_valid(const PosedImage& ping, const InverseModel& model, const GridFrame& frame) {
  const SonarGeometry& g = ping.geometry;
  const auto [rows, columns] = std::visit([](const auto& i) { return std::pair(i.rows(), i.columns()); }, ping.grey);
  if (rows < 1 || columns < 1) throw DataError("empty image; a ping needs at least one range bin and one beam");
  if (rows != g.range_bins || columns != g.beams()) {
    throw DataError(
        fmt::format("image of {} x {} pixels for a geometry of {} range bins and {} beams: rows must be bins and "
                    "columns beams",
                    rows, columns, g.range_bins, g.beams()));
  }
  if (!(g.range_min_m >= 0 && g.range_max_m > g.range_min_m && std::isfinite(g.range_max_m))) {
    throw DataError(fmt::format("range window {}..{} m: it must begin at 0 or later and end after it begins",
                                g.range_min_m, g.range_max_m));
  }
  if (!(g.elevation_fov_rad > 0 && g.elevation_fov_rad < std::numbers::pi)) {
    throw DataError(fmt::format("elevation field of view {} deg lies outside (0, 180)", degrees(g.elevation_fov_rad)));
  }
  for (std::size_t b = 1; b < g.beam_azimuth_rad.size(); ++b) {
    if (!(g.beam_azimuth_rad[b] < g.beam_azimuth_rad[b - 1])) {
      throw DataError(
          fmt::format("azimuth of beam {} does not descend from {} to {} deg; column 0 must be the port-most", b,
                      degrees(g.beam_azimuth_rad[b - 1]), degrees(g.beam_azimuth_rad[b])));
    }
  }
  const std::vector<double> edges = g.beam_edges_rad();
  if (!(edges.front() <= std::numbers::pi && edges.back() >= -std::numbers::pi)) {
    throw DataError(
        fmt::format("beams from {} to {} deg reach beyond +-180 deg", degrees(edges.front()), degrees(edges.back())));
  }
  require_pose(ping.T_world_sonar, g, frame);
  if (std::holds_alternative<Oracle>(model) &&
      (ping.elevation_rad.rows() != rows || ping.elevation_rad.columns() != columns)) {
    throw DataError(
        fmt::format("oracle needs the true elevation of {} x {} pixels and was given {} x {}; generate the "
                    "dataset with truth, or take another model",
                    rows, columns, ping.elevation_rad.rows(), ping.elevation_rad.columns()));
  }
}

template <typename M>
void mark_ping(const PosedImage& ping, const ClassImage& classes, const InverseModel& model, const GridFrame& frame,
               MarkBox<M>& marks) {
  std::visit(Marker<M>{ping, classes, frame, marks}, model);
}

template void mark_ping(const PosedImage&, const ClassImage&, const InverseModel&, const GridFrame&, MarkBox<Mark>&);
template void mark_ping(const PosedImage&, const ClassImage&, const InverseModel&, const GridFrame&,
                        MarkBox<SweepMark>&);

}  // namespace ensonify
