#pragma once

#include "ensonify/core/posed_image.hpp"
#include "ensonify/mapping/mark_box.hpp"
#include "ensonify/mapping/marks.hpp"
#include "ensonify/mapping/threshold_classes.hpp"

namespace ensonify {

/// The box of cells between the sonar and the last bins of its beams at elevation 0.
CellBox reach_of_beams(const PosedImage& ping, const GridFrame& frame);

/// The box of cells that any echo of the ping may come from, whatever its direction.
CellBox reach_of_ranges(const PosedImage& ping, const GridFrame& frame);

/// `Points`: Bresenham lines from the sonar's cell to that of every beam's last bin, and the centre of every pixel in
/// its cell, at elevation 0; a cell takes its strongest pixel.
template <typename M>
void mark_points(const PosedImage& ping, const ClassImage& classes, const GridFrame& frame, MarkBox<M>& marks);

/// The part of `Oracle` that sets pixels at their true elevation: lines to them free what they cross, whatever was
/// marked before; echoes take their cells.
template <typename M>
void mark_true_points(const PosedImage& ping, const ClassImage& classes, const GridFrame& frame, MarkBox<M>& marks);

}  // namespace ensonify
