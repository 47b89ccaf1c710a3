#pragma once

#include "ensonify/core/colour.hpp"
#include "ensonify/core/image2.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify {

/// Where a picture is taken from; the frame is the sonar's (x forward, y left, z up).
struct Camera {
  Pose T_world_camera = Pose::Identity();
  double width_m = 1;            ///< orthographic: width of what is seen
  double field_of_view_rad = 0;  ///< horizontal; above 0: perspective
};

/// Straight down with north up, or north from the near side of the navigable water (a section: what is before is cut
/// off); the width is that of the bounds.
Camera plan_camera(const Scene& scene);
Camera side_camera(const Scene& scene);
/// Perspective from outside, what lies within the bounds filling the picture. Azimuth: where the camera stands, from
/// east to north.
Camera oblique_camera(const Scene& scene, double azimuth_rad, double elevation_rad, double aspect);

/// A shaded picture of what people would see without water: colours of the materials, light from the northwest, ambient
/// occlusion (Zhukov et al. 1998), outlines. Left out are the sea surface and all that lies before the bounds as the
/// camera sees them, so that one looks into a basin through its wall. Same bits for any number of threads.
Image2<Rgb> draw_scene(const Scene& scene, const Camera& camera, int width, int height);

}  // namespace ensonify
