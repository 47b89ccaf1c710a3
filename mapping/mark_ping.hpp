#pragma once

#include "ensonify/core/posed_image.hpp"
#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/mapping/mark_box.hpp"
#include "ensonify/mapping/marks.hpp"
#include "ensonify/mapping/threshold_classes.hpp"

namespace ensonify {

/// What a ping says of the cells around, by a model. `classes` are those of ping.grey. M is Mark for one threshold and
/// SweepMark for several.
template <typename M>
void mark_ping(const PosedImage& ping, const ClassImage& classes, const InverseModel& model, const GridFrame& frame,
               MarkBox<M>& marks);

/// Throws DataError unless image and geometry fit each other, the range window and the field of view make sense, the
/// pose is a rotation and a translation in finite numbers not 2^28 cells or more away, and elevations are there for
/// `Oracle`.
void require_valid(const PosedImage& ping, const InverseModel& model, const GridFrame& frame);

}  // namespace ensonify
