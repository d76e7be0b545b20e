#include "plan_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "precedence.h"

namespace dismantle {

static std::optional<OverlapPlace> place_in_input(std::optional<OverlapPlace> place, const Normalization& n) {
  if (!place) return place;
  place->at = n.to_input(place->at);
  place->axis_point = n.to_input(place->axis_point);
  if (!place->region.empty()) place->region = {n.to_input(place->region.lo), n.to_input(place->region.hi)};
  return place;
}

/// States the part, and the overlaps whose declared depth comes from it. A pair whose depth the user declared differs.
static void state_flexible(const FlexiblePart& flexible, PlanAssembly& assembly) {
  for (PlanPart& part : assembly.parts)
    if (part.name == flexible.part) part.flexible = flexible.kind;
  const auto with = [&](const std::string& name) {
    return std::find(flexible.others.begin(), flexible.others.end(), name) != flexible.others.end();
  };
  for (PlanOverlap& o : assembly.overlaps)
    if ((o.a == flexible.part && with(o.b)) || (o.b == flexible.part && with(o.a)))
      o.flexible = o.declared == std::max(o.depth, flexible.depth);
}

static Plan empty_plan(const Assembly& assembly, const RunOptions& options) {
  Plan plan;
  plan.generator_version = DISMANTLE_VERSION;
  plan.seed = options.seed;
  plan.verified_max_penetration = options.verify.max_penetration;
  PlanAssembly& a = plan.assembly;
  a.source = assembly.source;
  a.sha256 = assembly.sha256;
  a.scale = assembly.normalization.scale;
  a.center = assembly.normalization.center;
  a.box = assembly.input_box;
  a.repair = assembly.repair;
  a.import_params = assembly.import_params;
  a.unit = assembly.unit;
  for (const auto& part : assembly.parts) {
    a.parts.push_back({part.id, part.name, part.file, part.colour, part.parents, {}});
    if (part.colour) a.parts.back().colour->a = 255;
  }
  for (const auto& excluded : assembly.excluded) a.excluded.emplace_back(excluded.name, excluded.reason);
  for (const auto& o : assembly.overlaps)
    a.overlaps.push_back({assembly.parts.at(o.a).name, assembly.parts.at(o.b).name, o.depth,
                          place_in_input(o.place, assembly.normalization), o.declared, false});
  for (const FlexiblePart& f : options.flexible) state_flexible(f, a);
  return plan;
}

Plan plan_before_first_step(const Assembly& assembly, const RunOptions& options) {
  Plan plan = empty_plan(assembly, options);
  for (const auto& part : assembly.parts) plan.remaining.push_back(part.name);
  return plan;
}

PlanBuilder::PlanBuilder(const Assembly& assembly, const Oracle& oracle, const RunOptions& options,
                         std::string planner_id)
    : assembly_(assembly),
      oracle_(oracle),
      planner_id_(std::move(planner_id)),
      constraints_(options.constraints),
      plan_(empty_plan(assembly, options)),
      poses_(assembly.parts.size()),
      groups_(1) {
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) groups_[0].push_back(static_cast<PartId>(i));
  refresh_status();
}

std::vector<PartId>& PlanBuilder::group_of(const std::vector<PartId>& parts) {
  if (parts.empty()) throw std::logic_error("a removal of no part");
  for (auto& group : groups_) {
    const auto in_group = [&](PartId id) { return std::find(group.begin(), group.end(), id) != group.end(); };
    if (std::all_of(parts.begin(), parts.end(), in_group)) return group;
  }
  throw std::logic_error("the parts of a removal are unknown or not together any more");
}

PlanStep PlanBuilder::to_step(const Removal& removal) const {
  const PathResult& result = removal.attempt->result;
  PlanStep step;
  step.step = static_cast<unsigned>(plan_.disassembly.size()) + 1;
  const std::optional<PartId>& alone = removal.attempt->out;
  const bool separates = !removal.attempt->attempt.goal.placement;
  if (separates) step.separates.emplace_back();
  for (std::size_t i = 0; i < removal.parts.size(); ++i) {
    const std::string& name = assembly_.parts[removal.parts[i]].name;
    PlanMove move{name, {}};
    move.poses.reserve(result.path()->poses().size());
    for (const auto& instant : result.path()->poses())
      move.poses.push_back(assembly_.normalization.pose_to_input(instant[i]));
    step.moves.push_back(std::move(move));
    if (separates && (!alone || *alone == removal.parts[i])) step.separates.back().push_back(name);
  }
  step.max_penetration = removal.attempt->max_penetration;
  step.seconds = removal.attempt->seconds;
  step.planner = planner_id_;
  step.depth = result.depth;
  for (const PartId id : result.blocked_by) step.contacts.push_back(assembly_.parts[id].name);
  return step;
}

void PlanBuilder::record(const Removal& removal) {
  const AttemptKey* key = oracle_.key_of(removal.attempt);
  if (key == nullptr || !is_success(removal.attempt->result.outcome()))
    throw std::logic_error("a removal that is not a successful answer of the oracle");
  const Goal& goal = removal.attempt->attempt.goal;
  std::vector<PartId>& group = group_of(removal.parts);
  Attempt question;
  question.goal = goal;
  for (const PartId id : removal.parts) question.moving.push_back({id, poses_[id]});
  std::vector<PartId> rest;
  for (const PartId id : group)
    if (std::find(removal.parts.begin(), removal.parts.end(), id) == removal.parts.end()) rest.push_back(id);
  if (rest.empty() && !removal.attempt->out) throw std::logic_error("a removal that leaves nothing behind");
  for (const PartId id : rest) question.fixed.push_back({id, poses_[id]});
  if (removal.parts != ids_of(removal.attempt->attempt.moving) ||
      digest_of(canonical(question, assembly_.parts.size())) != key->scene)
    throw std::logic_error("a removal whose path was found for other parts or other places");

  if (removal.attempt->out)
    for (const PartId id : removal.parts)
      if (id != *removal.attempt->out) rest.push_back(id);
  check_constraints(removal, rest);

  const auto from = static_cast<std::size_t>(&group - groups_.data());
  PlanStep step = to_step(removal);
  Path path = removal.attempt->result.path()->poses();
  for (std::size_t i = 0; i < removal.parts.size(); ++i) poses_[removal.parts[i]] = path.back()[i];
  if (goes_on(removal, from)) take_back_last(step, path);
  plan_.assembly_steps.insert(plan_.assembly_steps.begin(), reversed(step));
  plan_.disassembly.push_back(std::move(step));
  for (std::size_t i = 0; i < plan_.assembly_steps.size(); ++i)
    plan_.assembly_steps[i].step = static_cast<unsigned>(i) + 1;
  const std::optional<PartId> alone = removal.attempt->out;
  recorded_.push_back({removal.parts, from, std::make_shared<const Path>(std::move(path)), goal.placement, alone});
  if (!goal.placement) groups_[from] = std::move(rest);
  groups_.push_back(goal.placement ? std::vector<PartId>{} : alone ? std::vector<PartId>{*alone} : removal.parts);
  refresh_status();
}

/// Does the removal continue the intermediate placement of the last step?
bool PlanBuilder::goes_on(const Removal& removal, std::size_t from) const {
  return !recorded_.empty() && recorded_.back().part_way && recorded_.back().from == from &&
         recorded_.back().parts == removal.parts;
}

/// Prepends the last step to `step` and its path to `path`, and deletes its record.
void PlanBuilder::take_back_last(PlanStep& step, Path& path) {
  const PlanStep& last = plan_.disassembly.back();
  step.step = last.step;
  for (std::size_t i = 0; i < step.moves.size(); ++i) {
    std::vector<Pose> poses = last.moves[i].poses;
    poses.insert(poses.end(), step.moves[i].poses.begin() + 1, step.moves[i].poses.end());
    step.moves[i].poses = std::move(poses);
  }
  step.max_penetration = std::max(step.max_penetration, last.max_penetration);
  step.seconds += last.seconds;
  step.depth += last.depth;
  for (const std::string& name : last.contacts)
    if (std::find(step.contacts.begin(), step.contacts.end(), name) == step.contacts.end())
      step.contacts.push_back(name);
  path.insert(path.begin(), recorded_.back().path->begin(), recorded_.back().path->end() - 1);
  plan_.disassembly.pop_back();
  plan_.assembly_steps.erase(plan_.assembly_steps.begin());
  groups_.pop_back();  // empty, because that step was an intermediate placement
  recorded_.pop_back();
}

void PlanBuilder::check_constraints(const Removal& removal, const std::vector<PartId>& rest) const {
  const auto holds = [](const std::vector<PartId>& parts, PartId id) {
    return std::find(parts.begin(), parts.end(), id) != parts.end();
  };
  for (const PartId id : constraints_.base)
    if (holds(removal.parts, id)) throw std::logic_error("a removal that moves a part of the base");
  for (const auto& list : constraints_.together) {
    const auto moves = [&](PartId id) { return holds(removal.parts, id); };
    const bool any = std::any_of(list.begin(), list.end(), moves);
    if (any && (!std::all_of(list.begin(), list.end(), moves) || (removal.attempt->out && list.size() > 1)))
      throw std::logic_error("a removal that parts what is to stay together");
  }
  for (const auto& [a, b] : constraints_.before)
    if (!removal.attempt->attempt.goal.placement && holds(removal.parts, b) && !holds(rest, b) && holds(rest, a))
      throw std::logic_error("a removal before another that is to come first");
}

/// True for one part, or for parts that the constraints keep together.
bool PlanBuilder::stays_together(const std::vector<PartId>& group) const {
  if (group.size() <= 1) return true;
  std::vector<PartId> reached{group.front()};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const auto& list : constraints_.together)
      if (std::find(list.begin(), list.end(), reached[k]) != list.end())
        for (const PartId id : list)
          if (std::find(reached.begin(), reached.end(), id) == reached.end()) reached.push_back(id);
  return std::all_of(group.begin(), group.end(),
                     [&](PartId id) { return std::find(reached.begin(), reached.end(), id) != reached.end(); });
}

std::vector<PlacedPart> PlanBuilder::around(PartId part) const {
  std::vector<PlacedPart> others;
  for (const auto& group : groups_)
    if (std::find(group.begin(), group.end(), part) != group.end())
      for (const PartId id : group)
        if (id != part) others.push_back({id, poses_[id]});
  return others;
}

bool PlanBuilder::fulfilled() const {
  for (const auto& group : groups_)
    if (constraints_.target && stays_together(group) &&
        std::find(group.begin(), group.end(), *constraints_.target) != group.end())
      return true;
  return std::all_of(groups_.begin(), groups_.end(), [&](const auto& group) { return stays_together(group); });
}

bool PlanBuilder::complete() const {
  return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return group.size() <= 1; });
}

std::vector<PartId> PlanBuilder::left() const {
  std::vector<PartId> ids;
  for (const auto& group : groups_)
    if (group.size() > 1) ids.insert(ids.end(), group.begin(), group.end());
  return ids;
}

void PlanBuilder::refresh_status() {
  plan_.status = !complete() ? PlanStatus::partial : forced_ > 0 ? PlanStatus::forced : PlanStatus::complete;
  plan_.remaining.clear();
  for (std::size_t g = 0; g < groups_.size(); ++g)
    if (g == 0 || groups_[g].size() > 1)
      for (const PartId id : groups_[g]) plan_.remaining.push_back(assembly_.parts[id].name);
}

PlanCertificate PlanBuilder::to_plan(const Certificate& certificate) const {
  PlanCertificate written;
  written.kind = certificate.kind;
  for (const PartId id : certificate.parts) written.parts.push_back(assembly_.parts.at(id).name);
  const bool assembled =
      std::all_of(certificate.poses.begin(), certificate.poses.end(), [](const Pose& p) { return p.is_identity(); });
  if (!assembled)
    for (const Pose& p : certificate.poses) written.poses.push_back(assembly_.normalization.pose_to_input(p));
  written.full_tolerance = certificate.full_tolerance;
  written.margin = certificate.margin;
  written.numbers = certificate.numbers;
  written.text = certificate.text;
  return written;
}

/// Its index in plan().certificates, where each is written once.
std::size_t PlanBuilder::index_of(const Certificate& certificate) {
  const auto known = std::find(written_.begin(), written_.end(), &certificate);
  const auto index = static_cast<std::size_t>(known - written_.begin());
  if (known == written_.end()) {
    written_.push_back(&certificate);
    plan_.certificates.push_back(to_plan(certificate));
  }
  return index;
}

void PlanBuilder::set_unsolved(const std::vector<Unsolved>& unsolved, const ContactsOf& places) {
  plan_.unsolved.clear();
  plan_.certificates.clear();
  written_.clear();
  for (const auto& u : unsolved) {
    PlanUnsolved entry;
    entry.part = assembly_.parts.at(u.part).name;
    entry.outcome = u.outcome;
    for (const PartId id : u.blocked_by) entry.blocked_by.push_back(assembly_.parts.at(id).name);
    const Pose reached = u.best_pose.empty() ? poses_[u.part] : u.best_pose.front();
    entry.best_pose = assembly_.normalization.pose_to_input(reached);
    entry.message = u.message;
    if (const SearchEffort effort = oracle_.effort_on(u.part); effort.attempts > 0) {
      entry.planner = oracle_.planner_id();
      entry.attempts = effort.attempts;
      entry.seconds = effort.seconds;
      entry.depth = effort.depth;
    }
    if (!u.best_pose.empty() && places)
      for (const Contact& c : places(u.part, reached))
        entry.places.push_back({assembly_.parts.at(c.other).name, assembly_.normalization.to_input(c.point)});
    if (u.certificate != nullptr) entry.certificate = index_of(*u.certificate);
    plan_.unsolved.push_back(std::move(entry));
  }
}

void PlanBuilder::set_overlaps(std::vector<std::vector<PlanStepOverlap>> overlaps) {
  for (std::size_t i = 0; i < plan_.disassembly.size(); ++i) plan_.disassembly[i].overlaps = std::move(overlaps.at(i));
}

void PlanBuilder::set_assembly(std::vector<PlanStep> steps, AssemblyStatus status, std::string message) {
  plan_.assembly_steps = std::move(steps);
  plan_.assembly_status = status;
  plan_.assembly_message = std::move(message);
}

PlanStep reversed(const PlanStep& step) {
  PlanStep back;
  back.step = step.step;
  back.moves = step.moves;
  back.forced = step.forced;
  for (auto& move : back.moves) std::reverse(move.poses.begin(), move.poses.end());
  return back;
}

void PlanBuilder::set_needed(const std::vector<std::vector<std::size_t>>& needed) {
  const std::vector<unsigned> layers = layers_of(needed);
  for (std::size_t i = 0; i < plan_.disassembly.size(); ++i) {
    plan_.disassembly[i].after.clear();
    for (const std::size_t a : needed.at(i)) plan_.disassembly[i].after.push_back(static_cast<unsigned>(a) + 1);
    plan_.disassembly[i].layer = layers.at(i);
  }
}

}  // namespace dismantle
