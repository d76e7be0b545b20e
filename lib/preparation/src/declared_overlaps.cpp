#include "dismantle/preparation/declared_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/preparation/flexible_parts.h"

namespace dismantle {

namespace {

PartId part_of(const Assembly& assembly, const std::string& name) {
  for (const Part& part : assembly.parts)
    if (part.name == name) return part.id;
  throw InputError(assembly.source, fmt::format("has no part '{}', for which an overlap is declared", name));
}

/// The entry of a pair, created if missing.
InitialOverlap& entry_of(Assembly& assembly, PartId a, PartId b) {
  if (a > b) std::swap(a, b);
  const auto at = std::lower_bound(
      assembly.overlaps.begin(), assembly.overlaps.end(), std::pair(a, b),
      [](const InitialOverlap& o, const std::pair<PartId, PartId>& pair) { return std::pair(o.a, o.b) < pair; });
  if (at != assembly.overlaps.end() && at->a == a && at->b == b) return *at;
  return *assembly.overlaps.insert(at, {a, b, 0});
}

}  // namespace

void declare_overlap(Assembly& assembly, const std::string& a, const std::string& b, double depth) {
  const PartId first = part_of(assembly, a), second = part_of(assembly, b);
  if (first == second) throw InputError(assembly.source, fmt::format("an overlap of '{}' with itself is declared", a));
  entry_of(assembly, first, second).declared = depth;
}

void declare_flexible(Assembly& assembly, const std::string& part) {
  const PartId id = part_of(assembly, part);
  const double thickness = flexible_depth(assembly.parts[id]);
  for (const Part& other : assembly.parts) {
    if (other.id == id) continue;
    InitialOverlap& pair = entry_of(assembly, id, other.id);
    pair.declared = std::max(pair.allowed(), thickness);
  }
}

}  // namespace dismantle
