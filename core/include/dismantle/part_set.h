/// Lists of parts, in ascending order unless stated otherwise.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "dismantle/simulator.h"

namespace dismantle {

/// True if `part` is in the list, which may have any order.
inline bool contains(std::span<const PartId> parts, PartId part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}
/// True if `part` is one of the placed parts.
inline bool contains(std::span<const PlacedPart> parts, PartId part) {
  return std::any_of(parts.begin(), parts.end(), [part](const PlacedPart& p) { return p.part == part; });
}
/// The parts without those in `gone`, in the same order.
inline std::vector<PartId> without(std::span<const PartId> parts, std::span<const PartId> gone) {
  std::vector<PartId> rest;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(rest), [&](PartId id) { return !contains(gone, id); });
  return rest;
}
/// The placed parts without those in `gone`, in the same order.
inline std::vector<PlacedPart> without(std::span<const PlacedPart> parts, std::span<const PlacedPart> gone) {
  std::vector<PlacedPart> rest;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(rest),
               [&](const PlacedPart& p) { return !contains(gone, p.part); });
  return rest;
}
/// The numbers of placed parts, in the same order.
inline std::vector<PartId> ids_of(std::span<const PlacedPart> parts) {
  std::vector<PartId> ids;
  ids.reserve(parts.size());
  for (const PlacedPart& p : parts) ids.push_back(p.part);
  return ids;
}

}  // namespace dismantle
