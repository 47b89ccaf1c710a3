#include "ensonify/filters/network_workspace.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>

#include "ensonify/core/available_memory.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

using Tag = dnnl::memory::format_tag;

/// Rows of a task where a layer can be cut into rows: few enough to stay in the cache until they are finished.
constexpr int stripe = 32;
constexpr std::size_t line_floats = 16;

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

std::size_t to_lines(std::size_t floats) { return (floats + line_floats - 1) / line_floats * line_floats; }

/// Output channels of a task, in blocks: enough tasks for some cores, enough work for oneDNN's kernels in each.
int blocks_a_task(int blocks) { return blocks >= 4 ? 2 : 1; }

dnnl::primitive_attr attributes_of(const NetworkStep& step) {
  dnnl::primitive_attr attributes;
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  if (step.slope) {
    dnnl::post_ops activation;
    activation.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, *step.slope, 0.0F);
    attributes.set_post_ops(activation);
  }
  return attributes;
}

}  // namespace

int network_block() {
  switch (dnnl::get_effective_cpu_isa()) {
    case dnnl::cpu_isa::avx512_core:
    case dnnl::cpu_isa::avx512_core_vnni:
    case dnnl::cpu_isa::avx512_core_bf16:
    case dnnl::cpu_isa::avx512_core_amx:
      return 16;
    default:
      return 8;
  }
}

NetworkWorkspace::NetworkWorkspace(const NetworkPlan& plan, const dnnl::engine& engine, int rows, int columns)
    : plan_(plan), engine_(engine), rows_(rows), columns_(columns), memory_(nullptr, &std::free) {
  std::vector<std::size_t> begins;
  std::size_t total = 0;
  const auto available = static_cast<double>(available_memory_bytes());
  const auto area = [&](int halvings) { return static_cast<double>(pixels(halvings)); };
  const auto reserve = [&](double floats) {
    begins.push_back(total);
    // Also below what oneDNN's kernels count in 32 bits.
    if (floats > 0x1p31 || (static_cast<double>(total) + floats) * sizeof(float) > available) {
      throw DataError(fmt::format("needs more memory for an image of {} x {} than there is", rows, columns));
    }
    total += to_lines(static_cast<std::size_t>(floats));
  };
  for (const NetworkBuffer& b : plan.buffers) reserve(b.channels * area(b.halvings));
  double scratch = 0;
  for (const NetworkStep& step : plan.steps) {
    if (std::holds_alternative<Transpose>(step.kind))
      scratch = std::max(scratch, blocks_of(step) * plan.block * area(step.halvings));
    if (std::holds_alternative<TransposeToPlanes>(step.kind)) {  // a row more on both sides of every stripe
      const int height_in = height(step.halvings + 1), stripes = (height_in + stripe - 1) / stripe;
      scratch = std::max(scratch, 16.0 * step.channels * (height_in + 2 * stripes) * width(step.halvings + 1));
    }
  }
  reserve(scratch);
  memory_.reset(static_cast<float*>(std::aligned_alloc(line_floats * sizeof(float), total * sizeof(float))));
  if (!memory_) throw std::bad_alloc();
  for (std::size_t begin : begins) buffers_.push_back(memory_.get() + begin);
  scratch_ = buffers_.back();

  const OneThread one;
  for (const NetworkStep& step : plan.steps) {
    std::visit([&](const auto& kind) { add(step, kind); }, step.kind);
  }
}

NetworkWorkspace::Call NetworkWorkspace::call(const NetworkKernel& kernel, const Window& window, int halvings,
                                              int stride, int block, int blocks, float* to,
                                              const dnnl::primitive_attr& attributes) const {
  using dnnl::memory;
  const bool wide = plan_.block == 16, planes = kernel.in == 1;
  const Tag in_blocks = wide ? Tag::nChw16c : Tag::nChw8c;
  const Tag weights_of_blocks = wide ? Tag::OIhw16i16o : Tag::OIhw8i8o;
  const Tag weights_of_planes = wide ? Tag::Ohwi16o : Tag::Ohwi8o;
  constexpr auto real = memory::data_type::f32;
  const int out = blocks * plan_.block, side = kernel.side, in_width = width(halvings);
  const auto steps = [&](int length, int before, int after) { return (length + before + after - side) / stride + 1; };
  const memory::desc source({1, kernel.in, window.rows, in_width}, real, planes ? Tag::nchw : in_blocks);
  const memory::desc weights({out, kernel.in, side, side}, real, planes ? weights_of_planes : weights_of_blocks);
  const memory::desc bias({out}, real, Tag::x);
  const memory::desc result({1, out, steps(window.rows, window.above, window.below),
                             steps(in_width, window.left, window.right)},
                            real, in_blocks);
  const dnnl::convolution_forward::primitive_desc made(
      {dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, source, weights, bias, result,
       {stride, stride}, {window.above, window.left}, {window.below, window.right}},
      attributes, engine_);
  // oneDNN only reads them.
  float* const first_weight = const_cast<float*>(kernel.weights.data()) +
                              static_cast<std::size_t>(block) * plan_.block * kernel.in * side * side;
  float* const first_bias = const_cast<float*>(kernel.bias.data()) + block * plan_.block;
  return {dnnl::convolution_forward(made),
          {{DNNL_ARG_SRC, memory(source, engine_, window.source)},
           {DNNL_ARG_WEIGHTS, memory(weights, engine_, first_weight)},
           {DNNL_ARG_BIAS, memory(bias, engine_, first_bias)},
           {DNNL_ARG_DST, memory(result, engine_, to)},
           {DNNL_ARG_SCRATCHPAD, memory(made.scratchpad_desc(), engine_)}}};
}

void NetworkWorkspace::add(const NetworkStep& step, const Spread&) {
  Phase phase{&step, {}};
  for (int row = 0; row < rows_; row += stripe) {
    phase.tasks.push_back({{}, Closing::spread, 0, 1, row, std::min(stripe, rows_ - row), nullptr});
  }
  phases_.push_back(std::move(phase));
}

void NetworkWorkspace::add(const NetworkStep& step, const Convolve& convolve) {
  const NetworkKernel& kernel = convolve.kernel;
  const int side = kernel.side, stride = side == 4 ? 2 : 1, pad = (side - 1) / 2;
  const int halvings = plan_.buffers[step.source].halvings, in_rows = height(halvings), out_rows = height(step.halvings);
  const int blocks = blocks_of(step);
  // Rows of one block, or one plane, lie one after the other, so that some of them are an image of their own.
  const bool striped = kernel.in <= plan_.block;
  const int group = striped ? 1 : blocks_a_task(blocks), rows = striped ? stripe : out_rows;
  const dnnl::primitive_attr attributes = attributes_of(step);
  Phase phase{&step, {}};
  for (int block = 0; block < blocks; block += group) {
    for (int row = 0; row < out_rows; row += rows) {
      Task task{{}, Closing::activate, block, std::min(group, blocks - block), row, std::min(rows, out_rows - row),
                nullptr};
      const int first = row * stride - pad, end = (row + task.rows - 1) * stride - pad + side;
      const int from = std::max(first, 0), to = std::min(end, in_rows);
      const Window window{buffers_[step.source] + static_cast<std::size_t>(from) * width(halvings) * kernel.in,
                          to - from, from - first, end - to, pad, pad};
      task.calls.push_back(call(kernel, window, halvings, stride, block, task.blocks, raw_row(step, block, row).data(),
                                attributes));
      phase.tasks.push_back(std::move(task));
    }
  }
  phases_.push_back(std::move(phase));
}

void NetworkWorkspace::add(const NetworkStep& step, const Transpose& transpose) {
  const int halvings = step.halvings + 1, blocks = blocks_of(step), group = blocks_a_task(blocks);
  const dnnl::primitive_attr attributes = attributes_of(step);
  Phase convolutions{&step, {}}, interleaving{&step, {}};
  for (int parity = 0; parity < 4; ++parity) {
    const int a = parity / 2, b = parity % 2;
    const Window window{buffers_[step.source], height(halvings), 1 - a, a, 1 - b, b};
    for (int block = 0; block < blocks; block += group) {
      Task task;
      float* const to = scratch_ + (static_cast<std::size_t>(parity) * blocks + block) * pixels(halvings) * plan_.block;
      task.calls.push_back(call(transpose.kernels[parity], window, halvings, 1, block, std::min(group, blocks - block),
                                to, attributes));
      convolutions.tasks.push_back(std::move(task));
    }
  }
  const int out_rows = height(step.halvings);
  for (int block = 0; block < blocks; ++block) {
    for (int row = 0; row < out_rows; row += stripe) {
      interleaving.tasks.push_back(
          {{}, Closing::interleave, block, 1, row, std::min(stripe, out_rows - row), nullptr});
    }
  }
  phases_.push_back(std::move(convolutions));
  phases_.push_back(std::move(interleaving));
}

void NetworkWorkspace::add(const NetworkStep& step, const TransposeToPlanes& transpose) {
  const int halvings = step.halvings + 1, in_rows = height(halvings);
  const dnnl::primitive_attr first = attributes_of(step);
  dnnl::primitive_attr others = attributes_of(step);
  dnnl::post_ops sum;
  sum.append_sum();
  others.set_post_ops(sum);
  Phase phase{&step, {}};
  float* cells = scratch_;
  for (int row = 0; row < in_rows; row += stripe) {
    Task task{{}, Closing::gather, 0, 1, row, std::min(stripe, in_rows - row), cells};
    const int from = std::max(row - 1, 0), to = std::min(row + task.rows + 1, in_rows);
    for (std::size_t i = 0; i < transpose.kernels.size(); ++i) {
      const NetworkKernel& kernel = transpose.kernels[i];
      float* const source = buffers_[step.source] + (i * in_rows + from) * width(halvings) * plan_.block;
      task.calls.push_back(call(kernel, {source, to - from, 0, 0, 0, 0}, halvings, 1, 0, kernel.out / plan_.block,
                                cells, i == 0 ? first : others));
    }
    cells += static_cast<std::size_t>(16) * step.channels * (to - from) * width(halvings);
    phase.tasks.push_back(std::move(task));
  }
  phases_.push_back(std::move(phase));
}

void NetworkWorkspace::run() {
  for (const Phase& phase : phases_) {
    parallel_for(static_cast<int>(phase.tasks.size()), [&](int i) {
      const Task& task = phase.tasks[i];
      if (!task.calls.empty()) {
        const OneThread one;
        dnnl::stream stream(engine_);
        for (const Call& call : task.calls) call.primitive.execute(stream, call.arguments);
      }
      close(*phase.step, task);
    });
  }
}

}  // namespace ensonify
