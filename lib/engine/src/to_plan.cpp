#include "to_plan.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "precedence.h"

namespace dismantle {

namespace {

std::optional<OverlapPlace> place_in_input(std::optional<OverlapPlace> place, const Normalization& n) {
  if (!place) return place;
  place->at = n.to_input(place->at);
  place->axis_point = n.to_input(place->axis_point);
  if (!place->region.empty()) place->region = {n.to_input(place->region.lo), n.to_input(place->region.hi)};
  return place;
}

/// States the part, and the overlaps whose declared depth comes from it. A pair whose depth the user declared differs.
void state_flexible(const FlexiblePart& flexible, PlanAssembly& assembly) {
  for (PlanPart& part : assembly.parts)
    if (part.name == flexible.part) part.flexible = flexible.kind;
  const auto with = [&](const std::string& name) {
    return std::find(flexible.others.begin(), flexible.others.end(), name) != flexible.others.end();
  };
  for (PlanOverlap& o : assembly.overlaps)
    if ((o.a == flexible.part && with(o.b)) || (o.b == flexible.part && with(o.a)))
      o.flexible = o.flexible || o.declared == std::max(o.depth, flexible.depth);
}

std::vector<std::string> names_of(const std::vector<PartId>& parts, const Assembly& assembly) {
  std::vector<std::string> names;
  for (const PartId id : parts) names.push_back(assembly.parts.at(id).name);
  return names;
}

PlanAssembly to_plan(const Assembly& assembly, const std::vector<FlexiblePart>& flexible) {
  PlanAssembly a;
  a.source = assembly.source;
  a.sha256 = assembly.sha256;
  a.scale = assembly.normalization.scale;
  a.center = assembly.normalization.center;
  a.box = assembly.input_box;
  a.repair = assembly.repair;
  a.import_params = assembly.import_params;
  a.unit = assembly.unit;
  for (const auto& part : assembly.parts) {
    a.parts.push_back({part.id, part.name, part.file, part.colour, part.parents, {}, part.product, part.open, part.kind});
    if (part.colour) a.parts.back().colour->a = 255;
  }
  for (const ReferenceStep& s : assembly.reference_order)
    a.reference_order.push_back({s.step, names_of(s.parts, assembly), s.group, s.up});
  for (const auto& excluded : assembly.excluded) a.excluded.push_back({excluded.name, excluded.reason, !excluded.by_choice});
  for (const auto& o : assembly.overlaps)
    a.overlaps.push_back({assembly.parts.at(o.a).name, assembly.parts.at(o.b).name, o.depth,
                          place_in_input(o.place, assembly.normalization), o.declared, false});
  for (const FlexiblePart& f : flexible) state_flexible(f, a);
  return a;
}

PlanAsked asked_of(const RunOptions& options, const Assembly& assembly) {
  if (!options.only_part.empty()) return {.part = options.only_part};
  PlanAsked asked;
  if (options.constraints.target) asked.target = assembly.parts.at(*options.constraints.target).name;
  for (const auto& list : options.constraints.together) asked.together.push_back(names_of(list, assembly));
  return asked;
}

}  // namespace

PlanCertificate to_plan(const Certificate& certificate, const Assembly& assembly) {
  PlanCertificate written;
  written.kind = certificate.kind;
  written.parts = names_of(certificate.parts, assembly);
  const bool assembled =
      std::all_of(certificate.poses.begin(), certificate.poses.end(), [](const Pose& p) { return p.is_identity(); });
  if (!assembled)
    for (const Pose& p : certificate.poses) written.poses.push_back(assembly.normalization.pose_to_input(p));
  written.full_tolerance = certificate.full_tolerance;
  written.margin = certificate.margin;
  written.numbers = certificate.numbers;
  written.text = certificate.text;
  return written;
}

namespace {

/// Its index in plan.certificates, where each is written once.
std::size_t index_of(const Certificate& certificate, Plan& plan, const Assembly& assembly) {
  PlanCertificate written = to_plan(certificate, assembly);
  const auto known = std::find_if(plan.certificates.begin(), plan.certificates.end(), [&](const PlanCertificate& c) {
    return c.kind == written.kind && c.parts == written.parts && c.margin == written.margin && c.text == written.text &&
           c.numbers == written.numbers;
  });
  const auto index = static_cast<std::size_t>(known - plan.certificates.begin());
  if (known == plan.certificates.end()) plan.certificates.push_back(std::move(written));
  return index;
}

PlanForced to_plan(const ForcedCut& cut, Plan& plan, const Assembly& assembly) {
  const Normalization& to = assembly.normalization;
  const InitialOverlap* overlap = assembly.overlap_of(cut.deepest.part, cut.deepest.other);
  PlanForced forced;
  forced.part = assembly.parts.at(cut.deepest.part).name;
  forced.other = assembly.parts.at(cut.deepest.other).name;
  forced.depth = cut.deepest.depth / to.scale;
  forced.assembled = (overlap == nullptr ? 0 : overlap->depth) / to.scale;
  forced.at = to.to_input(cut.deepest.point);
  forced.reason = cut.reason;
  if (cut.certificate) forced.certificate = index_of(*cut.certificate, plan, assembly);
  forced.lower_bound = cut.lower_bound;
  return forced;
}

PlanStep to_plan(const DisassemblyStep& step, Plan& plan, const Assembly& assembly) {
  PlanStep written;
  written.step = static_cast<unsigned>(plan.disassembly.size()) + 1;
  for (std::size_t i = 0; i < step.parts.size(); ++i) {
    PlanMove move{assembly.parts[step.parts[i]].name, {}};
    move.poses.reserve(step.path->size());
    for (const auto& instant : *step.path) move.poses.push_back(assembly.normalization.pose_to_input(instant[i]));
    written.moves.push_back(std::move(move));
  }
  if (!step.placement) written.separates.push_back(names_of(step.leaving(), assembly));
  written.max_penetration = step.max_penetration;
  written.seconds = step.seconds;
  written.planner = step.planner;
  written.depth = step.depth;
  written.contacts = names_of(step.contacts, assembly);
  if (step.forced) written.forced = to_plan(*step.forced, plan, assembly);
  written.up = step.up;
  return written;
}

}  // namespace

Plan plan_of(const Disassembly& disassembly, const Assembly& assembly, const RunOptions& options) {
  Plan plan;
  plan.generator_version = DISMANTLE_VERSION;
  plan.asked = asked_of(options, assembly);
  plan.seed = options.seed;
  plan.verified_max_penetration = options.verify.max_penetration;
  plan.assembly = to_plan(assembly, options.flexible);
  for (const DisassemblyStep& step : disassembly.steps()) plan.disassembly.push_back(to_plan(step, plan, assembly));
  for (auto step = plan.disassembly.rbegin(); step != plan.disassembly.rend(); ++step) {
    plan.assembly_steps.push_back(reversed(*step));
    plan.assembly_steps.back().step = static_cast<unsigned>(plan.assembly_steps.size());
  }
  const std::vector<std::vector<PartId>>& groups = disassembly.groups();
  std::vector<std::vector<std::string>> names;
  for (const auto& group : groups) names.push_back(names_of(group, assembly));
  const bool done = is_done(plan.asked, names);
  plan.status = !done ? PlanStatus::partial : plan.forced_steps() > 0 ? PlanStatus::forced : PlanStatus::complete;
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (g == 0 || groups[g].size() > 1)
      for (const PartId id : groups[g]) plan.remaining.push_back(assembly.parts[id].name);
  return plan;
}

void set_unsolved(Plan& plan, const std::vector<Unsolved>& unsolved, const Assembly& assembly,
                  const Disassembly& disassembly, const Oracle& oracle, const ContactsOf& places) {
  for (const Unsolved& u : unsolved) {
    PlanUnsolved entry;
    entry.part = assembly.parts.at(u.part).name;
    entry.outcome = u.outcome;
    entry.blocked_by = names_of(u.blocked_by, assembly);
    const Pose reached = u.best_pose.empty() ? disassembly.pose(u.part) : u.best_pose.front();
    entry.best_pose = assembly.normalization.pose_to_input(reached);
    entry.message = u.message;
    if (const SearchEffort effort = oracle.effort_on(u.part); effort.attempts > 0) {
      entry.planner = oracle.planner_id();
      entry.attempts = effort.attempts;
      entry.seconds = effort.seconds;
      entry.depth = effort.depth;
    }
    if (!u.best_pose.empty() && places)
      for (const Contact& c : places(u.part, reached))
        entry.places.push_back({assembly.parts.at(c.other).name, assembly.normalization.to_input(c.point)});
    if (u.certificate != nullptr) entry.certificate = index_of(*u.certificate, plan, assembly);
    plan.unsolved.push_back(std::move(entry));
  }
}

void state_proofs(Plan& plan, const std::vector<const Certificate*>& proofs, const Assembly& assembly) {
  for (const Certificate* proof : proofs) index_of(*proof, plan, assembly);
}

PlanStep reversed(const PlanStep& step) {
  PlanStep back;
  back.step = step.step;
  back.moves = step.moves;
  back.forced = step.forced;
  for (auto& move : back.moves) std::reverse(move.poses.begin(), move.poses.end());
  return back;
}

void set_needed(Plan& plan, const std::vector<std::vector<std::size_t>>& needed) {
  const std::vector<unsigned> layers = layers_of(needed);
  for (std::size_t i = 0; i < plan.disassembly.size(); ++i) {
    plan.disassembly[i].after.clear();
    plan.disassembly[i].layer = 0;
    if (i >= needed.size()) continue;
    for (const std::size_t a : needed.at(i)) plan.disassembly[i].after.push_back(static_cast<unsigned>(a) + 1);
    plan.disassembly[i].layer = layers.at(i);
  }
}

}  // namespace dismantle
