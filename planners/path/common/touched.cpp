#include "dismantle/path/touched.h"

#include <algorithm>

#include "dismantle/search/placed_parts.h"

namespace dismantle::path {

std::vector<PartId> most_touched(const std::map<PartId, std::uint64_t>& touched,
                                 const std::vector<PlacedPart>& moving) {
  std::vector<PartId> parts;
  for (const auto& [part, times] : touched)
    if (!contains(moving, part)) parts.push_back(part);
  std::stable_sort(parts.begin(), parts.end(), [&](PartId a, PartId b) { return touched.at(a) > touched.at(b); });
  return parts;
}

std::vector<PartId> touched_parts(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving,
                                  double distance) {
  std::vector<PartId> parts;
  for (const Contact& c : contacts)
    if (c.depth > -distance && !contains(moving, c.other)) parts.push_back(c.other);
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

}  // namespace dismantle::path
