#pragma once

#include <functional>
#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// What a beam would receive over what it does, of a field that is even across beams: 1 but near the border of the fan.
/// A beam there hears half of its lobe from beyond, where no ray is cast; what is just inside stands in for it, as if
/// the fan went on at the spacing of its outermost beams. `power` of the offset in sin(azimuth), 0 where it is not
/// heard. Limit: an object at the very border, smaller than a beam, comes out too loud by as much.
std::vector<double> border_gain(const std::vector<double>& azimuth_rad, int reach_beams,
                                const std::function<double(double offset)>& power);

/// Multiplies what beam b receives by gain[b]; diagonal d of the band matrix in row d.
void scale_beams(Image2<float>& band, const std::vector<double>& gain);

}  // namespace ensonify
