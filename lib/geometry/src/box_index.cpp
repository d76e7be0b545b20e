#include "dismantle/geometry/box_index.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace dismantle::geometry {

namespace {

constexpr std::size_t kBoxesOfLeaf = 4;  // below, a comparison of each costs less than more nodes

}  // namespace

BoxIndex::BoxIndex(std::vector<Aabb> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  // An empty box overlaps nothing, and has no centre.
  std::erase_if(order_, [&](std::size_t i) { return boxes_[i].empty(); });
  nodes_.reserve(order_.size());
  if (!order_.empty()) build(0, order_.size());
}

/// Divides at the median along the longest edge, so that the depth is logarithmic.
std::size_t BoxIndex::build(std::size_t begin, std::size_t end) {
  const std::size_t at = nodes_.size();
  nodes_.push_back({{}, begin, end});
  for (std::size_t k = begin; k < end; ++k) nodes_[at].box.extend(boxes_[order_[k]]);
  if (end - begin <= kBoxesOfLeaf) return at;
  int axis = 0;
  nodes_[at].box.size().maxCoeff(&axis);
  const auto key = [&](std::size_t i) { return std::pair(boxes_[i].lo[axis] + boxes_[i].hi[axis], i); };
  const std::size_t middle = begin + (end - begin) / 2;
  const auto place = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(place(begin), place(middle), place(end),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  const std::size_t first = build(begin, middle), second = build(middle, end);
  nodes_[at].first = first;
  nodes_[at].second = second;
  return at;
}

std::vector<std::size_t> BoxIndex::overlapping(const Aabb& box, std::uint64_t* looked_at) const {
  std::vector<std::size_t> found, open;
  std::uint64_t compared = 0;
  if (!nodes_.empty()) open.push_back(0);
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    ++compared;
    if (!node.box.overlaps(box)) continue;
    if (node.second != 0) {
      open.push_back(node.first);
      open.push_back(node.second);
      continue;
    }
    for (std::size_t k = node.begin; k < node.end; ++k, ++compared)
      if (boxes_[order_[k]].overlaps(box)) found.push_back(order_[k]);
  }
  std::sort(found.begin(), found.end());
  if (looked_at != nullptr) *looked_at += compared;
  return found;
}

BoxIndex index_of_parts(const Assembly& assembly) {
  std::vector<Aabb> boxes;
  for (const Part& part : assembly.parts) boxes.push_back(part.mesh->box());
  return BoxIndex(std::move(boxes));
}

}  // namespace dismantle::geometry
