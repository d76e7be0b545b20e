#include "blocking_graph/graph.h"

#include <algorithm>
#include <limits>

namespace dismantle::blocking {

std::vector<std::vector<std::size_t>> strong_components(const std::vector<std::vector<std::size_t>>& in_way) {
  const std::size_t never = std::numeric_limits<std::size_t>::max();
  const std::size_t n = in_way.size();
  std::vector<std::size_t> number(n, never), low(n, 0), stack;
  std::vector<bool> on_stack(n, false);
  std::vector<std::vector<std::size_t>> components;
  struct Visit {
    std::size_t node, next;
  };
  std::size_t count = 0;
  for (std::size_t root = 0; root < n; ++root) {
    if (number[root] != never) continue;
    std::vector<Visit> visits{{root, 0}};
    while (!visits.empty()) {
      auto& [node, next] = visits.back();
      if (next == 0 && number[node] == never) {
        number[node] = low[node] = count++;
        stack.push_back(node);
        on_stack[node] = true;
      }
      if (next < in_way[node].size()) {
        const std::size_t to = in_way[node][next++];
        if (number[to] == never)
          visits.push_back({to, 0});
        else if (on_stack[to])
          low[node] = std::min(low[node], number[to]);
        continue;
      }
      const std::size_t done = node;
      visits.pop_back();
      if (!visits.empty()) low[visits.back().node] = std::min(low[visits.back().node], low[done]);
      if (low[done] != number[done]) continue;
      components.emplace_back();
      std::size_t member = never;
      do {
        member = stack.back();
        stack.pop_back();
        on_stack[member] = false;
        components.back().push_back(member);
      } while (member != done);
      std::sort(components.back().begin(), components.back().end());
    }
  }
  return components;
}

std::vector<std::vector<std::size_t>> free_groups(const std::vector<std::vector<std::size_t>>& in_way) {
  auto components = strong_components(in_way);
  if (components.size() <= 1) return {};
  std::vector<std::size_t> component(in_way.size());
  for (std::size_t c = 0; c < components.size(); ++c)
    for (const std::size_t i : components[c]) component[i] = c;
  std::vector<std::vector<std::size_t>> free;
  for (std::size_t c = 0; c < components.size(); ++c) {
    const bool blocked = std::any_of(components[c].begin(), components[c].end(), [&](std::size_t i) {
      return std::any_of(in_way[i].begin(), in_way[i].end(), [&](std::size_t j) { return component[j] != c; });
    });
    if (!blocked) free.push_back(components[c]);
  }
  return free;
}

}  // namespace dismantle::blocking
