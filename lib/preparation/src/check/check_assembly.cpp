#include "dismantle/preparation/check_assembly.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <tuple>

#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/verification/verifier.h"
#include "parallel_phase.h"

namespace dismantle {
namespace {

/// An overlap deeper than this share of the assembly's longest edge allows motions that a user would call a collision.
constexpr double kDeepOverlap = 0.01;
/// Parts closer than this share of the assembly's longest edge count as touching.
constexpr double kTouching = 0.01;

void add_part_findings(const PrepareReport& report, AssemblyCheck& check) {
  for (const PartReport& part : report.parts) {
    ++check.parts;
    if (part.kept) ++check.usable;
    if (!part.kept && part.reason.starts_with("duplicate")) {
      check.findings.push_back({FindingKind::duplicate, Severity::warning, {part.name},
                                fmt::format("'{}' is left out: {}", part.name, part.reason),
                                "remove one of the two from the model, or set assembly.drop_duplicates=false", {}, {}});
    } else if (!part.kept) {
      check.findings.push_back({FindingKind::unusable, Severity::error, {part.name},
                                fmt::format("'{}' cannot be used: {}", part.name, part.reason),
                                "export it again as a closed solid; without it the plan ignores this part", {}, {}});
    }
    std::string done;
    for (const std::string& action : part.actions) {
      if (action.starts_with("warning: "))
        check.findings.push_back({FindingKind::suspect, Severity::warning, {part.name},
                                  fmt::format("'{}': {}", part.name, action.substr(9)),
                                  "repair the mesh in the program that made it", {}, {}});
      else if (!action.starts_with("subdivided"))
        done += (done.empty() ? "" : "; ") + action;
    }
    if (part.kept && !done.empty())
      check.findings.push_back({FindingKind::repaired, Severity::note, {part.name},
                                fmt::format("'{}' was repaired: {}", part.name, done),
                                "nothing, if the part still looks right (dismantle prepare writes it)", {}, {}});
  }
}

class Geometry {
 public:
  Geometry(const Assembly& assembly, double tolerance, const RunContext& context)
      : assembly_(assembly), tolerance_(tolerance), context_(context), bvhs_(assembly.parts.size()) {
    Aabb box;
    for (const Part& part : assembly.parts) box.extend(part.mesh->box());
    size_ = box.size().maxCoeff();
    parallel_phase(
        bvhs_.size(), context, "check",
        [&](std::size_t i) { bvhs_[i] = std::make_unique<TriangleBvh>(*assembly_.parts[i].mesh); },
        [&](std::size_t i) { return assembly_.parts[i].name; });
  }

  void add_findings(AssemblyCheck& check) const {
    std::vector<Finding> overlaps(assembly_.overlaps.size());
    parallel_phase(
        overlaps.size(), context_, "overlaps", [&](std::size_t i) { overlaps[i] = overlap(assembly_.overlaps[i]); },
        [&](std::size_t i) { return name(assembly_.overlaps[i].a); });
    check.findings.insert(check.findings.end(), overlaps.begin(), overlaps.end());
    std::vector<char> alone(bvhs_.size(), 0);
    parallel_phase(
        bvhs_.size(), context_, "contacts", [&](std::size_t i) { alone[i] = isolated(static_cast<PartId>(i)); },
        [&](std::size_t i) { return assembly_.parts[i].name; });
    for (PartId id = 0; id < alone.size(); ++id)
      if (alone[id] != 0)
        check.findings.push_back({FindingKind::isolated, Severity::warning, {name(id)},
                                  fmt::format("'{}' touches no other part", name(id)),
                                  "check that it is in its assembled position and in the units of the others", {},
                                  assembly_.normalization.to_input(assembly_.parts[id].mesh->box().center())});
  }

 private:
  const std::string& name(PartId id) const { return assembly_.parts[id].name; }

  /// Every vertex of `part` is in the material of `other`.
  bool lies_inside(PartId part, PartId other) const {
    const auto& vertices = assembly_.parts[part].mesh->vertices;
    return std::all_of(vertices.begin(), vertices.end(), [&](const auto& v) { return bvhs_[other]->inside(v); });
  }

  Finding overlap(const InitialOverlap& o) const {
    const Penetration found = deepest_penetration(DepthBody(*assembly_.parts[o.a].mesh), Pose{},
                                                  DepthBody(*assembly_.parts[o.b].mesh), Pose{}, tolerance_);
    Finding finding;
    finding.kind = FindingKind::overlap;
    finding.parts = {name(o.a), name(o.b)};
    finding.depth = found.depth / assembly_.normalization.scale;
    finding.at = assembly_.normalization.to_input(found.point);
    for (const auto& [part, other] : {std::pair(o.a, o.b), std::pair(o.b, o.a)})
      if (lies_inside(part, other)) {
        finding.kind = FindingKind::enclosed;
        finding.parts = {name(part), name(other)};
      }
    const bool deep = found.depth > kDeepOverlap * size_;
    finding.severity = deep || finding.kind == FindingKind::enclosed ? Severity::error : Severity::warning;
    const std::string share = fmt::format("{:.3g} deep ({:.2g} % of the assembly)", *finding.depth,
                                          100 * found.depth / size_);
    if (finding.kind == FindingKind::enclosed) {
      finding.message = fmt::format("'{}' lies inside the solid material of '{}', {}", finding.parts[0],
                                    finding.parts[1], share);
      finding.advice = fmt::format("cut a cavity for it into '{}', or leave one of the two out (constraints.ignore)",
                                   finding.parts[1]);
    } else {
      finding.message = fmt::format("'{}' and '{}' overlap, {}", finding.parts[0], finding.parts[1], share);
      finding.advice = deep ? "correct the model: a plan allows this pair to stay as deep in each other all along"
                            : "nothing, if this is a press fit or rounding; else correct the model";
    }
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

AssemblyCheck check_parts(const PrepareReport& report) {
  AssemblyCheck check;
  add_part_findings(report, check);
  sort_findings(check);
  return check;
}

AssemblyCheck check_assembly(const Assembly& assembly, const PrepareReport& report, double tolerance,
                             const RunContext& context) {
  AssemblyCheck check;
  add_part_findings(report, check);
  Geometry(assembly, tolerance, context).add_findings(check);
  sort_findings(check);
  return check;
}

}  // namespace dismantle
