/// Which boxes of a fixed list overlap another box, without a look at each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle::geometry {

/// A tree of boxes. Immutable, so it may be asked by several threads.
class DISMANTLE_API BoxIndex {
 public:
  explicit BoxIndex(std::vector<Aabb> boxes);

  const Aabb& box(std::size_t i) const { return boxes_[i]; }
  /// Indices of the boxes that overlap `box`, ascending: those of Aabb::overlaps(). `looked_at`, if given, grows by the
  /// number of boxes that were compared.
  std::vector<std::size_t> overlapping(const Aabb& box, std::uint64_t* looked_at = nullptr) const;

 private:
  struct Node {
    Aabb box;
    std::size_t begin = 0, end = 0;     // of order_
    std::size_t first = 0, second = 0;  // children; 0: a leaf
  };
  std::size_t build(std::size_t begin, std::size_t end);

  std::vector<Aabb> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

/// By PartId; of the parts as assembled.
DISMANTLE_API BoxIndex index_of_parts(const Assembly& assembly);

}  // namespace dismantle::geometry
