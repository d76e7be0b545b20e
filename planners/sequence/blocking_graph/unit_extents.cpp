#include "blocking_graph/unit_extents.h"

#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {

void ExtentTable::set(std::size_t unit, const Relations::Extents& extents) {
  of_unit_[unit] = extents;
  for (const auto* ends : {extents.lo, extents.hi})
    for (int k = 0; k < 3; ++k)
      if (std::isfinite(ends[k])) rounding_ = std::max(rounding_, geometry::kRounding * std::abs(ends[k]));
}

Relations::Extents ExtentTable::reach_of(std::size_t unit) const {
  Relations::Extents own = of_unit_[unit];
  for (int k = 0; k < 3; ++k) {
    own.lo[k] -= rounding_;
    own.hi[k] += rounding_;
  }
  return own;
}

Relations::Extents UnitExtents::extents_of(SubassemblyId unit, std::size_t direction) const {
  Relations::Extents all;
  for (const PartId id : state_.parts_of(unit))
    all.extend(relations_.extents_at(id, direction, state_.orientation(id), state_.pose(id).t));
  return all;
}

void UnitExtents::moved(const Subassemblies& units) {
  std::size_t parts = 0;
  for (const SubassemblyId u : units) parts += state_.parts_of(u).size();
  const bool others = arrangement_ + parts != state_.arrangement();  // near() sees that, and begins anew
  if (others) return;
  arrangement_ = state_.arrangement();
  for (std::size_t d = 0; d < tables_.size(); ++d)
    for (const SubassemblyId u : units)
      if (!tables_[d].empty()) tables_[d].set(u, extents_of(u, d));
}

Subassemblies UnitExtents::near(const Subassemblies& members, SubassemblyId unit, std::size_t direction) {
  if (arrangement_ != state_.arrangement()) {
    for (ExtentTable& table : tables_) table = {};
    arrangement_ = state_.arrangement();
  }
  ExtentTable& table = tables_[direction];
  if (table.empty()) {
    table.resize(state_.subassemblies());
    for (SubassemblyId u = 0; u < state_.subassemblies(); ++u) table.set(u, extents_of(u, direction));
  }
  const Relations::Extents reach = table.reach_of(unit);
  Subassemblies found;
  for (const SubassemblyId other : members)
    if (other != unit && table.may_meet(reach, other)) found.push_back(other);
  return found;
}

}  // namespace dismantle::blocking
