#pragma once

#include <algorithm>
#include <cstdint>

namespace ensonify {

/// What a ping says of a cell at one threshold. The greater wins.
enum class Mark : std::uint8_t { none = 0, free = 1, occupied = 2 };

/// What a ping says of a cell at every threshold of a sweep, for ascending thresholds t_0, t_1 ..: occupied at t_k if
/// k < echo, free if k >= before, else nothing; echo <= before. `echo` counts the thresholds that the strongest pixel
/// in the cell reaches, `before` those reached there or on the way to it; 254 is never free. 0, 0 in memory is a cell
/// not looked at.
struct alignas(2) SweepMark {
  std::uint8_t echo_plus_1 = 0;
  std::uint8_t before_plus_1 = 0;
  bool operator==(const SweepMark&) const = default;
};

template <typename M>
M mark_of(int echo, int before);
template <>
inline Mark mark_of<Mark>(int echo, int before) {
  return echo > 0 ? Mark::occupied : before > 0 ? Mark::none : Mark::free;
}
template <>
inline SweepMark mark_of<SweepMark>(int echo, int before) {
  return {static_cast<std::uint8_t>(echo + 1), static_cast<std::uint8_t>(before + 1)};
}

/// Whether a pixel's mark replaces that of a weaker pixel in the same cell.
inline bool outdoes(Mark a, Mark b) { return a > b; }
inline bool outdoes(SweepMark a, SweepMark b) { return a.echo_plus_1 > b.echo_plus_1; }

/// A mark of a cell in which an echo of class `echo` > 0 is known to lie: occupied as far as that, else as it was.
inline Mark with_echo(Mark, int) { return Mark::occupied; }
inline SweepMark with_echo(SweepMark m, int echo) {
  constexpr std::uint8_t never = 255;
  const auto reached = static_cast<std::uint8_t>(echo + 1);
  return {std::max(m.echo_plus_1, reached), m == SweepMark{} ? never : std::max(m.before_plus_1, reached)};
}

}  // namespace ensonify
