#pragma once

#include <memory>
#include <oneapi/dnnl/dnnl.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "ensonify/filters/network_plan.hpp"

namespace ensonify {

/// 16 or 8 channels: the numbers of the widest vectors that oneDNN uses on this processor.
int network_block();

/// Memory and compiled convolutions of a network for images of one size. One image at a time. How the work is cut into
/// tasks follows from the size alone, and oneDNN computes each of them on one thread: so the bits do not depend on the
/// number of threads, and OpenMP, which would not survive a fork, never starts one.
class NetworkWorkspace {
 public:
  /// Both sides: multiples of 2^halvings. The plan must outlive this. Throws DataError: more memory than there is;
  /// dnnl::error.
  NetworkWorkspace(const NetworkPlan& plan, const dnnl::engine& engine, int rows, int columns);

  int rows() const { return rows_; }
  int columns() const { return columns_; }

  /// Row by row, as the network takes it.
  std::span<float> image() { return {buffers_[image_buffer], pixels(0)}; }
  /// From the image, on the threads of the current oneTBB arena.
  void run();
  /// A channel of the result.
  std::span<const float> output(int channel) const { return {buffers_[output_buffer] + channel * pixels(0), pixels(0)}; }

 private:
  /// A primitive of oneDNN with its memory.
  struct Call {
    dnnl::primitive primitive;
    std::unordered_map<int, dnnl::memory> arguments;
  };
  /// What comes after the calls: of a step's result, or for TransposeToPlanes of its source, these rows.
  enum class Closing { none, spread, activate, interleave, gather };
  struct Task {
    std::vector<Call> calls;
    Closing closing = Closing::none;
    int block = 0, blocks = 1;
    int row = 0, rows = 0;
    float* cells = nullptr;  ///< gather: what the calls wrote
  };
  struct Phase {
    const NetworkStep* step;
    std::vector<Task> tasks;
  };
  /// Convolution of `rows` rows from `source` with rows of zeros around them.
  struct Window {
    float* source;
    int rows, above, below, left, right;
  };

  void add(const NetworkStep& step, const Spread&);
  void add(const NetworkStep& step, const Convolve& convolve);
  void add(const NetworkStep& step, const Transpose& transpose);
  void add(const NetworkStep& step, const TransposeToPlanes& transpose);
  Call call(const NetworkKernel& kernel, const Window& window, int halvings, int stride, int block, int blocks,
            float* to, const dnnl::primitive_attr& attributes) const;

  void close(const NetworkStep& step, const Task& task);
  void spread_row(const NetworkStep& step, int row);
  void interleave_row(const NetworkStep& step, int block, int row);
  void gather_rows(const NetworkStep& step, const Task& task);
  void finish_row(const NetworkStep& step, int block, int row);

  int height(int halvings) const { return rows_ >> halvings; }
  int width(int halvings) const { return columns_ >> halvings; }
  std::size_t pixels(int halvings) const { return static_cast<std::size_t>(height(halvings)) * width(halvings); }
  /// The numbers of a block's row, where a step's result of that block goes first.
  std::span<float> raw_row(const NetworkStep& step, int block, int row);
  int blocks_of(const NetworkStep& step) const { return (step.channels + plan_.block - 1) / plan_.block; }

  const NetworkPlan& plan_;
  dnnl::engine engine_;
  int rows_, columns_;
  std::unique_ptr<float, void (*)(void*)> memory_;
  std::vector<float*> buffers_;
  float* scratch_ = nullptr;  ///< what a step writes that no other reads
  std::vector<Phase> phases_;
};

}  // namespace ensonify
