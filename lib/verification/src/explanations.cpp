#include "dismantle/verification/explanations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace dismantle {

namespace {

std::string place(const Eigen::Vector3d& assembled, const Assembly& assembly) {
  const Eigen::Vector3d p = assembly.normalization.to_input(assembled);
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

std::string names(const std::vector<PartId>& parts, const Assembly& assembly) {
  std::vector<std::string> quoted;
  for (const PartId id : parts) quoted.push_back(fmt::format("'{}'", assembly.parts[id].name));
  return fmt::format("{}", fmt::join(quoted, ", "));
}

}  // namespace

std::string describe(const Lock& lock, const Assembly& assembly) {
  return fmt::format(
      "'{0}' and '{1}' are locked into each other: {2} lies in both, {3:.4g} below the surface of '{0}', so on any way "
      "apart '{1}' cuts so deep into it; {4:.4g} is allowed (assembly units; see verify.max_penetration)",
      assembly.parts[lock.inside].name, assembly.parts[lock.other].name, place(lock.point, assembly), lock.depth,
      lock.allowed);
}

std::string describe(const Enclosure& enclosure, const Assembly& assembly) {
  return fmt::format(
      "'{}' is shut in by {}: a ball of radius {:.4g} (assembly units) about {}, which it holds, is too large for "
      "every "
      "way out, less the penetration that is allowed",
      assembly.parts[enclosure.inside].name, names(enclosure.around, assembly), enclosure.radius,
      place(enclosure.point, assembly));
}

std::string describe(const Cage& cage, const Assembly& assembly) {
  const std::string &inside = assembly.parts[cage.inside].name, &other = assembly.parts[cage.other].name;
  if (cage.kind == Cage::Kind::ring)
    return fmt::format(
        "'{0}' and '{1}' hold each other: '{0}' has a ring of diameter {2:.4g} about {3} in a chamber of '{1}', which "
        "opens no wider than {4:.4g} (assembly units, less the penetration that is allowed)",
        inside, other, cage.size, place(cage.point, assembly), cage.opening);
  if (cage.kind == Cage::Kind::spool)
    return fmt::format(
        "'{0}' and '{1}' hold each other: '{0}' goes through a hole in '{1}' at {2}, and has rims on both sides, "
        "{3:.4g} "
        "wide, where a circle of {4:.4g} about the hole keeps them off (assembly units, with the penetration that is "
        "allowed)",
        inside, other, place(cage.point, assembly), cage.size, cage.opening);
  if (cage.kind == Cage::Kind::disc)
    return fmt::format(
        "'{0}' and '{1}' hold each other: '{0}' has a flat disc of diameter {2:.4g} about {3} in a chamber of '{1}', "
        "none "
        "of whose openings it gets through, however it is turned (assembly units, less the penetration that is "
        "allowed)",
        inside, other, cage.size, place(cage.point, assembly));
  return fmt::format(
      "'{0}' and '{1}' hold each other: '{0}' goes through a hole in '{1}' at {2}, {3:.4g} wide (assembly units), and "
      "is "
      "bent on both sides; neither bend can follow, less the penetration that is allowed",
      inside, other, place(cage.point, assembly), cage.opening);
}

std::string describe(const Confinement& confinement, const Assembly& assembly) {
  return fmt::format(
      "'{0}' and '{1}' hold each other as rigid bodies: cutting in by less than {2:.4g}, '{0}' comes no further than "
      "{3:.4g} past '{1}' and turns by no more than {4:.4g} rad (assembly units; proved over {5} boxes of poses)",
      assembly.parts[confinement.inside].name, assembly.parts[confinement.other].name, confinement.depth,
      confinement.shift, confinement.turn, confinement.cells);
}

std::string describe(const Interlock& interlock, const Assembly& assembly) {
  return fmt::format(
      "{0} hold each other in place as rigid bodies: cutting in by less than {1:.4g} more than when assembled, and "
      "whichever of them move, none comes further than {2:.4g} past the largest or turns by more than {3:.4g} rad "
      "(assembly units; proved with {4} half spaces of poses)",
      names(interlock.parts, assembly), interlock.depth, interlock.shift, interlock.turn, interlock.half_spaces);
}

}  // namespace dismantle
