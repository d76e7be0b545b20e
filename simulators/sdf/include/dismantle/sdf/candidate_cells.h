/// Short lists of the triangles that can be closest to a point, by grid cell of the point.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <vector>

#include "dismantle/aabb.h"

namespace dismantle::sdf {

/// A triangle that may be closest to a point of a cell.
struct Candidate {
  float from_center = 0;  ///< lower bound of its distance to the cell's centre
  std::uint32_t slot = 0;
};

/// A cell under construction.
struct CandidateDraft {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double distance = 0;  ///< signed, of the centre
  double reach = 0;     ///< triangles that are not listed are further from the centre than this
  bool usable = true;
  std::vector<Candidate> candidates;
};

/// One cell: candidates by ascending distance. `usable` is false if there would be too many or all are far. The
/// candidates follow this header in memory, so a query waits for one cache line instead of three.
class CandidateList {
 public:
  Eigen::Vector3d center;
  double distance;
  double reach;
  bool usable;

  /// Lower bound of the distance for a point of the cell.
  double lower_bound(const Eigen::Vector3d& p) const { return std::max(0.0, distance - (p - center).norm()); }
  std::span<const Candidate> candidates() const {
    return {std::launder(reinterpret_cast<const Candidate*>(this + 1)), count_};
  }
  struct Free {
    void operator()(const CandidateList* list) const;
  };
  using Owner = std::unique_ptr<const CandidateList, Free>;
  static Owner pack(const CandidateDraft& draft);

 private:
  CandidateList() = default;
  std::uint32_t count_;
};

/// Sparse grid of lists, created on demand and kept, since contacts return to the same places in every attempt.
/// Thread-safe: the first thread that needs a list creates it, and every thread would create the same.
class CandidateCells {
 public:
  /// `box` contains all query points.
  CandidateCells(const Aabb& box, double cell);
  ~CandidateCells();
  CandidateCells(const CandidateCells&) = delete;
  CandidateCells& operator=(const CandidateCells&) = delete;

  bool covers(const Eigen::Vector3d& p) const { return box_.contains(p); }
  double half_diagonal() const { return half_diagonal_; }

  /// The list of the cell that holds p; `make(center)` returns a CandidateDraft.
  template <class Make>
  const CandidateList& at(const Eigen::Vector3d& p, const Make& make) const {
    const Eigen::Array3i i = cell_of(p);
    Place& place = block_at(outer_of(i))[inner_of(i)];
    if (const CandidateList* list = place.load(std::memory_order_acquire)) return *list;
    CandidateList::Owner made =
        CandidateList::pack(make(Eigen::Vector3d(box_.lo + cell_ * (i.cast<double>() + 0.5).matrix())));
    const CandidateList* expected = nullptr;
    if (place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
    return *expected;
  }

  using Place = std::atomic<const CandidateList*>;
  /// Storage of the list of p's cell; nullptr if no list of its block was needed before.
  const Place* place_of(const Eigen::Vector3d& p) const {
    if (!covers(p)) return nullptr;
    const Eigen::Array3i i = cell_of(p);
    const Block* block = table_[static_cast<std::size_t>(outer_of(i))].load(std::memory_order_acquire);
    return block == nullptr ? nullptr : &(*block)[inner_of(i)];
  }
  /// Prefetches the header and the first candidates of the list at `place`; nullptr if there is none.
  static const CandidateList* prefetch_list(const Place* place) {
    const CandidateList* list = place == nullptr ? nullptr : place->load(std::memory_order_acquire);
    if (list != nullptr)
      for (std::size_t line = 0; line < kLines; ++line)
        __builtin_prefetch(reinterpret_cast<const char*>(list) + line * kLine);
    return list;
  }

 private:
  static constexpr int kBlock = 8;
  static constexpr std::size_t kLine = 64, kLines = 3;  // cache lines: the header and most lists
  using Block = std::array<Place, kBlock * kBlock * kBlock>;
  Eigen::Array3i cell_of(const Eigen::Vector3d& p) const {
    return ((p - box_.lo) * inverse_cell_).array().cast<int>().max(0).min(cells_ - 1);
  }
  int outer_of(const Eigen::Array3i& i) const {
    const Eigen::Array3i outer = i / kBlock;
    return (outer.z() * blocks_.y() + outer.y()) * blocks_.x() + outer.x();
  }
  static std::size_t inner_of(const Eigen::Array3i& i) {
    const Eigen::Array3i inner = i - i / kBlock * kBlock;
    return static_cast<std::size_t>((inner.z() * kBlock + inner.y()) * kBlock + inner.x());
  }
  Block& block_at(int index) const;

  Aabb box_;
  double cell_, inverse_cell_;
  double half_diagonal_;
  Eigen::Array3i cells_, blocks_;
  mutable std::vector<std::atomic<Block*>> table_;
};

}  // namespace dismantle::sdf
