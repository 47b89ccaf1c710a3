#include "ensonify/noise/disturb_echo.hpp"

#include "ensonify/noise/echo_stages.hpp"
#include "ensonify/noise/field_stages.hpp"
#include "ensonify/noise/scatter_field.hpp"

namespace ensonify {
namespace {

Image2<float> sum_of_layers(const Echo& layers) {
  Image2<float> sum = layers.direct;
  for (std::size_t i = 0; i < layers.multipath.size(); ++i) sum.pixels()[i] += layers.multipath.pixels()[i];
  return sum;
}

Image2<float> power_of(const ComplexField& field) {
  Image2<float> power(field.real.rows(), field.real.columns());
  const auto re = field.real.pixels();
  const auto im = field.imaginary.pixels();
  for (std::size_t i = 0; i < power.size(); ++i) power.pixels()[i] = re[i] * re[i] + im[i] * im[i];
  return power;
}

void add(ComplexField& field, const ComplexField& other) {
  for (std::size_t i = 0; i < field.real.size(); ++i) {
    field.real.pixels()[i] += other.real.pixels()[i];
    field.imaginary.pixels()[i] += other.imaginary.pixels()[i];
  }
}

bool has_field_stages(const NoiseChain& chain) {
  for (const auto& stage : chain.stages) {
    if (domain_of(stage) == NoiseDomain::speckle || domain_of(stage) == NoiseDomain::field) return true;
  }
  return false;
}

}  // namespace

ReceivedEcho disturb_echo(const NoiseChain& chain, const Echo& echo, const Receiver& receiver,
                          const PingSetting& setting) {
  SurfaceCells cells(receiver.sonar, setting.T_world_sonar);
  ReceivedEcho received;
  received.layers = disturb_layers(chain, echo, receiver.sonar.geometry, cells, setting);
  const Echo& layers = received.layers;
  const Image2<float> total = sum_of_layers(layers);
  const bool coherent = chain.find<CoherentSpeckle>() != nullptr;
  const bool leaks = chain.find<SidelobeArcs>() != nullptr || chain.find<CrossTalk>() != nullptr;

  if (!layers.multipath.empty()) received.multipath = receiver.spread.apply(layers.multipath);
  if (coherent) received.sidelobe = receiver.coherent.sidelobe_power(total);
  if (leaks && !coherent) received.sidelobe = Image2<float>(total.rows(), total.columns());
  if (leaks) add_leaked_power(chain, receiver, total, received.sidelobe);
  if (!has_field_stages(chain)) {
    received.power = receiver.spread.apply(total);
    return received;
  }

  ComplexField field(total.rows(), total.columns());
  if (coherent) add_scatterers(layers, cells, setting.surface, field);
  if (add_white_sources(chain, receiver, setting, field) || coherent) field = receiver.coherent.apply(field);
  if (!coherent) add(field, incoherent_field(chain, receiver.spread.apply(total), setting.ping.child("speckle")));
  disturb_field(chain, receiver, setting, field);
  received.power = power_of(field);
  return received;
}

}  // namespace ensonify
