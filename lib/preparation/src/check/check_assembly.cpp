#include "dismantle/preparation/check_assembly.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <tuple>

#include "check/fastenings.h"
#include "check/kinds.h"
#include "check/usual_overlaps.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/verification/contact.h"
#include "dismantle/verification/interruptible_depth.h"
#include "dismantle/verification/verifier.h"
#include "parallel_phase.h"

namespace dismantle {
namespace {

/// Parts closer than this share of the assembly's longest edge count as touching.
constexpr double kTouching = 0.01;

void add_input_findings(const PrepareReport& report, AssemblyCheck& check) {
  for (const std::string& text : report.whole)
    check.findings.push_back({FindingKind::input, Severity::warning, {}, text, {}, {}, {}});
  for (const std::string& text : report.notes)
    check.findings.push_back({FindingKind::input, Severity::note, {}, text, {}, {}, {}});
}

void add_part_findings(const PrepareReport& report, AssemblyCheck& check) {
  for (const PartReport& part : report.parts) {
    if (part.by_meaning) {
      check.findings.push_back({FindingKind::input,
                                Severity::note,
                                {part.name},
                                fmt::format("'{}' is left out: {}", part.name, part.reason),
                                {},
                                {},
                                {}});
      continue;
    }
    ++check.parts;
    if (part.kept) ++check.usable;
    if (!part.kept && part.reason.starts_with("duplicate")) {
      check.findings.push_back({FindingKind::duplicate,
                                Severity::warning,
                                {part.name},
                                fmt::format("'{}' is left out: {}", part.name, part.reason),
                                "remove one of the two from the model, or set assembly.drop_duplicates=false",
                                {},
                                {}});
    } else if (!part.kept) {
      check.findings.push_back({FindingKind::unusable,
                                Severity::error,
                                {part.name},
                                fmt::format("'{}' cannot be used: {}", part.name, part.reason),
                                "mend it, or name it in constraints.ignore; the plan is made without it",
                                {},
                                {}});
    }
    if (part.kept && !part.open.empty())
      check.findings.push_back({FindingKind::open,
                                Severity::note,
                                {part.name},
                                fmt::format("'{}' is {}: its surface is a wall", part.name, part.open),
                                "nothing, if this is meant; else mend it, or set assembly.open=exclude",
                                {},
                                {}});
    std::string done;
    std::vector<std::string> details;
    for (const std::string& action : part.summary) {
      if (action.starts_with("warning: "))
        check.findings.push_back({FindingKind::suspect,
                                  Severity::warning,
                                  {part.name},
                                  fmt::format("'{}': {}", part.name, action.substr(9)),
                                  "repair the mesh in the program that made it",
                                  {},
                                  {}});
      else
        done += (done.empty() ? "" : "; ") + action;
    }
    for (const std::string& action : part.actions)
      if (!action.starts_with("warning: ") && !action.starts_with("subdivided")) details.push_back(action);
    if (!part.kept || done.empty()) continue;
    check.findings.push_back({FindingKind::repaired,
                              Severity::note,
                              {part.name},
                              fmt::format("'{}' was repaired: {}", part.name, done),
                              "nothing, if the part still looks right (dismantle prepare writes it)",
                              {},
                              {}});
    check.findings.back().details = std::move(details);
  }
}

void add_flexible_findings(const PrepareReport& report, double scale, AssemblyCheck& check) {
  for (const FlexiblePart& f : report.flexible) {
    const double depth = f.depth / scale;
    Finding finding;
    finding.kind = FindingKind::flexible;
    finding.severity = Severity::note;
    finding.parts = {f.part};
    finding.depth = depth;
    if (f.kind == Flexible::declared) {
      finding.message = fmt::format("'{}' is declared as flexible: others may cut {:.3g} into it", f.part, depth);
      finding.advice = "nothing";
    } else if (f.kind == Flexible::material) {
      finding.message =
          fmt::format("'{}' is of a material that bends, says its file: others may cut {:.3g} into it", f.part, depth);
      finding.advice = "nothing, if it bends; else say in constraints.overlap how deep others may cut into it";
    } else {
      finding.message = fmt::format("'{}' is taken for flexible, since it is {}: '{}' may cut {:.3g} into it", f.part,
                                    f.kind == Flexible::coil ? "a wire that coils" : "a closed round strand",
                                    fmt::join(f.others, "', '"), depth);
      finding.advice = "nothing, if it bends (spring, O-ring, belt); else set assembly.flexible=declared";
    }
    check.findings.push_back(std::move(finding));
  }
}

class Geometry {
 public:
  Geometry(const Assembly& assembly, double tolerance, const RunContext& context)
      : assembly_(assembly),
        tolerance_(tolerance),
        context_(context),
        bvhs_(assembly.parts.size()),
        bodies_(assembly.parts.size()) {
    Aabb box;
    for (const Part& part : assembly.parts) box.extend(part.mesh->box());
    size_ = box.size().maxCoeff();
    parallel_phase(
        bvhs_.size(), context, "check",
        [&](std::size_t i) {
          const Part& part = assembly_.parts[i];
          bvhs_[i] =
              std::make_unique<TriangleBvh>(*part.mesh, geometry::Poll{}, part.open ? Surface::open : Surface::closed);
          bodies_[i] = std::make_unique<DepthBody>(*assembly_.parts[i].mesh);
        },
        [&](std::size_t i) { return assembly_.parts[i].name; });
  }

  void add_findings(AssemblyCheck& check) const {
    add_contacts(check);
    std::vector<char> alone(bvhs_.size(), 0);
    parallel_phase(
        bvhs_.size(), context_, "contacts", [&](std::size_t i) { alone[i] = isolated(static_cast<PartId>(i)); },
        [&](std::size_t i) { return assembly_.parts[i].name; });
    for (PartId id = 0; id < alone.size(); ++id)
      if (alone[id] != 0)
        check.findings.push_back({FindingKind::isolated,
                                  Severity::warning,
                                  {name(id)},
                                  fmt::format("'{}' touches no other part", name(id)),
                                  "check that it is in its assembled position and in the units of the others",
                                  {},
                                  assembly_.normalization.to_input(assembly_.parts[id].mesh->box().center())});
  }

  const TriangleBvh& surface(PartId id) const { return *bvhs_[id]; }

 private:
  const std::string& name(PartId id) const { return assembly_.parts[id].name; }

  /// Pairs whose boxes are nearer than what counts as touching; those that overlap were measured before.
  std::vector<InitialOverlap> near_pairs() const {
    std::vector<InitialOverlap> pairs;
    for (PartId a = 0; a < bodies_.size(); ++a) {
      Aabb around = assembly_.parts[a].mesh->box();
      around.inflate(kTouching * size_);
      for (PartId b = a + 1; b < bodies_.size(); ++b)
        if (around.overlaps(assembly_.parts[b].mesh->box())) pairs.push_back({a, b, 0});
    }
    auto known = assembly_.overlaps.begin();  // both are sorted by (a, b)
    for (InitialOverlap& pair : pairs) {
      while (known != assembly_.overlaps.end() && std::pair(known->a, known->b) < std::pair(pair.a, pair.b)) ++known;
      if (known != assembly_.overlaps.end() && known->a == pair.a && known->b == pair.b) pair.depth = known->depth;
    }
    return pairs;
  }

  void add_contacts(AssemblyCheck& check) const {
    const std::vector<InitialOverlap> pairs = near_pairs();
    std::vector<std::optional<PairContact>> found(pairs.size());
    parallel_phase(
        pairs.size(), context_, "overlaps", [&](std::size_t i) { found[i] = contact(pairs[i]); },
        [&](std::size_t i) { return name(pairs[i].a); });
    UsualOverlaps usual(assembly_);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!found[i]) continue;
      const PairContact& c = *found[i];
      check.contacts.push_back(
          {name(pairs[i].a), name(pairs[i].b), c.depth / assembly_.normalization.scale, in_input(c.place)});
      const bool overlap = pairs[i].depth > 0;
      if (overlap || c.place.contact == ContactClass::duplicate)
        check.findings.push_back(finding(pairs[i], check.contacts.back(), c, overlap, usual));
    }
  }

  std::optional<PairContact> contact(const InitialOverlap& pair) const {
    const DepthBody &a = *bodies_[pair.a], &b = *bodies_[pair.b];
    if (pair.depth > 0) {
      const Penetration deepest = deepest_penetration(a, Pose{}, b, Pose{}, {tolerance_}, context_);
      if (context_.should_stop()) return std::nullopt;
      return classify_overlap(a, b, deepest, tolerance_);
    }
    const std::optional<ContactClass> apart = classify_apart(a, b, tolerance_, kTouching * size_);
    if (!apart) return std::nullopt;
    PairContact found;
    found.place.contact = *apart;
    if (*apart == ContactClass::duplicate) {
      const Aabb box = assembly_.parts[pair.a].mesh->box();
      found.place = {*apart, box.center(), box, 1};
    }
    return found;
  }

  OverlapPlace in_input(OverlapPlace place) const {
    const Normalization& n = assembly_.normalization;
    place.at = n.to_input(place.at);
    place.axis_point = n.to_input(place.axis_point);
    if (!place.region.empty()) place.region = {n.to_input(place.region.lo), n.to_input(place.region.hi)};
    return place;
  }

  Finding finding(const InitialOverlap& ids, const CheckedContact& pair, const PairContact& found, bool overlap,
                  UsualOverlaps& usual) const {
    Finding finding;
    finding.kind = FindingKind::overlap;
    finding.parts = {pair.a, pair.b};
    if (overlap) finding.depth = pair.depth;
    finding.at = pair.place.at;
    finding.contact = pair.place.contact;
    // Deeper overlaps allow motions that a user would call a collision.
    const bool deep = found.depth > 0.01 * size_;
    finding.severity = deep ? Severity::error : Severity::warning;
    const std::string share =
        fmt::format("{:.3g} deep ({:.2g} % of the assembly)", pair.depth, 100 * found.depth / size_);
    const auto overlaps = [&](const char* where) {
      finding.message = fmt::format("'{}' and '{}' overlap {}, {}", pair.a, pair.b, where, share);
    };
    const char* mend =
        "correct the model: a plan lets this pair be as deep in each other along the way, where they are now";
    switch (*finding.contact) {
      case ContactClass::duplicate:
        finding.kind = FindingKind::duplicate;
        finding.severity = Severity::warning;
        finding.message = fmt::format("'{}' and '{}' coincide", pair.a, pair.b);
        finding.advice = "remove one of the two from the model, or set assembly.drop_duplicates=true";
        break;
      case ContactClass::inside:
        finding.kind = FindingKind::enclosed;
        finding.severity = Severity::error;
        if (!found.first_inside) std::swap(finding.parts[0], finding.parts[1]);
        finding.message =
            fmt::format("'{}' lies inside the solid material of '{}', {}", finding.parts[0], finding.parts[1], share);
        finding.advice = fmt::format("cut a cavity for it into '{}', or leave one of the two out (constraints.ignore)",
                                     finding.parts[1]);
        break;
      case ContactClass::uniform_interference:
        overlaps(pair.place.axis ? "all around an axis" : "over a whole face");
        finding.advice =
            deep ? mend
                 : "nothing, if this is a press fit, a seal, or a screw without its thread; else correct the model";
        break;
      default:
        overlaps("in a small region");
        finding.advice = deep ? mend
                              : "nothing, if one of them bends there (clip, spring, seal) or this is rounding; else "
                                "correct the model";
    }
    if (finding.kind == FindingKind::overlap) usual.excuse(ids, found, finding);
    return finding;
  }

  bool isolated(PartId id) const {
    const double gap = kTouching * size_;
    Aabb around = assembly_.parts[id].mesh->box();
    around.inflate(gap);
    for (PartId other = 0; other < bvhs_.size(); ++other) {
      if (other == id || !around.overlaps(assembly_.parts[other].mesh->box())) continue;
      if (near(id, other, gap) || near(other, id, gap)) return false;
    }
    return true;
  }

  /// Some sample of the surface of `part` (vertices and centres of the contact surface) is within `gap` of `other`, or
  /// inside it.
  bool near(PartId part, PartId other, double gap) const {
    const Mesh& surface = *assembly_.parts[part].surface;
    const auto close = [&](const Eigen::Vector3d& p) { return bvhs_[other]->closest(p, gap).distance <= gap; };
    if (std::any_of(surface.vertices.begin(), surface.vertices.end(), close)) return true;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (close((surface.vertex(t, 0) + surface.vertex(t, 1) + surface.vertex(t, 2)) / 3)) return true;
    return bvhs_[other]->inside(surface.vertices.front());
  }

  const Assembly& assembly_;
  double tolerance_;
  const RunContext& context_;
  double size_ = 0;
  std::vector<std::unique_ptr<TriangleBvh>> bvhs_;
  std::vector<std::unique_ptr<DepthBody>> bodies_;
};

void sort_findings(AssemblyCheck& check) {
  const auto key = [](const Finding& f) {
    return std::tuple(-static_cast<int>(f.severity), static_cast<int>(f.kind), -f.depth.value_or(0), f.parts);
  };
  std::stable_sort(check.findings.begin(), check.findings.end(),
                   [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
}

}  // namespace

std::size_t AssemblyCheck::count(Severity severity) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(findings, [severity](const Finding& f) { return f.severity == severity; }));
}

bool AssemblyCheck::sound() const { return count(Severity::error) == 0; }

AssemblyCheck check_parts(const PrepareReport& report) {
  AssemblyCheck check;
  add_input_findings(report, check);
  add_part_findings(report, check);
  sort_findings(check);
  return check;
}

AssemblyCheck check_assembly(const Assembly& assembly, const PrepareReport& report, double tolerance,
                             const RunContext& context) {
  AssemblyCheck check;
  add_input_findings(report, check);
  add_part_findings(report, check);
  add_flexible_findings(report, assembly.normalization.scale, check);
  const Geometry geometry(assembly, tolerance, context);
  geometry.add_findings(check);
  add_fastenings(
      assembly, [&](PartId id) -> const TriangleBvh& { return geometry.surface(id); }, check, context);
  sort_findings(check);
  check.kinds = checked_kinds(assembly);
  return check;
}

}  // namespace dismantle
