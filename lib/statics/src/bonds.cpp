#include "bonds.h"

#include <algorithm>
#include <filesystem>
#include <string>

namespace dismantle::statics {
namespace {

bool is_of_ldraw(const Part& part) {
  const std::string extension = std::filesystem::path(part.file).extension().string();
  return extension == ".mpd" || extension == ".ldr" || extension == ".dat";
}

/// Parts of LDraw models hold each other by studs, pins and clips, which are drawn without interference. Two are
/// coupled where one reaches into the other: their boxes share more than what touches.
bool is_coupled(const Part& a, const Part& b, double gap) {
  if (!is_of_ldraw(a) || !is_of_ldraw(b)) return false;
  const Aabb x = a.mesh->box(), y = b.mesh->box();
  return (x.hi.cwiseMin(y.hi) - x.lo.cwiseMax(y.lo)).minCoeff() > 4 * gap;
}

}  // namespace

bool is_fastener(const Part& part) { return part.kind && (part.kind->kind == "screw" || part.kind->kind == "nut"); }

bool is_bonded(const Assembly& assembly, PartId a, PartId b, double gap) {
  if (const InitialOverlap* o = assembly.overlap_of(a, b); o != nullptr && o->place) {
    const ContactClass contact = o->place->contact;
    if (contact == ContactClass::uniform_interference && o->place->axis) return true;  // around an axis
    if (o->depth > gap && contact != ContactClass::clearance && contact != ContactClass::kissing) return true;
  }
  return is_fastener(assembly.parts[a]) || is_fastener(assembly.parts[b]) ||
         is_coupled(assembly.parts[a], assembly.parts[b], gap);
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
