#include <fmt/format.h>

#include <cmath>

#include "ensonify/reproduction/page.hpp"

namespace ensonify {
namespace {

ReportTable geometry_table(const SonarGeometry& g) {
  const std::vector<double> edges = g.beam_edges_rad();
  return {"The sonar",
          {"", "value"},
          {{"range window [m]", fmt::format("{:g} to {:g}", g.range_min_m, g.range_max_m)},
           {"range bins", std::to_string(g.range_bins)},
           {"range bin [mm]", fixed(1e3 * g.bin_size_m(), 2)},
           {"beams", std::to_string(g.beams())},
           {"fan in azimuth [deg]", fixed(degrees(edges.front() - edges.back()), 1)},
           {"field of view in elevation [deg]", fixed(degrees(g.elevation_fov_rad), 1)}}};
}

ReportTable beam_table(const SonarPictures& s) {
  const double azimuth_rad = s.geometry.beam_azimuth_rad[static_cast<std::size_t>(s.beam)];
  return {
      "The beam of the side view",
      {"", "value"},
      {{"beam, counted from port", std::to_string(s.beam)}, {"bearing to port [deg]", fixed(degrees(azimuth_rad), 2)}}};
}

ReportTable pixel_table(const SonarPictures& s) {
  const double height = s.range_m * (std::sin(s.elevation_max_rad) - std::sin(s.elevation_min_rad));
  return {"The pixel of the arc",
          {"", "value"},
          {{"range bin", std::to_string(s.bin)},
           {"beam", std::to_string(s.beam)},
           {"range [m]", fixed(s.range_m, 3)},
           {"elevation of its lowest echo [deg]", fixed(degrees(s.elevation_min_rad), 2)},
           {"elevation of its highest echo [deg]", fixed(degrees(s.elevation_max_rad), 2)},
           {"height between them [m]", fixed(height, 3)}}};
}

}  // namespace

ReportSection sonar_section(const Findings& found) {
  const SonarPictures& s = found.sonar;
  const std::string ping =
      "One ping of an Oculus M1200d at 2.1 MHz in the bundled pier_harbor, noise of the paper, seed 0.";
  ReportSection section{"The sonar",
                        {"A multibeam imaging sonar measures range and bearing. Elevation is lost: everything on the "
                         "arc of one range and "
                         "bearing falls into one pixel."},
                        {},
                        {}};
  section.figures.push_back({"One ping",
                             ping,
                             "Images of one ping: raw, clean, mask, labels, and raw as a fan",
                             s.images,
                             {geometry_table(s.geometry)},
                             true});
  section.figures.push_back({"From above",
                             "Where rays of that ping met a surface, the fan, and the beam of the next figure. " + ping,
                             "Fan of the sonar from above with the points that its rays met",
                             figure_of(s.from_above, 440, 420),
                             {beam_table(s)}});
  section.figures.push_back({"Elevation ambiguity",
                             "One beam from the side: the surfaces that its rays met, within the sonar's frame. All "
                             "that lies on the arc of one "
                             "range is one pixel; of this ping, the pixel whose echoes lie farthest apart. " +
                                 ping,
                             "Surfaces along one beam from the side, with an arc of one range through several of them",
                             figure_of(s.from_the_side, 440, 420),
                             {pixel_table(s)}});
  return section;
}

}  // namespace ensonify
