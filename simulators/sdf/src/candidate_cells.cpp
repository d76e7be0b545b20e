#include "dismantle/sdf/candidate_cells.h"

#include <cmath>

namespace dismantle::sdf {

CandidateCells::CandidateCells(const Aabb& box, double cell)
    : box_(box), cell_(cell), half_diagonal_(0.5 * std::sqrt(3.0) * cell),
      cells_((box.size() / cell).array().ceil().cast<int>().max(1)), blocks_((cells_ + kBlock - 1) / kBlock),
      table_(static_cast<std::size_t>(blocks_.prod())) {}

CandidateCells::~CandidateCells() {
  for (auto& entry : table_) {
    const std::unique_ptr<Block> block(entry.load());
    if (!block) continue;
    for (auto& list : *block) delete list.load();
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
