// Compiled as C++17 (CMakeLists.txt): LEMON 1.3.1 uses members of std::allocator that C++20 removed.
#include "vision/cells/assignment.h"

#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace faba {
namespace {

constexpr double kSteps = 1 << 20;  // gains are converted to integers with this resolution

// Disjoint sets (union-find) of nodes: rows first, then columns.
class DisjointSets {
 public:
  explicit DisjointSets(int n) : parent_(std::size_t(n)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[std::size_t(i)] != i)
      i = parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
    return i;
  }
  void join(int a, int b) { parent_[std::size_t(root(a))] = root(b); }

 private:
  std::vector<int> parent_;
};

void match(const std::vector<PossiblePair>& component, int rows, std::vector<int>& of_row) {
  using Graph = lemon::SmartGraph;
  Graph graph;
  std::unordered_map<int, Graph::Node> nodes;
  const auto node = [&](int i) {
    const auto at = nodes.find(i);
    return at != nodes.end() ? at->second : nodes.emplace(i, graph.addNode()).first->second;
  };
  std::vector<Graph::Edge> edges;
  for (const PossiblePair& c : component) {
    const Graph::Node a = node(c.row), b = node(rows + c.column);
    edges.push_back(graph.addEdge(a, b));
  }
  Graph::EdgeMap<std::int64_t> weight(graph);
  for (std::size_t i = 0; i < component.size(); ++i)
    weight[edges[i]] = std::llround(component[i].gain * kSteps);
  lemon::MaxWeightedMatching<Graph, Graph::EdgeMap<std::int64_t>> matching(graph, weight);
  matching.run();
  for (std::size_t i = 0; i < component.size(); ++i)
    if (matching.matching(edges[i])) of_row[std::size_t(component[i].row)] = component[i].column;
}

}  // namespace

std::vector<int> best_assignment(int rows, int columns, const std::vector<PossiblePair>& candidates) {
  std::vector<int> of_row(std::size_t(rows), -1);
  DisjointSets components(rows + columns);
  for (const PossiblePair& c : candidates) components.join(c.row, rows + c.column);
  std::vector<std::vector<PossiblePair>> by_component;
  std::vector<int> component_of(std::size_t(rows + columns), -1);
  for (const PossiblePair& c : candidates) {
    int& component = component_of[std::size_t(components.root(c.row))];
    if (component < 0) {
      component = int(by_component.size());
      by_component.emplace_back();
    }
    by_component[std::size_t(component)].push_back(c);
  }
  for (const auto& component : by_component) {
    if (component.size() == 1)
      of_row[std::size_t(component[0].row)] = component[0].column;
    else
      match(component, rows, of_row);
  }
  return of_row;
}

}  // namespace faba
