/// What a network does between oneDNN's convolutions: rows of numbers that move and are activated.
#include <algorithm>

#include "ensonify/filters/network_workspace.hpp"

namespace ensonify {

std::span<float> NetworkWorkspace::raw_row(const NetworkStep& step, int block, int row) {
  const NetworkSink& sink = step.sinks.front();
  const std::size_t length = static_cast<std::size_t>(width(step.halvings)) * plan_.block;
  const std::size_t before = (static_cast<std::size_t>(sink.channel / plan_.block + block) * height(step.halvings) + row);
  return {buffers_[sink.buffer] + before * length, length};
}

void NetworkWorkspace::close(const NetworkStep& step, const Task& task) {
  if (task.closing == Closing::none) return;
  if (task.closing == Closing::gather) return gather_rows(step, task);
  for (int block = task.block; block < task.block + task.blocks; ++block) {
    for (int row = task.row; row < task.row + task.rows; ++row) {
      if (task.closing == Closing::spread) spread_row(step, row);
      if (task.closing == Closing::interleave) interleave_row(step, block, row);
      finish_row(step, block, row);
    }
  }
}

/// The image's row as the first channel of a block.
void NetworkWorkspace::spread_row(const NetworkStep& step, int row) {
  const std::span<float> to = raw_row(step, 0, row);
  const float* const from = buffers_[image_buffer] + static_cast<std::size_t>(row) * columns_;
  std::ranges::fill(to, 0.0F);
  for (int x = 0; x < columns_; ++x) to[static_cast<std::size_t>(x) * plan_.block] = from[x];
}

/// A row of a transposed convolution: its pixels are in turn of two of the four parities.
void NetworkWorkspace::interleave_row(const NetworkStep& step, int block, int row) {
  const auto pairs = [&](auto of_block) {
    constexpr int size = of_block;
    const int halvings = step.halvings + 1, in_width = width(halvings);
    const std::size_t parity = blocks_of(step) * pixels(halvings) * size;
    const float* const even = scratch_ + (row % 2) * 2 * parity + block * pixels(halvings) * size +
                              static_cast<std::size_t>(row / 2) * in_width * size;
    float* to = raw_row(step, block, row).data();
    for (int x = 0; x < in_width; ++x, to += 2 * size) {
      std::copy_n(even + x * size, size, to);
      std::copy_n(even + parity + x * size, size, to + size);
    }
  };
  if (plan_.block == 16) return pairs(std::integral_constant<int, 16>{});
  pairs(std::integral_constant<int, 8>{});
}

/// Sums of what the input pixels add to the cells around them: input row i to the result's rows 2 i - 1 .. 2 i + 2.
void NetworkWorkspace::gather_rows(const NetworkStep& step, const Task& task) {
  const int halvings = step.halvings + 1, in_rows = height(halvings), in_width = width(halvings), size = plan_.block;
  const int from = std::max(task.row - 1, 0), held = std::min(task.row + task.rows + 1, in_rows) - from;
  const std::vector<float>& bias = std::get<TransposeToPlanes>(step.kind).bias;
  const auto add_row = [&](int channel, int in_row, int kernel_row, float* to) {
    if (in_row < 0 || in_row >= in_rows) return;
    const int cell = 16 * channel + 4 * kernel_row;
    const float* cells =
        task.cells + (static_cast<std::size_t>(cell / size) * held + in_row - from) * in_width * size + cell % size;
    // Input column j adds to the columns 2 j - 1 .. 2 j + 2.
    to[0] += cells[1];
    for (int x = 1; x < in_width; ++x, cells += size) {
      to[2 * x - 1] += cells[2] + cells[size];
      to[2 * x] += cells[size + 1] + cells[3];
    }
    to[2 * in_width - 1] += cells[2];
  };
  for (int channel = 0; channel < step.channels; ++channel) {
    for (int row = 2 * task.row; row < 2 * (task.row + task.rows); ++row) {
      for (const NetworkSink& sink : step.sinks) {
        const std::size_t begin = static_cast<std::size_t>(sink.channel + channel) * height(step.halvings) + row;
        const std::span<float> to{buffers_[sink.buffer] + begin * width(step.halvings), 2 * static_cast<std::size_t>(in_width)};
        std::ranges::fill(to, bias[channel]);
        add_row(channel, row / 2, 1 + row % 2, to.data());
        add_row(channel, row % 2 ? row / 2 + 1 : row / 2 - 1, row % 2 ? 0 : 3, to.data());
        activate(sink.activations, to);
      }
    }
  }
}

/// From the first sink to the others, each with its own activations; the first one's own come last.
void NetworkWorkspace::finish_row(const NetworkStep& step, int block, int row) {
  const std::span<float> raw = raw_row(step, block, row);
  for (std::size_t i = 1; i < step.sinks.size(); ++i) {
    const NetworkSink& sink = step.sinks[i];
    float* const to = buffers_[sink.buffer];
    const std::size_t side = height(step.halvings), line = width(step.halvings);
    if (!plan_.buffers[sink.buffer].planes) {
      const std::size_t begin = ((sink.channel / plan_.block + block) * side + row) * raw.size();
      std::ranges::copy(raw, to + begin);
      activate(sink.activations, {to + begin, raw.size()});
      continue;
    }
    for (int c = 0; c < std::min(plan_.block, step.channels - block * plan_.block); ++c) {
      const std::span<float> plane{to + ((sink.channel + block * plan_.block + c) * side + row) * line, line};
      for (std::size_t x = 0; x < line; ++x) plane[x] = raw[x * plan_.block + c];
      activate(sink.activations, plane);
    }
  }
  activate(step.sinks.front().activations, raw);
}

}  // namespace ensonify
