/// Which parts hold together without gravity.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/statics/contacts.h"

namespace dismantle::statics {

/// Bonds of one assembly. A screw or nut holds what its thread is in, and nothing else: a bolt that is only put through
/// a bore falls out when it is turned upside down.
class Bonds {
 public:
  /// Keeps the assembly. Fasteners are those of Part::kind.
  explicit Bonds(const Assembly& assembly);
  /// None: the pair does not hold together without gravity. Otherwise it is pressed, clipped or screwed, and its
  /// surfaces may lie so deep in each other, or so far apart: a thread and its hole are drawn with any diameters
  /// between those of the crests and of the roots. `gap`: an overlap of that depth is still touching. Assembly units.
  std::optional<double> depth(PartId a, PartId b, double gap) const;
  /// Parts that are one body as soon as all of them are there: a screw, what it is driven into, and what it presses
  /// between its head and the thread.
  const std::vector<std::vector<PartId>>& clamped() const { return clamped_; }

 private:
  void add_threads();

  const Assembly& assembly_;
  std::vector<bool> screwed_;                            // screws of which it is known what they are driven into
  std::map<std::pair<PartId, PartId>, double> threads_;  // the depth, by the smaller id and the larger one
  std::vector<std::vector<PartId>> clamped_;
};

/// contacts_between() with regions that are narrower than the gap, as the facets of a thread are.
std::vector<Contact> contacts_with_rims(const PlacedShape& a, const PlacedShape& b, double touching);
/// Contacts of a pair that is bonded by depth(), or of one that is not.
std::vector<Contact> pair_contacts(const PlacedShape& a, const PlacedShape& b, double touching,
                                   const std::optional<double>& bond);

}  // namespace dismantle::statics
