#pragma once

#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/output/contact_sheet.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// What a ping keeps of the world, and what it loses.
struct SonarPictures {
  SonarGeometry geometry;
  ContactSheet images;    ///< of one ping: raw, clean, mask, labels; raw as a fan
  Plot from_above;        ///< the fan, what its rays met, and the beam that the side view follows
  Plot from_the_side;     ///< of that beam: surfaces, edges of the field of view, and an arc of one range
  int beam = 0, bin = 0;  ///< the pixel that the arc belongs to
  double range_m = 0;
  double elevation_min_rad = 0, elevation_max_rad = 0;  ///< of the surfaces that echo in this pixel
};

/// A ping of an Oculus M1200d at 2.1 MHz, as Lin et al. set it, in the bundled pier. The pixel is the one whose echoes
/// lie farthest apart in elevation, within the nominal field of view.
SonarPictures sonar_pictures();

}  // namespace ensonify
