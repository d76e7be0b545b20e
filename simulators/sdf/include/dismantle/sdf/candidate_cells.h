/// Short lists of the triangles that can be closest to a point, by where the point is.
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

/// A box in single precision that holds a triangle with room for the rounding of points.
struct CandidateBox {
  float lo[3], hi[3];
};

/// A triangle that is closest to some point of a cell.
struct Candidate {
  float from_center = 0;  ///< a distance that it is not nearer to the cell's centre than
  std::uint32_t slot = 0;
  CandidateBox box{};
};

/// Candidates side by side, so that their boxes are looked at several at a time. Places that are left over are further
/// away than anything.
struct CandidateGroup {
  static constexpr int kSize = 8;
  float lo[3][kSize], hi[3][kSize];
  float from_center[kSize];
  std::uint32_t slot[kSize];

  /// Squared distances of a point from the boxes: never above those from the triangles by more than kRelative of it.
  /// The same operations in the same order whatever the width of the machine's vectors.
  using Floats = Eigen::Array<float, kSize, 1>;
  Floats squared_distances(const Eigen::Vector3f& p) const {
    Floats squared = Floats::Zero();
    for (int k = 0; k < 3; ++k) {
      const Floats outside = (Floats::Map(lo[k]) - p[k]).max(p[k] - Floats::Map(hi[k])).max(0.0F);
      squared += outside * outside;
    }
    return squared;
  }
  static constexpr double kRelative = 1e-6;  ///< eight roundings to single precision
};

/// What is known of a cell, while it is found out.
struct CandidateDraft {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double reach = 0;  ///< triangles that are not listed are further from the centre
  bool usable = true;
  std::vector<Candidate> candidates;
};

/// One cell: candidates by growing distance, or `usable` false where there would be too many. The candidates follow
/// their head in memory: a query waits for one line, not for three in a row.
class CandidateList {
 public:
  Eigen::Vector3d center;
  double reach;
  bool usable;

  std::span<const CandidateGroup> groups() const {
    return {std::launder(reinterpret_cast<const CandidateGroup*>(this + 1)), count_};
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
  /// Where the list of p's cell is kept, if its surroundings have been asked for before; brings it into the cache.
  const Place* prefetch_place(const Eigen::Vector3d& p) const {
    if (!covers(p)) return nullptr;
    const Eigen::Array3i i = cell_of(p);
    const Block* block = table_[static_cast<std::size_t>(outer_of(i))].load(std::memory_order_acquire);
    if (block == nullptr) return nullptr;
    const Place* place = &(*block)[inner_of(i)];
    __builtin_prefetch(place);
    return place;
  }
  /// Brings the list there into the cache.
  static void prefetch_list(const Place* place) {
    if (place == nullptr) return;
    const auto* list = reinterpret_cast<const char*>(place->load(std::memory_order_acquire));
    if (list == nullptr) return;
    for (std::size_t line = 0; line < kLines; ++line) __builtin_prefetch(list + line * kLine);
  }

 private:
  static constexpr int kBlock = 8;
  static constexpr std::size_t kLine = 64, kLines = 5;  // of the cache: the head and one group
  using Block = std::array<Place, kBlock * kBlock * kBlock>;
  Eigen::Array3i cell_of(const Eigen::Vector3d& p) const {
    return ((p - box_.lo) / cell_).array().floor().cast<int>().max(0).min(cells_ - 1);
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
  double cell_;
  double half_diagonal_;
  Eigen::Array3i cells_, blocks_;
  mutable std::vector<std::atomic<Block*>> table_;
};

}  // namespace dismantle::sdf
