#include "ensonify/filters/network.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "ensonify/core/error.hpp"
#include "ensonify/filters/network_workspace.hpp"
#include "ensonify/filters/onnx_rules.hpp"

namespace ensonify {

struct Network::State {
  explicit State(const OnnxFile& file) : needs(check_network(file)), weights(plan_network(file)) {}

  using Workspace = std::unique_ptr<NetworkWorkspace>;

  Workspace take(int rows, int columns) {
    {
      const std::lock_guard lock(mutex);
      const auto fits = [&](const Workspace& w) { return w->rows() == rows && w->columns() == columns; };
      const auto found = std::ranges::find_if(idle, fits);
      if (found != idle.end()) {
        Workspace workspace = std::move(*found);
        idle.erase(found);
        return workspace;
      }
      // Room for the new one: those of other sizes, longest idle first, where every thread could have had one.
      if (idle.size() >= static_cast<std::size_t>(tbb::this_task_arena::max_concurrency())) idle.erase(idle.begin());
    }
    return std::make_unique<NetworkWorkspace>(weights, rows, columns);
  }
  void give_back(Workspace workspace) {
    const std::lock_guard lock(mutex);
    idle.push_back(std::move(workspace));
  }

  OnnxNeeds needs;
  NetworkWeights weights;
  std::mutex mutex;
  std::vector<Workspace> idle;
};

Network::Network(const OnnxFile& file) : state_(std::make_unique<State>(file)) {}
Network::~Network() = default;
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;

int Network::multiple() const { return state_->needs.multiple; }
int Network::heads() const { return state_->needs.heads; }

std::vector<Image2<float>> Network::run(const Image2<float>& image) const {
  if (image.empty() || image.rows() % multiple() != 0 || image.columns() % multiple() != 0) {
    throw DataError(fmt::format("the sides of an image must be multiples of {}, not {} x {}", multiple(), image.rows(),
                                image.columns()));
  }
  try {
    State::Workspace workspace = state_->take(image.rows(), image.columns());
    std::ranges::copy(image.pixels(), workspace->image().begin());
    // Isolated: a thread that waits for a layer must not begin another image.
    tbb::this_task_arena::isolate([&] { workspace->run(); });
    const std::span<const float> output = workspace->output();
    const std::size_t count = static_cast<std::size_t>(this->heads());
    std::vector<Image2<float>> heads(count, Image2<float>(image.rows(), image.columns()));
    for (std::size_t head = 0; head < count; ++head) {
      const std::span<float> plane = heads[head].pixels();
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = output[i * count + head];
    }
    state_->give_back(std::move(workspace));
    return heads;
  } catch (const std::bad_alloc&) {
    throw DataError(fmt::format("no memory for an image of {} x {}", image.rows(), image.columns()));
  } catch (const dnnl::error& e) {
    throw DataError(fmt::format("oneDNN does not run it on {} x {} ({})", image.rows(), image.columns(), e.what()));
  }
}

}  // namespace ensonify
