/// The user's constraints on the order of a disassembly.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle {

/// A forced step that the user accepts: `part` may cut into `against`, or that into it, up to this depth.
struct AcceptedForce {
  PartId part = 0, against = 0;
  std::string as;    ///< what it is: "snap", "press", ...
  double depth = 0;  ///< assembly units, > 0
};

/// Parts by id; the lists are in no particular order.
struct Constraints {
  std::vector<PartId> base;                       ///< never moved, except with everything else
  std::vector<std::vector<PartId>> together;      ///< each of these moves as one and is not taken apart
  std::vector<std::pair<PartId, PartId>> before;  ///< (a, b): b leaves only after a has left
  std::vector<AcceptedForce> accept{};            ///< no constraint on the order
  std::optional<PartId> target;                   ///< done as soon as this part is out; with as little work as is known
  bool empty() const { return base.empty() && together.empty() && before.empty() && !target; }
};

/// By part, for `parts` parts: a representative of the set of parts that are kept together with it. Lists of `together`
/// that share a part form one set.
DISMANTLE_API std::vector<PartId> kept_sets(std::size_t parts, const Constraints& constraints);
/// Sets Part::unit of all parts.
DISMANTLE_API void set_units(Assembly& assembly, const Constraints& constraints);
/// True for one part, or for parts of one set that is kept together: such a group is not taken apart.
DISMANTLE_API bool kept_together(std::span<const PartId> group, const Constraints& constraints);
/// Do `base` and `before` let these parts leave the rest of their group?
DISMANTLE_API bool may_leave(std::span<const PartId> leaving, std::span<const PartId> rest,
                             const Constraints& constraints);

}  // namespace dismantle
