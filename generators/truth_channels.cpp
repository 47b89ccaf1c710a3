#include "ensonify/generators/truth_channels.hpp"

#include <algorithm>

namespace ensonify {

std::vector<Channel> truth_channels(const Echo& echo, const PingImages& images, const PingTruth& truth) {
  const Image2<float> nothing(echo.direct.rows(), echo.direct.columns());
  std::vector<Channel> channels{{"direct", echo.direct},
                                {"multipath", images.multipath.empty() ? nothing : images.multipath},
                                {"sidelobe", images.sidelobe.empty() ? nothing : images.sidelobe}};
  if (truth.instance.empty()) return channels;
  channels.emplace_back("elevation.min", truth.elevation_min_rad);
  channels.emplace_back("elevation.max", truth.elevation_max_rad);
  channels.emplace_back("elevation.strongest", truth.elevation_strongest_rad);
  channels.emplace_back("incidence", truth.incidence_rad);
  Image2<float> instance(truth.instance.rows(), truth.instance.columns());
  std::copy(truth.instance.pixels().begin(), truth.instance.pixels().end(), instance.pixels().begin());
  channels.emplace_back("instance", std::move(instance));
  return channels;
}

}  // namespace ensonify
