#include "dismantle/session/revision.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dismantle/engine/broken_constraint.h"
#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/part_set.h"
#include "straight_paths.h"

namespace dismantle {
namespace {

constexpr double kSame = 1e-5;  // of the part's size: files are written with six digits and more

/// What two exports of one part have in common, however they are cut into triangles. Input units.
struct Measures {
  Aabb box;
  double volume = 0, area = 0;
};

Mesh in_input_units(const Part& part, const Assembly& assembly) {
  Mesh mesh = *part.mesh;
  for (Eigen::Vector3d& v : mesh.vertices) v = assembly.normalization.to_input(v);
  return mesh;
}

Measures measures_of(const Mesh& mesh) { return {mesh.box(), signed_volume(mesh), surface_area(mesh)}; }

bool same_measures(const Measures& a, const Measures& b) {
  const double size = std::max(a.box.size().norm(), b.box.size().norm()), most = kSame * size;
  return (a.box.lo - b.box.lo).cwiseAbs().maxCoeff() <= most && (a.box.hi - b.box.hi).cwiseAbs().maxCoeff() <= most &&
         std::abs(a.volume - b.volume) <= most * size * size && std::abs(a.area - b.area) <= most * size;
}

/// Is one part the other one, displaced?
bool congruent(const Mesh& a, const Mesh& b) {
  std::vector<Part> parts(2);
  parts[0].mesh = std::make_shared<const Mesh>(a);
  parts[1].mesh = std::make_shared<const Mesh>(b);
  return geometry::find_congruent(parts)[1].original == 0;
}

class Comparison {
 public:
  Comparison(const Assembly& before, const Assembly& now) {
    for (const Part& part : before.parts) before_.push_back({part.name, in_input_units(part, before)});
    for (const Part& part : now.parts) now_.push_back({part.name, in_input_units(part, now)});
    for (auto* side : {&before_, &now_})
      for (Named& part : *side) part.measures = measures_of(part.mesh);
  }

  std::vector<PartRevision> revisions() {
    std::map<std::string, const Named*> old;
    for (const Named& part : before_) old.emplace(part.name, &part);
    std::vector<PartRevision> out;
    std::vector<std::size_t> fresh;  // in `out`
    std::vector<const Named*> fresh_parts;
    for (const Named& part : now_) {
      const auto known = old.find(part.name);
      if (known == old.end()) {
        fresh.push_back(out.size());
        fresh_parts.push_back(&part);
        out.push_back({PartFate::added, "", part.name});
        continue;
      }
      out.push_back({fate_of(*known->second, part), part.name, part.name});
      old.erase(known);
    }
    for (std::size_t k = 0; k < fresh.size(); ++k)
      for (auto left = old.begin(); left != old.end(); ++left)
        if (same_measures(left->second->measures, fresh_parts[k]->measures)) {
          out[fresh[k]] = {PartFate::renamed, left->first, fresh_parts[k]->name};
          old.erase(left);
          break;
        }
    for (const Named& part : before_)
      if (old.contains(part.name)) out.push_back({PartFate::removed, part.name, ""});
    return out;
  }

 private:
  struct Named {
    std::string name;
    Mesh mesh;
    Measures measures{};
  };

  static PartFate fate_of(const Named& before, const Named& now) {
    if (same_measures(before.measures, now.measures)) return PartFate::same;
    return congruent(before.mesh, now.mesh) ? PartFate::moved : PartFate::changed;
  }

  std::vector<Named> before_, now_;
};

/// Tries the steps of a plan one by one.
class Keeping {
 public:
  Keeping(const Assembly& now, const Constraints& constraints, const Verifier& verifier, const RunContext& context)
      : assembly_(now),
        constraints_(constraints),
        verifier_(verifier),
        context_(context),
        straight_(now),
        kept_{Disassembly(now.parts.size())} {
    for (const Part& part : now.parts) names_.emplace(part.name, part.id);
  }

  KeptSteps run(const Plan& plan) {
    for (const PlanStep& step : plan.disassembly) {
      if (context_.should_stop()) break;
      StepRevision& revision = kept_.revisions.emplace_back(StepRevision{step.step});
      for (const PlanMove& move : step.moves) revision.parts.push_back(move.part);
      revision.reason = keep(step);
      revision.kept = revision.reason.empty();
    }
    return std::move(kept_);
  }

 private:
  /// The step without the parts that are gone.
  PlanStep present(PlanStep step) const {
    const auto gone = [&](const std::string& name) { return !names_.contains(name); };
    std::erase_if(step.moves, [&](const PlanMove& move) { return gone(move.part); });
    for (auto& group : step.separates) std::erase_if(group, gone);
    std::erase_if(step.contacts, gone);
    return step;
  }

  /// Empty: the step was kept; otherwise why not.
  std::string keep(const PlanStep& planned) {
    if (planned.forced) return "it was forced";
    const PlanStep there = present(planned);
    if (there.moves.empty()) return "its parts are not there any more";
    if (!there.separates.empty() && there.separates.front().empty())
      return "the part that it frees is not there any more";
    DisassemblyStep step = disassembly_step(there, assembly_);
    const std::optional<std::size_t> group = kept_.steps.common_group(step.parts);
    if (!group) return "its parts are not together at that time";
    const std::vector<PlacedPart> moving = kept_.steps.placed(step.parts);
    const std::vector<PlacedPart> rest = kept_.steps.placed(without(kept_.steps.groups()[*group], step.parts));
    for (std::size_t i = 0; i < moving.size(); ++i)
      if (!same_place(moving[i].pose, step.path->front()[i])) return "its parts are elsewhere at that time";
    if (rest.empty()) return "nothing would be left of the group that its parts are in";
    if (std::string broken = broken_constraint(step, kept_.steps.groups()[*group], constraints_); !broken.empty())
      return broken;
    if (!step.placement && !step.released)
      step.path = std::make_shared<const Path>(straight_.long_enough(*step.path, step.parts, rest));
    const MotionCheck check = verifier_.check_motion(step.parts, rest, *step.path, context_);
    if (!check.valid) return refusal(check);
    if (!step.placement && !separates(step, rest)) return "its path ends before the convex hulls are apart";
    std::erase_if(step.contacts, [&](PartId part) { return kept_.steps.group(part) != *group; });
    try {
      kept_.steps.add(std::move(step));
    } catch (const std::logic_error& e) {  // the plan is not one that a program wrote
      return fmt::format("it is not possible after those before it: {}", e.what());
    }
    return {};
  }

  std::string refusal(const MotionCheck& check) const {
    if (check.interrupted || !check.violation) return "it was not checked: the run was stopped";
    const Violation& v = *check.violation;
    if (v.uncertain)
      return fmt::format("'{}' past '{}' could not be proved", assembly_.parts[v.part].name,
                         assembly_.parts[v.other].name);
    return fmt::format("'{}' cuts {:.3g} into '{}'", assembly_.parts[v.part].name,
                       (v.depth - v.allowed) / assembly_.normalization.scale, assembly_.parts[v.other].name);
  }

  bool separates(const DisassemblyStep& step, const std::vector<PlacedPart>& rest) const {
    std::vector<PlacedPart> out, staying = rest;
    for (std::size_t i = 0; i < step.parts.size(); ++i) {
      const PlacedPart at{step.parts[i], step.path->back()[i]};
      (step.released && *step.released != at.part ? staying : out).push_back(at);
    }
    return verifier_.apart(out, staying);
  }

  const Assembly& assembly_;
  const Constraints& constraints_;
  const Verifier& verifier_;
  const RunContext& context_;
  StraightPaths straight_;
  std::map<std::string, PartId> names_;
  KeptSteps kept_;
};

}  // namespace

const char* to_string(PartFate fate) {
  constexpr std::array names{"same", "moved", "changed", "renamed", "added", "removed"};
  return names[static_cast<std::size_t>(fate)];
}

std::vector<PartRevision> revised_parts(const Assembly& before, const Assembly& now) {
  return Comparison(before, now).revisions();
}

KeptSteps kept_steps(const Plan& plan, const Assembly& now, const Constraints& constraints, const Verifier& verifier,
                     const RunContext& context) {
  return Keeping(now, constraints, verifier, context).run(plan);
}

}  // namespace dismantle
