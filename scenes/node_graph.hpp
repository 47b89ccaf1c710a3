#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ensonify {

/// Why a scene graph can not be unfolded into a tree: a node contains itself, the tree would have more than 100 000
/// nodes, or is more than 500 deep. Empty if it can. `children[i]` are indices of nodes; those out of range are
/// ignored.
std::string node_graph_fault(const std::vector<std::vector<std::size_t>>& children);

}  // namespace ensonify
