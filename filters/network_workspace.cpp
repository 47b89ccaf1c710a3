#include "ensonify/filters/network_workspace.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <new>

#include "ensonify/core/available_memory.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

using dnnl::memory;

constexpr auto real = memory::data_type::f32;
constexpr auto by_pixel = memory::format_tag::nhwc;

/// Tasks: enough for some cores, but no fewer rows than let a kernel's weights pay, nor more numbers than stay in a
/// core's cache until they are written to the sinks.
constexpr int least_tasks = 8, least_rows = 4;
constexpr std::size_t most_floats = 1 << 15;
constexpr std::size_t line_floats = 16;

std::size_t to_lines(std::size_t floats) { return (floats + line_floats - 1) / line_floats * line_floats; }

/// oneDNN asks OpenMP for the number of threads when it compiles and when it runs; with one, it starts no others.
class OneThread {
 public:
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_ = omp_get_max_threads();
};

/// `size` numbers at a time, which the compiler unrolls.
template <int size>
void copy_blocks(const float* from, int from_step, float* to, int to_step, int channels, int pixels) {
  if (channels == size) {
    for (int x = 0; x < pixels; ++x, from += from_step, to += to_step) std::copy_n(from, size, to);
    return;
  }
  for (int x = 0; x < pixels; ++x, from += from_step, to += to_step) {
    for (int c = 0; c < channels; c += size) std::copy_n(from + c, size, to + c);
  }
}

/// The first `channels` of each pixel; the steps lead from pixel to pixel.
void copy_pixels(const float* from, int from_step, float* to, int to_step, int channels, int pixels) {
  if (from_step == channels && to_step == channels) {
    std::copy_n(from, static_cast<std::size_t>(pixels) * channels, to);
  } else if (channels % 16 == 0) {
    copy_blocks<16>(from, from_step, to, to_step, channels, pixels);
  } else if (channels % 8 == 0) {
    copy_blocks<8>(from, from_step, to, to_step, channels, pixels);
  } else if (channels % 2 == 0) {
    copy_blocks<2>(from, from_step, to, to_step, channels, pixels);
  } else {
    copy_blocks<1>(from, from_step, to, to_step, channels, pixels);
  }
}

}  // namespace

memory NetworkWeights::ordered(const NetworkKernel& kernel, const memory::desc& order) const {
  const std::lock_guard lock(mutex_);
  const auto [begin, end] = ordered_.equal_range(&kernel);
  const auto found = std::find_if(begin, end, [&](const auto& held) { return held.second.get_desc() == order; });
  if (found != end) return found->second;
  // oneDNN only reads them.
  memory plain({{kernel.out, kernel.in, kernel.side, kernel.side}, real, memory::format_tag::oihw}, engine_,
               const_cast<float*>(kernel.weights.data()));
  memory made(order, engine_);
  dnnl::stream stream(engine_);
  dnnl::reorder(plain, made).execute(stream, plain, made);
  return ordered_.emplace(&kernel, made)->second;
}

NetworkWorkspace::NetworkWorkspace(const NetworkWeights& weights, int rows, int columns)
    : weights_(weights), rows_(rows), columns_(columns), memory_(nullptr, &std::free) {
  const NetworkPlan& plan = weights.plan();
  std::vector<std::size_t> begins;
  std::size_t total = 0;
  const std::size_t most = available_memory_bytes() / sizeof(float);
  const auto reserve = [&](std::size_t floats) {
    begins.push_back(total);
    total += to_lines(floats);
    if (total > most)
      throw DataError(fmt::format("needs more memory for an image of {} x {} than is free", rows, columns));
  };
  for (const NetworkBuffer& buffer : plan.buffers) reserve(pixels(buffer.halvings) * buffer.channels);
  memory_.reset(static_cast<float*>(std::aligned_alloc(line_floats * sizeof(float), total * sizeof(float))));
  if (!memory_) throw std::bad_alloc();
  for (const std::size_t begin : begins) buffers_.push_back(memory_.get() + begin);
  const OneThread one;
  for (const NetworkStep& step : plan.steps) steps_.push_back(tasks_of(step));
}

std::size_t NetworkWorkspace::result_row(const NetworkStep& step) const {
  return static_cast<std::size_t>(width(step.halvings)) * step.channels;
}

std::size_t NetworkWorkspace::raw_row(const NetworkStep& step) const {
  const bool grid = std::holds_alternative<Transpose>(step.kind);
  return grid ? static_cast<std::size_t>(width(step.halvings + 1) + 1) * 4 * step.channels : result_row(step);
}

std::pair<int, int> NetworkWorkspace::rows_of(const NetworkStep& step) const {
  const bool grid = std::holds_alternative<Transpose>(step.kind);
  const int all = grid ? height(step.halvings + 1) + 1 : height(step.halvings);
  const int cached = static_cast<int>(most_floats / raw_row(step));
  const int wanted = std::max(least_rows, std::min(cached, (all + least_tasks - 1) / least_tasks));
  const int tasks = (all + wanted - 1) / wanted;
  return {all, (all + tasks - 1) / tasks};
}

std::vector<NetworkWorkspace::Task> NetworkWorkspace::tasks_of(const NetworkStep& step) const {
  const auto [all, rows] = rows_of(step);
  std::vector<Task> tasks;
  for (int row = 0; row < all; row += rows) {
    Task& task = tasks.emplace_back(Task{&step, row, std::min(rows, all - row)});
    std::visit([&](const auto& kind) { compile(task, kind); }, step.kind);
  }
  return tasks;
}

void NetworkWorkspace::compile(Task& task, const Convolve& convolve) const {
  const int side = convolve.kernel.side, stride = side == 4 ? 2 : 1, pad = (side - 1) / 2;
  const int first = task.row * stride - pad;
  compile(task, convolve.kernel, first, first + (task.rows - 1) * stride + side, stride, pad);
}

void NetworkWorkspace::compile(Task& task, const Transpose& transpose) const {
  compile(task, transpose.kernel, task.row - 1, task.row + task.rows, 1, 1);
}

/// From rows of the source, zeros where there are none; `pad` columns of zeros on both sides.
void NetworkWorkspace::compile(Task& task, const NetworkKernel& kernel, int first_row, int end_row, int stride,
                               int pad) const {
  const int source_buffer = task.step->source, halvings = weights_.plan().buffers[source_buffer].halvings;
  const int from = std::max(first_row, 0), to = std::min(end_row, height(halvings)), columns = width(halvings);
  const memory::desc source({1, kernel.in, to - from, columns}, real, by_pixel);
  const memory::desc any_order({kernel.out, kernel.in, kernel.side, kernel.side}, real, memory::format_tag::any);
  const memory::desc bias({kernel.out}, real, memory::format_tag::x);
  const memory::desc result({1, kernel.out, task.rows, (columns + 2 * pad - kernel.side) / stride + 1}, real, by_pixel);
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  if (task.step->slope) {
    dnnl::post_ops activation;
    activation.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, *task.step->slope, 0.0F);
    attributes.set_post_ops(activation);
  }
  const dnnl::engine& engine = weights_.engine();
  const dnnl::convolution_forward::primitive_desc made({dnnl::prop_kind::forward_inference,
                                                        dnnl::algorithm::convolution_direct,
                                                        source,
                                                        any_order,
                                                        bias,
                                                        result,
                                                        {stride, stride},
                                                        {from - first_row, pad},
                                                        {end_row - to, pad}},
                                                       attributes, engine);
  task.convolution = dnnl::convolution_forward(made);
  float* const pixels = buffers_[source_buffer] + static_cast<std::size_t>(from) * columns * kernel.in;
  task.arguments = {{DNNL_ARG_SRC, memory(source, engine, pixels)},
                    {DNNL_ARG_WEIGHTS, weights_.ordered(kernel, made.weights_desc())},
                    {DNNL_ARG_BIAS, memory(bias, engine, const_cast<float*>(kernel.bias.data()))},
                    {DNNL_ARG_DST, memory(result, engine, DNNL_MEMORY_NONE)},
                    {DNNL_ARG_SCRATCHPAD, memory(made.scratchpad_desc(), engine)}};
}

void NetworkWorkspace::run() {
  for (std::vector<Task>& tasks : steps_) {
    parallel_for(static_cast<int>(tasks.size()), [&](int i) { run(tasks[i]); });
  }
}

void NetworkWorkspace::run(Task& task) {
  const NetworkStep& step = *task.step;
  const std::size_t raw_floats = to_lines(task.rows * raw_row(step));
  std::vector<float>& scratch = scratch_.local();
  if (scratch.size() < raw_floats + result_row(step)) scratch.resize(raw_floats + result_row(step));
  const float* raw = buffers_[step.source] + task.row * raw_row(step);  // where nothing is convolved
  if (task.convolution) {
    const OneThread one;
    dnnl::stream stream(weights_.engine());
    task.arguments.at(DNNL_ARG_DST).set_data_handle(scratch.data());
    task.convolution.execute(stream, task.arguments);
    raw = scratch.data();
  }
  const bool grid = std::holds_alternative<Transpose>(step.kind);
  const int channels = step.channels, columns = width(grid ? step.halvings + 1 : step.halvings);
  const std::span<float> activated{scratch.data() + raw_floats, result_row(step)};
  for (int row = task.row; row < task.row + task.rows; ++row, raw += raw_row(step)) {
    if (!grid) {
      write_row(step, row, activated,
                [&](float* to, int to_step) { copy_pixels(raw, channels, to, to_step, channels, columns); });
      continue;
    }
    // The odd row of the result before twice the grid's row, and the even one of that number.
    for (const int a : {1, 0}) {
      if (2 * row - a < 0 || 2 * row - a >= height(step.halvings)) continue;
      write_row(step, 2 * row - a, activated, [&](float* to, int to_step) {
        for (const int b : {0, 1}) {
          const float* const from = raw + (2 * a + b + 4 * b) * channels;
          copy_pixels(from, 4 * channels, to + b * to_step, 2 * to_step, channels, columns);
        }
      });
    }
  }
}

/// To every sink. `place(to, to_step)` copies the row, `to_step` numbers from pixel to pixel.
void NetworkWorkspace::write_row(const NetworkStep& step, int row, std::span<float> activated, const auto& place) {
  for (const NetworkSink& sink : step.sinks) {
    const int columns = width(step.halvings), channels = weights_.plan().buffers[sink.buffer].channels;
    float* const to = buffers_[sink.buffer] + static_cast<std::size_t>(row) * columns * channels + sink.channel;
    if (sink.activations.empty() || channels == step.channels) {
      place(to, channels);
      activate(sink.activations, {to, activated.size()});
    } else {
      place(activated.data(), step.channels);
      activate(sink.activations, activated);
      copy_pixels(activated.data(), step.channels, to, channels, step.channels, columns);
    }
  }
}

}  // namespace ensonify
