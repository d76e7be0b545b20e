/// Random plans of an assembly, with the truth about groups and poses beside them.
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/run_context.h"

namespace dismantle {

using PartGroup = std::set<std::size_t>;

struct RandomPlan {
  Plan plan;
  std::vector<std::set<PartGroup>> groups;  ///< after each number of steps, from 0
  std::vector<std::vector<Pose>> poses;     ///< the same, by part
};

/// Parts of the given meshes; `scale` assembly units per input unit about `center`.
inline Assembly assembly_of_meshes(const std::vector<std::pair<std::string, Mesh>>& meshes, double scale,
                                   const Eigen::Vector3d& center) {
  Assembly out;
  out.normalization = {scale, center};
  for (const auto& [name, mesh] : meshes) {
    Part part;
    part.id = static_cast<PartId>(out.parts.size());
    part.name = name;
    part.mesh = part.surface = std::make_shared<Mesh>(mesh);
    for (const auto& v : mesh.vertices) out.input_box.extend(out.normalization.to_input(v));
    out.parts.push_back(std::move(part));
  }
  return out;
}

/// What a plan file says of an assembly.
inline PlanAssembly described(const Assembly& assembly) {
  PlanAssembly out;
  out.source = "an assembly";
  out.scale = assembly.normalization.scale;
  out.center = assembly.normalization.center;
  out.box = assembly.input_box;
  for (const Part& part : assembly.parts) out.parts.push_back({part.id, part.name, "x.obj"});
  return out;
}

/// Takes groups apart that may be single parts, sub-assemblies, several at once or everything that a step names; moves
/// parts aside in between; sometimes the rest moves instead of what leaves, a step is forced, parts are kept together
/// or the plan ends early. The motions are any, not valid ones.
class RandomPlanMaker {
 public:
  RandomPlanMaker(const Assembly& assembly, Rng& rng)
      : rng_(rng), size_(assembly.input_box.size().maxCoeff()), middle_(assembly.input_box.center()) {
    out_.plan.assembly = described(assembly);
    now_.resize(assembly.parts.size());
    PartGroup all;
    for (std::size_t i = 0; i < now_.size(); ++i) all.insert(i);
    groups_.push_back(all);
    if (now_.size() > 3 && chance(0.5)) kept_ = {0, 1 + rng_.below(now_.size() - 1)};
    record();
  }

  RandomPlan make() {
    const bool early = chance(0.35);
    while (std::ranges::any_of(groups_, [&](const PartGroup& g) { return divisible(g); })) {
      if (early && chance(0.4)) break;
      const std::size_t g = rng_.below(groups_.size());
      if (!divisible(groups_[g])) continue;
      if (chance(0.2))
        move_aside(groups_[g]);
      else
        take_apart(g);
      record();
    }
    finish();
    return std::move(out_);
  }

 private:
  bool chance(double p) { return rng_.uniform() < p; }
  bool divisible(const PartGroup& g) const { return g.size() > 1 && !(g == kept_); }
  const std::string& name(std::size_t part) const { return out_.plan.assembly.parts[part].name; }
  std::vector<std::string> names(const PartGroup& g) const {
    std::vector<std::string> out;
    for (const std::size_t i : g) out.push_back(name(i));
    return out;
  }

  /// Some parts of a group, neither none nor all; parts that are kept together only both.
  PartGroup some_of(const PartGroup& g) {
    for (;;) {
      PartGroup out;
      for (const std::size_t i : g)
        if (chance(0.4)) out.insert(i);
      if (out.empty() || out.size() == g.size()) continue;
      const auto cut = [&](std::size_t i) { return out.contains(i) != out.contains(*kept_.begin()); };
      const bool whole = std::ranges::includes(g, kept_);
      if (kept_.empty() || !whole || std::ranges::none_of(kept_, cut)) return out;
    }
  }

  Pose random_step() {
    if (chance(0.1)) return {};
    const auto any = [&] { return Eigen::Vector3d(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
    const Eigen::Quaterniond turn = chance(0.5) ? Eigen::Quaterniond::Identity() : rotation_from_vector(0.5 * any());
    return {middle_ - turn * middle_ + 0.3 * size_ * any(), turn};
  }

  PlanStep step_of(const PartGroup& movers) {
    PlanStep step;
    step.step = static_cast<unsigned>(out_.plan.disassembly.size() + 1);
    step.layer = 1;
    step.planner = "guided";
    std::vector<Pose> along{Pose{}};
    const bool still = chance(0.05);
    for (std::uint64_t k = 1 + rng_.below(10); k > 0; --k)
      along.push_back(still ? Pose{} : random_step() * along.back());
    for (const std::size_t i : movers) {
      PlanMove move{name(i), {}};
      for (const Pose& by : along) move.poses.push_back(by * now_[i]);
      now_[i] = move.poses.back();
      step.moves.push_back(std::move(move));
    }
    return step;
  }

  void move_aside(const PartGroup& g) { out_.plan.disassembly.push_back(step_of(some_of(g))); }

  void take_apart(std::size_t g) {
    const PartGroup whole = groups_[g], out = some_of(whole);
    PartGroup rest;
    std::ranges::set_difference(whole, out, std::inserter(rest, rest.end()));
    PlanStep step = step_of(chance(0.15) ? rest : out);
    groups_[g] = rest;
    const bool two = out.size() > 1 && (kept_.empty() || !std::ranges::includes(out, kept_)) && chance(0.3);
    if (two) {
      const PartGroup first = some_of(out);
      PartGroup second;
      std::ranges::set_difference(out, first, std::inserter(second, second.end()));
      step.separates = {names(first), names(second)};
      groups_.insert(groups_.end(), {first, second});
    } else {
      step.separates = {names(out)};
      groups_.push_back(out);
    }
    if (chance(0.15)) step.separates.push_back(names(rest));
    if (chance(0.15))
      step.forced = PlanForced{name(*out.begin()), name(*rest.begin()), 0.01 * size_, 0, middle_, "it is held"};
    if (step.forced && chance(0.5)) step.transfer = step.moves.front().poses.size() - 1;
    out_.plan.disassembly.push_back(std::move(step));
  }

  void record() {
    out_.groups.emplace_back(groups_.begin(), groups_.end());
    out_.poses.push_back(now_);
  }

  /// Some steps say how the assembly lies.
  void lay_down() {
    for (PlanStep& step : out_.plan.disassembly)
      if (chance(0.5)) step.up = chance(0.5) ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(1, 0, 0);
  }

  void finish() {
    Plan& plan = out_.plan;
    if (chance(0.4)) lay_down();
    const bool complete = std::ranges::none_of(groups_, [&](const PartGroup& g) { return divisible(g); });
    plan.status = !complete ? PlanStatus::partial : plan.forced_steps() > 0 ? PlanStatus::forced : PlanStatus::complete;
    const bool kept_is_left = chance(0.5);
    for (const PartGroup& g : groups_)
      if (g.size() > 1 && (kept_is_left || divisible(g)))
        for (const std::string& part : names(g)) plan.remaining.push_back(part);
    for (const std::string& part : plan.remaining) {
      if (complete || chance(0.3)) continue;
      const Outcome outcome = chance(0.5) ? Outcome::timeout : Outcome::exhausted;
      PlanUnsolved left{part, outcome, {}, chance(0.2) ? Pose{} : random_step(), chance(0.5) ? "tried" : "tried again"};
      plan.unsolved.push_back(std::move(left));
    }
    for (std::size_t s = plan.disassembly.size(); s-- > 0;) {
      PlanStep step = plan.disassembly[s];
      step.step = static_cast<unsigned>(plan.assembly_steps.size() + 1);
      step.separates.clear();
      step.up.reset();  // as the step that it reverses
      step.transfer = chance(0.5) ? 0 : 1 + rng_.below(4);
      std::vector<Pose> along;
      for (std::size_t k = 0; k < step.transfer; ++k) along.push_back(random_step());
      for (PlanMove& move : step.moves) {
        std::ranges::reverse(move.poses);
        for (const Pose& by : along) move.poses.insert(move.poses.begin(), by * move.poses.front());
      }
      plan.assembly_steps.push_back(std::move(step));
    }
    plan.assembly_status = AssemblyStatus::complete;
  }

  Rng& rng_;
  const double size_;
  const Eigen::Vector3d middle_;
  PartGroup kept_;  // two parts, or none
  std::vector<PartGroup> groups_;
  std::vector<Pose> now_;
  RandomPlan out_;
};

inline RandomPlan random_plan(const Assembly& assembly, Rng& rng) { return RandomPlanMaker(assembly, rng).make(); }

}  // namespace dismantle
