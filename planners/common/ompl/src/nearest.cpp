#include "dismantle/ompl/nearest.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace dismantle::sampling {

struct NearestNodes::Search {
  Eigen::Vector3d point;
  const std::function<double(std::uint32_t)>& metric;
  std::size_t count = 1;
  std::vector<std::pair<double, std::uint32_t>> best{};  ///< ascending, at most `count`

  /// No point further than this can be among the best.
  double reach() const { return best.size() < count ? std::numeric_limits<double>::infinity() : best.back().first; }
  void add(std::uint32_t label) {
    const std::pair entry(metric(label), label);
    if (best.size() == count) {
      if (entry >= best.back()) return;
      best.pop_back();
    }
    best.insert(std::upper_bound(best.begin(), best.end(), entry), entry);
  }
};

std::uint32_t NearestNodes::add(const Eigen::Vector3d& point) {
  const auto label = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  removed_.push_back(false);
  Tree carry{label};
  std::size_t level = 0;
  for (; level < forest_.size() && !forest_[level].empty(); ++level) {
    carry.insert(carry.end(), forest_[level].begin(), forest_[level].end());
    forest_[level].clear();
  }
  if (level == forest_.size()) forest_.emplace_back();
  build(carry, 0, carry.size(), 0);
  forest_[level] = std::move(carry);
  return label;
}

void NearestNodes::build(Tree& tree, std::size_t first, std::size_t last, int axis) const {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [&](std::size_t i) { return tree.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis] : a < b;
  });
  build(tree, first, middle, (axis + 1) % 3);
  build(tree, middle + 1, last, (axis + 1) % 3);
}

void NearestNodes::visit(const Tree& tree, std::size_t first, std::size_t last, int axis, Search& search) const {
  if (first >= last) return;
  const std::size_t middle = first + (last - first) / 2;
  const std::uint32_t label = tree[middle];
  const double off = search.point[axis] - points_[label][axis];
  const int next = (axis + 1) % 3;
  if (off < 0)
    visit(tree, first, middle, next, search);
  else
    visit(tree, middle + 1, last, next, search);
  if (!removed_[label] && (points_[label] - search.point).norm() <= search.reach()) search.add(label);
  if (std::abs(off) > search.reach()) return;
  if (off < 0)
    visit(tree, middle + 1, last, next, search);
  else
    visit(tree, first, middle, next, search);
}

std::uint32_t NearestNodes::nearest(const Eigen::Vector3d& point,
                                    const std::function<double(std::uint32_t)>& metric) const {
  const auto labels = nearest(point, metric, 1);
  return labels.empty() ? geometry::kNoIndex : labels.front();
}

std::vector<std::uint32_t> NearestNodes::nearest(const Eigen::Vector3d& point,
                                                 const std::function<double(std::uint32_t)>& metric,
                                                 std::size_t count) const {
  std::vector<std::uint32_t> labels;
  if (count == 0) return labels;
  Search search{point, metric, count};
  for (auto tree = forest_.rbegin(); tree != forest_.rend(); ++tree) visit(*tree, 0, tree->size(), 0, search);
  for (const auto& [metric_of, label] : search.best) labels.push_back(label);
  return labels;
}

}  // namespace dismantle::sampling
