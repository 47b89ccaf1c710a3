#pragma once

#include <vector>

#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/mapping/marks.hpp"
#include "ensonify/mapping/threshold_classes.hpp"

namespace ensonify {

/// What each pixel says of the cells on its arc: [bin, beam], and one mark more at the end, none, for cells outside.
template <typename M>
using EvidenceImage = std::vector<M>;

/// Which pixels silence a cell's claim to be free.
enum class Shadow : std::uint8_t {
  ignored,       ///< only the cell's own
  of_all_echoes  ///< its own and all before them in their beams
};

/// Pools the classes over the footprint of a cell (ArcShape::footprint_cells, in m): the strongest within half of it in
/// range (bin centres) and across (beam azimuths, at the bin's range). With `echoes_count` false no pixel
/// makes a cell occupied; what they say of free cells stays.
template <typename M>
EvidenceImage<M> evidence_of(const ClassImage& classes, const SonarGeometry& geometry, double footprint_m,
                             Shadow shadow, bool echoes_count);

}  // namespace ensonify
