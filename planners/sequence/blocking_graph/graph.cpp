#include "blocking_graph/graph.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dismantle::blocking {
namespace {

constexpr std::size_t kNew = std::numeric_limits<std::size_t>::max(), kDone = kNew - 1;

/// A path of components, each of which is blocked by a node of the next. A path that comes back to itself makes one
/// component of its end (Gabow 2000).
class PathOfComponents {
 public:
  PathOfComponents(std::size_t nodes, const BlockerOutside& blocker_outside)
      : position_(nodes, kNew), blocker_outside_(blocker_outside) {}

  bool visited(std::size_t node) const { return position_[node] != kNew; }

  /// Follows blockers from `root` to a component that no node outside blocks, or to a node of an earlier path, which
  /// led to one.
  std::vector<std::size_t> free_group_from(std::size_t root) {
    push(root);
    while (true) {
      const auto to = next();
      if (!to || position_[*to] == kDone) return finish(!to);
      if (position_[*to] == kNew)
        push(*to);
      else
        merge(position_[*to]);
    }
  }

 private:
  struct Component {
    std::vector<std::size_t> members, open;  // open: members that a node outside may block
  };

  void push(std::size_t node) {
    position_[node] = path_.size();
    path_.push_back({{node}, {node}});
  }

  std::optional<std::size_t> next() {
    auto& open = path_.back().open;
    const auto inside = [&](std::size_t node) { return position_[node] == path_.size() - 1; };
    for (; !open.empty(); open.pop_back())
      if (const auto to = blocker_outside_(open.back(), inside)) return to;
    return std::nullopt;
  }

  void merge(std::size_t first) {
    Component& into = path_[first];
    for (std::size_t k = first + 1; k < path_.size(); ++k) {
      for (const std::size_t node : path_[k].members) position_[node] = first;
      into.members.insert(into.members.end(), path_[k].members.begin(), path_[k].members.end());
      into.open.insert(into.open.end(), path_[k].open.begin(), path_[k].open.end());
    }
    path_.resize(first + 1);
  }

  /// All components before the last lead to it, so they are not free.
  std::vector<std::size_t> finish(bool last_is_free) {
    std::vector<std::size_t> group;
    if (last_is_free) group = std::move(path_.back().members);
    for (const std::size_t node : group) position_[node] = kDone;
    for (const Component& c : path_)
      for (const std::size_t node : c.members) position_[node] = kDone;
    path_.clear();
    return group;
  }

  std::vector<std::size_t> position_;  // by node: in path_, kNew or kDone
  std::vector<Component> path_;
  const BlockerOutside& blocker_outside_;
};

}  // namespace

std::vector<std::vector<std::size_t>> free_groups(std::size_t nodes, const BlockerOutside& blocker_outside) {
  PathOfComponents path(nodes, blocker_outside);
  std::vector<std::vector<std::size_t>> free;
  for (std::size_t root = 0; root < nodes; ++root) {
    if (path.visited(root)) continue;
    auto group = path.free_group_from(root);
    if (group.empty() || group.size() == nodes) continue;
    std::sort(group.begin(), group.end());
    free.push_back(std::move(group));
  }
  std::sort(free.begin(), free.end());
  return free;
}

}  // namespace dismantle::blocking
