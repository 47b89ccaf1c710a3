#include "ensonify/scenes/node_graph.hpp"

#include <algorithm>

namespace ensonify {
namespace {

constexpr std::size_t max_nodes = 100'000;
constexpr std::size_t max_depth = 500;

enum class State { unseen, open, done };

struct Unfolded {
  State state = State::unseen;
  std::size_t nodes = 1;
  std::size_t depth = 1;
  std::size_t next_child = 0;
};

}  // namespace

std::string node_graph_fault(const std::vector<std::vector<std::size_t>>& children) {
  std::vector<Unfolded> info(children.size());
  std::vector<std::size_t> path;  // an explicit stack: the depth is the file's choice
  for (std::size_t start = 0; start < children.size(); ++start) {
    if (info[start].state != State::unseen) continue;
    path.push_back(start);
    while (!path.empty()) {
      const std::size_t here = path.back();
      info[here].state = State::open;
      if (info[here].next_child < children[here].size()) {
        const std::size_t child = children[here][info[here].next_child];
        if (child >= children.size() || info[child].state == State::done) {
          ++info[here].next_child;
          if (child >= children.size()) continue;
          info[here].nodes += info[child].nodes;
          info[here].depth = std::max(info[here].depth, info[child].depth + 1);
          if (info[here].nodes > max_nodes) return "its nodes multiply to more than 100000";
          if (info[here].depth > max_depth) return "its nodes nest more than 500 deep";
        } else if (info[child].state == State::open) {
          return "a node contains itself";
        } else {
          path.push_back(child);
        }
      } else {
        info[here].state = State::done;
        path.pop_back();
      }
    }
  }
  return {};
}

}  // namespace ensonify
