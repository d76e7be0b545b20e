#include "bonds.h"

#include <algorithm>

namespace dismantle::statics {

bool is_fastener(const Part& part) { return part.kind && (part.kind->kind == "screw" || part.kind->kind == "nut"); }

bool is_bonded(const Assembly& assembly, PartId a, PartId b, double gap) {
  if (const InitialOverlap* o = assembly.overlap_of(a, b); o != nullptr && o->place) {
    const ContactClass contact = o->place->contact;
    if (contact == ContactClass::uniform_interference && o->place->axis) return true;  // around an axis
    if (o->depth > gap && contact != ContactClass::clearance && contact != ContactClass::kissing) return true;
  }
  return is_fastener(assembly.parts[a]) || is_fastener(assembly.parts[b]);
}

std::vector<Contact> pair_contacts(const PlacedShape& a, const PlacedShape& b, double touching, bool bonded,
                                   double overlap) {
  std::vector<Contact> found = contacts_between(a, b, touching);
  if (!found.empty() || !bonded) return found;
  constexpr double kThreadPlay = 5;  // times the gap of other contacts
  const double depth = overlap / std::min(a.shape->radius(), b.shape->radius());
  return contacts_between(a, b, std::max(kThreadPlay * touching, 1.1 * depth));
}

}  // namespace dismantle::statics
