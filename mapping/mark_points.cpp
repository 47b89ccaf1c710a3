#include "ensonify/mapping/mark_points.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "ensonify/core/parallel.hpp"
#include "ensonify/mapping/bresenham.hpp"

namespace ensonify {
namespace {

/// Several threads may mark a cell; the strongest stays, whatever their order.
template <typename M>
struct Strongest {
  M* marks;
  void set(std::ptrdiff_t offset, M mark) const {
    const std::atomic_ref<M> cell(marks[offset]);
    M before = cell.load(std::memory_order_relaxed);
    while (outdoes(mark, before) && !cell.compare_exchange_weak(before, mark, std::memory_order_relaxed)) {
    }
  }
};

Cell sonar_cell(const PosedImage& ping, const GridFrame& frame) {
  return frame.cell_of(ping.T_world_sonar.translation());
}

/// Direction of a beam at an elevation, world frame.
Vec3 ray_of(const PosedImage& ping, int beam, double elevation_rad) {
  return ping.T_world_sonar.linear() *
         from_spherical({1, ping.geometry.beam_azimuth_rad[static_cast<std::size_t>(beam)], elevation_rad});
}

/// Cell of a place in an image, world frame.
Cell cell_at(const PosedImage& ping, const GridFrame& frame, const Vec3& ray, double range_m) {
  return frame.cell_of(ping.T_world_sonar.translation() + range_m * ray);
}

Cell last_cell(const PosedImage& ping, const GridFrame& frame, const Vec3& ray) {
  return cell_at(ping, frame, ray, ping.geometry.bin_centre_m(ping.geometry.range_bins - 1));
}

/// The cells that the true points of a beam lie in, each once.
std::vector<Cell> true_cells(const PosedImage& ping, const GridFrame& frame, int beam) {
  std::vector<Cell> cells;
  for (int k = 0; k < ping.geometry.range_bins; ++k) {
    const double elevation = static_cast<double>(ping.elevation_rad(k, beam));
    if (!std::isfinite(elevation)) continue;
    cells.push_back(cell_at(ping, frame, ray_of(ping, beam, elevation), ping.geometry.bin_centre_m(k)));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace

CellBox reach_of_beams(const PosedImage& ping, const GridFrame& frame) {
  const Cell from = sonar_cell(ping, frame);
  CellBox box = {from, from};
  for (int b = 0; b < ping.geometry.beams(); ++b) {
    const Cell to = last_cell(ping, frame, ray_of(ping, b, 0));
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], to[a]);
      box.high[a] = std::max(box.high[a], to[a]);
    }
  }
  for (int& high : box.high) ++high;
  return intersection(box, box_of(frame));
}

CellBox reach_of_ranges(const PosedImage& ping, const GridFrame& frame) {
  const Vec3 from = ping.T_world_sonar.translation();
  const Vec3 reach = Vec3::Constant(ping.geometry.range_max_m);
  CellBox box = {frame.cell_of(from - reach), frame.cell_of(from + reach)};
  for (int& high : box.high) ++high;
  return intersection(box, box_of(frame));
}

template <typename M>
void mark_points(const PosedImage& ping, const ClassImage& classes, const GridFrame& frame, MarkBox<M>& marks) {
  const StridedBox& layout = marks.layout();
  const Strongest<M> cells{marks.data()};
  const Cell from = sonar_cell(ping, frame);
  const M silence = mark_of<M>(classes.class_of_silence, classes.class_of_silence);
  parallel_for(ping.geometry.beams(), [&](int beam) {
    const Vec3 ray = ray_of(ping, beam, 0);
    walk_bresenham(from, last_cell(ping, frame, ray), LineEnd::included, layout,
                   [&](std::ptrdiff_t offset) { cells.set(offset, silence); });
    for (int k = 0; k < ping.geometry.range_bins; ++k) {
      const Cell cell = cell_at(ping, frame, ray, ping.geometry.bin_centre_m(k));
      const int c = classes.class_of_pixel(k, beam);
      if (layout.box.contains(cell)) cells.set(layout.offset(cell), mark_of<M>(c, c));
    }
  });
}

template <typename M>
void mark_true_points(const PosedImage& ping, const ClassImage& classes, const GridFrame& frame, MarkBox<M>& marks) {
  const StridedBox& layout = marks.layout();
  const Cell from = sonar_cell(ping, frame);
  const M silence = mark_of<M>(classes.class_of_silence, classes.class_of_silence);
  parallel_for(ping.geometry.beams(), [&](int beam) {
    for (const Cell& cell : true_cells(ping, frame, beam)) {
      walk_bresenham(from, cell, LineEnd::excluded, layout, [&](std::ptrdiff_t offset) {
        std::atomic_ref<M>(marks.data()[offset]).store(silence, std::memory_order_relaxed);
      });
    }
  });
  parallel_for(ping.geometry.beams(), [&](int beam) {
    for (int k = 0; k < ping.geometry.range_bins; ++k) {
      const double elevation = static_cast<double>(ping.elevation_rad(k, beam));
      const int c = classes.class_of_pixel(k, beam);
      if (!std::isfinite(elevation) || c == 0) continue;
      const Cell cell = cell_at(ping, frame, ray_of(ping, beam, elevation), ping.geometry.bin_centre_m(k));
      if (!layout.box.contains(cell)) continue;
      const std::atomic_ref<M> mark(marks.data()[layout.offset(cell)]);
      M before = mark.load(std::memory_order_relaxed);
      while (!mark.compare_exchange_weak(before, with_echo(before, c), std::memory_order_relaxed)) {
      }
    }
  });
}

template void mark_points(const PosedImage&, const ClassImage&, const GridFrame&, MarkBox<Mark>&);
template void mark_points(const PosedImage&, const ClassImage&, const GridFrame&, MarkBox<SweepMark>&);
template void mark_true_points(const PosedImage&, const ClassImage&, const GridFrame&, MarkBox<Mark>&);
template void mark_true_points(const PosedImage&, const ClassImage&, const GridFrame&, MarkBox<SweepMark>&);

}  // namespace ensonify
