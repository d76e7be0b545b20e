/// Which subassemblies may be in the way of one: by their extents along and across a direction, kept while parts leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blocking_graph/relations.h"
#include "blocking_graph/state.h"

namespace dismantle::blocking {

/// Extents of units along one direction and two across it, in the assembly's frame.
class ExtentTable {
 public:
  void resize(std::size_t units) { of_unit_.resize(units); }
  bool empty() const { return of_unit_.empty(); }
  void set(std::size_t unit, const Relations::Extents& extents);
  /// Those of `unit`, larger by what rounding may hide.
  Relations::Extents reach_of(std::size_t unit) const;
  /// False: the unit with that reach, translated along the direction, passes the other one at a distance.
  bool may_meet(const Relations::Extents& reach, std::size_t other) const {
    const Relations::Extents& its = of_unit_[other];
    return its.hi[0] > reach.lo[0] && its.hi[1] > reach.lo[1] && its.lo[1] < reach.hi[1] && its.hi[2] > reach.lo[2] &&
           its.lo[2] < reach.hi[2];
  }

 private:
  std::vector<Relations::Extents> of_unit_;
  double rounding_ = 0;
};

/// A filter before Relations::far(): one pass over a list of numbers, no pair is made for what is far away.
class UnitExtents {
 public:
  /// Both must outlive this.
  UnitExtents(const DisassemblyState& state, const Relations& relations, std::size_t directions)
      : state_(state), relations_(relations), tables_(directions) {}

  /// The `members` of which some part may not be Relations::far() from one of `unit`, in their order, without `unit`.
  /// Some of them are.
  Subassemblies near(const Subassemblies& members, SubassemblyId unit, std::size_t direction);
  /// To be called when parts have moved, with those that have: the others keep their extents.
  void moved(const Subassemblies& units);

 private:
  Relations::Extents extents_of(SubassemblyId unit, std::size_t direction) const;

  const DisassemblyState& state_;
  const Relations& relations_;
  std::vector<ExtentTable> tables_;  // by direction; filled when first asked for
  std::uint64_t arrangement_ = 0;
};

}  // namespace dismantle::blocking
