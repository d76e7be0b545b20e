#include "bonds.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "dismantle/fasteners/fastening.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/run_context.h"

namespace dismantle::statics {
namespace {

constexpr double kThread = 0.25;  // of the radius of a thread: the height of its profile

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

bool is_fastener(const Part& part) { return part.kind && (part.kind->kind == "screw" || part.kind->kind == "nut"); }

bool is_pressed(const InitialOverlap* overlap, double gap) {
  if (overlap == nullptr || !overlap->place) return false;
  const ContactClass contact = overlap->place->contact;
  if (contact == ContactClass::uniform_interference && overlap->place->axis) return true;  // around an axis
  return overlap->depth > gap && contact != ContactClass::clearance && contact != ContactClass::kissing;
}

}  // namespace

Bonds::Bonds(const Assembly& assembly) : assembly_(assembly), screwed_(assembly.parts.size(), false) {
  if (std::ranges::any_of(assembly.parts, is_fastener)) add_threads();
}

void Bonds::add_threads() {
  const RunContext context;  // one thread, to the end
  const std::vector<fasteners::Shape> shapes = fasteners::fastener_shapes(assembly_, context);
  std::vector<std::unique_ptr<const TriangleBvh>> surfaces(assembly_.parts.size());
  const fasteners::SurfaceOf surface = [&](PartId id) -> const TriangleBvh& {
    const Part& part = assembly_.parts[id];
    if (!surfaces[id])
      surfaces[id] = std::make_unique<const TriangleBvh>(*part.mesh, geometry::Poll{},
                                                         part.open ? Surface::open : Surface::closed);
    return *surfaces[id];
  };
  const auto add = [&](PartId a, PartId b, double radius) { threads_[std::minmax(a, b)] = kThread * radius; };
  const auto fastenings = fasteners::fastenings_of(assembly_, shapes, surface, context);
  for (const fasteners::Fastening& f : fastenings) {
    for (const PartId part : f.into) add(f.screw, part, shapes[f.screw].shank_radius);
    if (f.possible_thread) add(f.screw, *f.possible_thread, shapes[f.screw].shank_radius);
    screwed_[f.screw] = f.possible_thread || !f.into.empty();
    if (f.clamps.empty() || f.into.empty()) continue;
    std::vector<PartId> all{f.screw, f.into.front()};
    all.insert(all.end(), f.clamps.begin(), f.clamps.end());
    clamped_.push_back(std::move(all));
  }
  for (const fasteners::NutOnRod& n : fasteners::nuts_on_rods(assembly_, shapes, fastenings, surface))
    add(n.nut, n.rod, shapes[n.nut].shank_radius);
}

std::optional<double> Bonds::depth(PartId a, PartId b, double gap) const {
  const InitialOverlap* overlap = assembly_.overlap_of(a, b);
  const double deep = overlap == nullptr ? 0 : overlap->depth;
  if (const auto thread = threads_.find(std::minmax(a, b)); thread != threads_.end())
    return std::max(deep, thread->second);
  if (is_coupled(assembly_.parts[a], assembly_.parts[b], gap)) return deep;
  // A bore that is drawn at the diameter of the screw that goes through it is no press fit.
  if (screwed_[a] || screwed_[b]) return std::nullopt;
  const bool drawn_in_it = is_fastener(assembly_.parts[a]) || is_fastener(assembly_.parts[b]);
  if (is_pressed(overlap, gap) || (drawn_in_it && deep > gap)) return deep;
  return std::nullopt;
}

std::vector<Contact> pair_contacts(const PlacedShape& a, const PlacedShape& b, double touching,
                                   const std::optional<double>& bond) {
  std::vector<Contact> found = contacts_between(a, b, touching);
  if (!found.empty() || !bond) return found;
  constexpr double kThreadPlay = 5;  // times the gap of other contacts
  const double depth = *bond / std::min(a.shape->radius(), b.shape->radius());
  return contacts_with_rims(a, b, std::max(kThreadPlay * touching, 1.1 * depth));
}

}  // namespace dismantle::statics
