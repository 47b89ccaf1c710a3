#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <map>
#include <memory>
#include <mutex>
#include <oneapi/dnnl/dnnl.hpp>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ensonify/filters/network_plan.hpp"

namespace ensonify {

/// A plan and its weights in the orders that oneDNN wants them, put so once for all workspaces.
class NetworkWeights {
 public:
  explicit NetworkWeights(NetworkPlan plan) : plan_(std::move(plan)) {}

  const NetworkPlan& plan() const { return plan_; }
  const dnnl::engine& engine() const { return engine_; }
  /// Any number of threads may ask at once.
  dnnl::memory ordered(const NetworkKernel& kernel, const dnnl::memory::desc& order) const;

 private:
  NetworkPlan plan_;
  dnnl::engine engine_{dnnl::engine::kind::cpu, 0};
  mutable std::mutex mutex_;
  mutable std::multimap<const NetworkKernel*, dnnl::memory> ordered_;
};

/// Memory and compiled convolutions of a network for images of one size. One image at a time. How the work is cut into
/// tasks follows from the size alone, and oneDNN computes each of them on one thread: so the bits do not depend on the
/// number of threads, and OpenMP, which would not survive a fork, never starts one.
class NetworkWorkspace {
 public:
  /// Both sides: multiples of 2^halvings. `weights` must outlive this. Throws DataError: more memory than there is;
  /// dnnl::error.
  NetworkWorkspace(const NetworkWeights& weights, int rows, int columns);

  int rows() const { return rows_; }
  int columns() const { return columns_; }

  /// Row by row, as the network takes it.
  std::span<float> image() { return {buffers_[image_buffer], pixels(0)}; }
  /// From the image, on the threads of the current oneTBB arena.
  void run();
  /// [row][column][channel].
  std::span<const float> output() const {
    return {buffers_[output_buffer], pixels(0) * weights_.plan().buffers[output_buffer].channels};
  }

 private:
  /// Some rows of a step's result: a convolution to `raw`, and from there to the sinks.
  struct Task {
    const NetworkStep* step = nullptr;
    int row = 0, rows = 0;  ///< of Transpose: of its grid
    dnnl::primitive convolution{};
    std::unordered_map<int, dnnl::memory> arguments{};
  };

  /// What a step needs for a row of its result (of its grid), in numbers.
  std::size_t raw_row(const NetworkStep& step) const;
  /// Numbers of a row of the result.
  std::size_t result_row(const NetworkStep& step) const;
  /// Rows of the result (of the grid), and how many of them a task has.
  std::pair<int, int> rows_of(const NetworkStep& step) const;

  std::vector<Task> tasks_of(const NetworkStep& step) const;
  void compile(Task&, const Copy&) const {}
  void compile(Task& task, const Convolve& convolve) const;
  void compile(Task& task, const Transpose& transpose) const;
  void compile(Task& task, const NetworkKernel& kernel, int first_row, int end_row, int stride, int pad) const;

  void run(Task& task);
  void write_row(const NetworkStep& step, int row, std::span<float> activated, const auto& place);

  int height(int halvings) const { return rows_ >> halvings; }
  int width(int halvings) const { return columns_ >> halvings; }
  std::size_t pixels(int halvings) const { return static_cast<std::size_t>(height(halvings)) * width(halvings); }

  const NetworkWeights& weights_;
  int rows_, columns_;
  std::unique_ptr<float, void (*)(void*)> memory_;
  std::vector<float*> buffers_;
  std::vector<std::vector<Task>> steps_;
  tbb::enumerable_thread_specific<std::vector<float>> scratch_;  ///< a task's result, then a row of it
};

}  // namespace ensonify
