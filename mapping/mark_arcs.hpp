#pragma once

#include "ensonify/mapping/evidence_image.hpp"
#include "ensonify/mapping/frustum_rows.hpp"
#include "ensonify/mapping/mark_box.hpp"

namespace ensonify {

/// Every cell of `marks` whose centre lies in the frustum takes the mark of the pixel that holds its centre's range and
/// azimuth. The box must be empty before. Projective: cells look themselves up, no ray is walked, and no cell is missed
/// or taken twice. Single precision: centres within 1e-6 of the range from a border may fall to either side.
template <typename M>
void mark_arcs(const EvidenceImage<M>& evidence, const SonarGeometry& geometry, const Frustum& frustum,
               const GridFrame& frame, MarkBox<M>& marks);

}  // namespace ensonify
