#include "dismantle/sdf/candidate_cells.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace dismantle::sdf {
namespace {

constexpr std::align_val_t kAligned{64};  // to the lines of the cache

}  // namespace

static_assert(sizeof(CandidateList) % alignof(CandidateGroup) == 0);
static_assert(std::is_trivially_destructible_v<CandidateList> && std::is_trivially_destructible_v<CandidateGroup>);

CandidateList::Owner CandidateList::pack(const CandidateDraft& draft) {
  constexpr std::size_t kSize{CandidateGroup::kSize};
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const std::size_t n = (draft.candidates.size() + kSize - 1) / kSize;
  void* memory = ::operator new(sizeof(CandidateList) + n * sizeof(CandidateGroup), kAligned);
  auto* list = new (memory) CandidateList;
  list->center = draft.center;
  list->reach = draft.reach;
  list->usable = draft.usable;
  list->count_ = static_cast<std::uint32_t>(n);
  auto* groups = reinterpret_cast<CandidateGroup*>(list + 1);
  for (std::size_t g = 0; g < n; ++g) {
    auto* group = new (groups + g) CandidateGroup;
    for (std::size_t i = 0; i < kSize; ++i) {
      const std::size_t at = g * kSize + i;
      const bool filled = at < draft.candidates.size();
      const Candidate candidate = filled ? draft.candidates[at] : Candidate{kNever, 0, {}};
      group->from_center[i] = candidate.from_center;
      group->slot[i] = candidate.slot;
      for (std::size_t k = 0; k < 3; ++k) {
        group->lo[k][i] = filled ? candidate.box.lo[k] : kNever;
        group->hi[k][i] = filled ? candidate.box.hi[k] : -kNever;
      }
    }
  }
  return Owner(list);
}

void CandidateList::Free::operator()(const CandidateList* list) const {
  ::operator delete(const_cast<CandidateList*>(list), kAligned);
}

CandidateCells::CandidateCells(const Aabb& box, double cell)
    : box_(box),
      cell_(cell),
      half_diagonal_(0.5 * std::sqrt(3.0) * cell),
      cells_((box.size() / cell).array().ceil().cast<int>().max(1)),
      blocks_((cells_ + kBlock - 1) / kBlock),
      table_(static_cast<std::size_t>(blocks_.prod())) {}

CandidateCells::~CandidateCells() {
  for (auto& entry : table_) {
    const std::unique_ptr<Block> block(entry.load());
    if (!block) continue;
    for (auto& list : *block) CandidateList::Owner(list.load());
  }
}

CandidateCells::Block& CandidateCells::block_at(int index) const {
  auto& place = table_[static_cast<std::size_t>(index)];
  if (Block* block = place.load(std::memory_order_acquire)) return *block;
  auto made = std::make_unique<Block>();
  for (auto& list : *made) list.store(nullptr, std::memory_order_relaxed);
  Block* expected = nullptr;
  if (place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
  return *expected;
}

}  // namespace dismantle::sdf
