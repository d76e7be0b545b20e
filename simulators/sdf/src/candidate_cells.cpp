#include "dismantle/sdf/candidate_cells.h"

#include <cmath>
#include <memory>
#include <type_traits>

#include "dismantle/geometry/numerics.h"

namespace dismantle::sdf {
namespace {

constexpr std::align_val_t kAligned{64};  // cache lines

}  // namespace

static_assert(sizeof(CandidateList) % alignof(Candidate) == 0);
static_assert(std::is_trivially_destructible_v<CandidateList> && std::is_trivially_copyable_v<Candidate>);

CandidateList::Owner CandidateList::pack(const CandidateDraft& draft) {
  const std::size_t n = draft.candidates.size();
  void* memory = ::operator new(sizeof(CandidateList) + n * sizeof(Candidate), kAligned);
  auto* list = new (memory) CandidateList;
  list->center = draft.center;
  list->distance = draft.distance;
  list->reach = draft.reach;
  list->usable = draft.usable;
  list->count_ = static_cast<std::uint32_t>(n);
  std::uninitialized_copy(draft.candidates.begin(), draft.candidates.end(), reinterpret_cast<Candidate*>(list + 1));
  return Owner(list);
}

void CandidateList::Free::operator()(const CandidateList* list) const {
  ::operator delete(const_cast<CandidateList*>(list), kAligned);
}

CandidateCells::CandidateCells(const Aabb& box, double cell)
    : box_(box),
      cell_(cell),
      inverse_cell_(1 / cell),
      half_diagonal_((0.5 + geometry::kRounding) * std::sqrt(3.0) * cell),
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
