/// Short lists of the triangles that can be closest to a point, by where the point is.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "dismantle/aabb.h"

namespace dismantle::sdf {

/// A triangle that is closest to some point of a cell.
struct Candidate {
  float from_center = 0;  ///< a distance that it is not nearer to the cell's centre than
  std::uint32_t slot = 0;
  float lo[3], hi[3];  ///< a box that holds it

  double squared_distance(const Eigen::Vector3d& p) const {  ///< to the box
    double squared = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = std::max(std::max(lo[k] - p[k], p[k] - hi[k]), 0.0);
      squared += d * d;
    }
    return squared;
  }
};

/// One cell: candidates by growing distance, or `usable` false where there would be too many.
struct CandidateList {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double reach = 0;  ///< triangles that are not listed are further from the centre
  bool usable = true;
  std::vector<Candidate> candidates;
};

/// Sparse grid of lists, made when they are first asked for and kept: contacts return to the same places again and
/// again, in every attempt. Thread-safe; whoever comes first makes a list, and every maker makes the same.
class CandidateCells {
 public:
  /// `box` holds all points that are asked for.
  CandidateCells(const Aabb& box, double cell);
  ~CandidateCells();
  CandidateCells(const CandidateCells&) = delete;
  CandidateCells& operator=(const CandidateCells&) = delete;

  bool covers(const Eigen::Vector3d& p) const { return box_.contains(p); }
  double half_diagonal() const { return half_diagonal_; }

  /// The list of the cell that holds p; `make(center)` returns a CandidateList.
  template <class Make>
  const CandidateList& at(const Eigen::Vector3d& p, const Make& make) const {
    const Eigen::Array3i i = ((p - box_.lo) / cell_).array().floor().cast<int>().max(0).min(cells_ - 1);
    const Eigen::Array3i outer = i / kBlock, inner = i - outer * kBlock;
    Block& block = block_at((outer.z() * blocks_.y() + outer.y()) * blocks_.x() + outer.x());
    auto& place = block[static_cast<std::size_t>((inner.z() * kBlock + inner.y()) * kBlock + inner.x())];
    if (const CandidateList* list = place.load(std::memory_order_acquire)) return *list;
    auto made = std::make_unique<const CandidateList>(
        make(Eigen::Vector3d(box_.lo + cell_ * (i.cast<double>() + 0.5).matrix())));
    const CandidateList* expected = nullptr;
    if (place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
    return *expected;
  }

 private:
  static constexpr int kBlock = 8;
  using Block = std::array<std::atomic<const CandidateList*>, kBlock * kBlock * kBlock>;
  Block& block_at(int index) const;

  Aabb box_;
  double cell_;
  double half_diagonal_;
  Eigen::Array3i cells_, blocks_;
  mutable std::vector<std::atomic<Block*>> table_;
};

}  // namespace dismantle::sdf
