#include "assembler.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <iterator>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/part_set.h"
#include "placed_paths.h"
#include "scenery.h"

namespace dismantle {

namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

/// Transfer from the layout to where the way in begins.
struct Assembler::Found {
  Path path;  ///< empty: there is none
  double max_penetration = 0;
  unsigned depth = 0;
  double seconds = 0;
  std::string problem;
  bool looked_for = true;
  std::vector<std::pair<LogLevel, std::string>> log;
};

Assembler::Assembler(const Assembly& assembly, const DeferredSimulator& simulator, const PlanningSetup& setup,
                     const RunOptions& options, const Verifier& verifier)
    : assembly_(assembly),
      simulator_(simulator),
      setup_(setup),
      options_(options),
      verifier_(verifier),
      normalizer_(assembly) {}

Aabb Assembler::box_of(PartId part, const Pose& pose) const {
  Aabb box;
  for (const auto& v : assembly_.parts[part].mesh->vertices) box.extend(pose * v);
  return box;
}

/// Gives every group its place.
void Assembler::place_groups(Scenery& scenery, const RunContext& context) const {
  const LayoutOptions& layout = options_.layout;
  const std::size_t n = scenery.steps.size();
  // Box that each group needs: for its parts, and for the motions of parts that are inserted into it. On a screw motion
  // between two dense poses, a point leaves the box of its end points by less than half of its travel.
  const Disassembly& done = scenery.done;
  std::vector<Aabb> rooms(done.groups().size());
  const double sagitta = 0.5 * normalizer_.max_travel();
  Aabb assembled;
  for (PartId p = 0; p < done.parts(); ++p)
    if (done.group(p, 0) != Disassembly::kAbsent) assembled.extend(box_of(p, done.pose(p, 0)));
  rooms[0] = assembled;
  for (std::size_t i = 0; i < n; ++i) {
    const DisassemblyStep& step = scenery.steps[i];
    for (std::size_t k = 0; k < step.parts.size(); ++k) {
      if (step.leaves(step.parts[k])) rooms[done.group_of_step(i)].extend(box_of(step.parts[k], step.path->back()[k]));
      const Aabb box = assembly_.parts[step.parts[k]].mesh->box();
      Aabb swept;
      for (const auto& instant : *step.path) swept.extend(geometry::box_under(box, instant[k]));
      swept.inflate(sagitta);
      rooms[done.left_group(i)].extend(swept);
    }
  }

  std::vector<std::string> remarks;
  std::vector<Aabb> taken{rooms[0]};
  std::vector<bool> given(done.groups().size(), false);
  for (const auto& [name, pose] : layout.poses) {
    const auto part = std::find_if(assembly_.parts.begin(), assembly_.parts.end(),
                                   [&, &wanted = name](const Part& p) { return p.name == wanted; });
    if (part == assembly_.parts.end()) continue;  // run() has reported it
    const std::size_t g = done.group(part->id);
    if (g == Disassembly::kAbsent || scenery.of_start(g)) {
      remarks.push_back(fmt::format("layout: '{}' is not removed, so it stays where it is", name));
    } else if (given[g]) {
      remarks.push_back(fmt::format("layout: '{}' lies with parts whose place was given already", name));
    } else {
      given[g] = true;
      scenery.place[g] = assembly_.normalization.pose_to_internal(pose) * done.pose(part->id).inverse();
      taken.push_back(geometry::box_under(rooms[g], scenery.place[g]));
    }
  }
  std::vector<Aabb> boxes;
  std::vector<std::size_t> ours;
  for (std::size_t i = 0; i < n; ++i)
    if (const std::size_t g = done.group_of_step(i); !given[g] && !scenery.steps[i].placement) {
      boxes.push_back(rooms[g]);
      ours.push_back(g);
    }
  const Eigen::Vector3d up = layout.up_axis();
  auto shifts = lay_out(boxes, taken, up, layout.gap);
  // The plane is the one on which the assembly stands, even if parts leave below it.
  int w = 0;
  up.cwiseAbs().maxCoeff(&w);
  for (auto& shift : shifts)
    shift[w] += up[w] > 0 ? assembled.lo[w] - rooms[0].lo[w] : assembled.hi[w] - rooms[0].hi[w];
  for (std::size_t k = 0; k < ours.size(); ++k)
    scenery.place[ours[k]] = Pose{shifts[k], Eigen::Quaterniond::Identity()};
  for (const auto& remark : remarks) context.log(LogLevel::warning, remark);
}

/// Leaves groups out of the layout that are in the way of an insertion. The automatic layout leaves room; poses given
/// by the user may not.
void Assembler::clear_insertions(Scenery& scenery, const RunContext& context) const {
  PartPlaces places;
  for (std::size_t i = 0; i < scenery.steps.size(); ++i) {
    if (context.should_stop()) return;  // no more transfers are searched for
    const std::size_t from = scenery.done.left_group(i);
    // The parts that it passed on its way out need no check: the motion is the same.
    const std::vector<PlacedPart> others = places.others(scenery, i, false);
    const MotionCheck check = verifier_.check_motion(scenery.steps[i].parts, others, scenery.insertion(i), context);
    if (check.interrupted) return;
    if (check.valid) continue;
    const Violation v = check.violation.value_or(Violation{});
    const PartId id = contains(scenery.steps[i].parts, v.part) ? v.other : v.part;
    const std::size_t lies = scenery.done.group(id, i + 1);
    const std::size_t wrong = scenery.of_start(lies) ? from : lies;  // what stays cannot be left out
    if (scenery.of_start(wrong)) continue;
    if (!scenery.missing[wrong].empty()) continue;
    scenery.leave_out(wrong, fmt::format("in the layout '{}' lies where '{}' is put in", assembly_.parts[id].name,
                                         assembly_.parts[scenery.steps[i].parts.front()].name));
    i = static_cast<std::size_t>(-1);  // restart: groups that are placed relative to it have moved
  }
}

/// Path checker of one transfer.
class Assembler::Checker final : public PathChecker {
 public:
  /// All references must outlive it. `context` interrupts a running check.
  Checker(const Assembler& assembler, const Scene& scene, const std::vector<Pose>& goal, const RunContext& context)
      : assembler_(assembler), scene_(scene), goal_(goal), context_(context) {
    for (const PlacedPart& p : scene_.moving) moving_.push_back(p.part);
  }

  PathCheck check(const Path& path) const override {
    PathCheck answer;
    NormalizedPath written = assembler_.normalizer_.normalize(path, scene_.moving);
    answer.reason = written.problem;
    if (!answer.reason.empty()) return answer;
    for (std::size_t k = 0; k < goal_.size(); ++k) {
      if (!same_pose(written.path.back()[k], goal_[k], kPoseError, assembler_.normalizer_.size())) {
        answer.reason = "the path does not end at the goal";
        return answer;
      }
      written.path.back()[k] = goal_[k];
    }
    const MotionCheck motion = assembler_.verifier_.check_motion(moving_, scene_.fixed, written.path, context_);
    if (motion.valid) {
      answer.verified = accept(std::move(written.path), motion.max_penetration);
      return answer;
    }
    const Violation v = motion.violation.value_or(Violation{});
    answer.has_witness = motion.violation.has_value();
    answer.part = v.part;
    answer.other = v.other;
    answer.point = v.point;
    answer.instant = written.given_instant(v.segment, v.u);
    const auto& parts = assembler_.assembly_.parts;
    answer.reason = fmt::format("'{}' and '{}' would meet", parts[v.part].name, parts[v.other].name);
    return answer;
  }

 private:
  const Assembler& assembler_;
  const Scene& scene_;
  const std::vector<Pose>& goal_;
  const RunContext& context_;
  std::vector<PartId> moving_;
};

Assembler::Found Assembler::transfer(const Scenery& scenery, std::size_t i, PartPlaces& places,
                                     TransferPlanner& planner, const RunContext& context) const {
  const DisassemblyStep& step = scenery.steps[i];
  const std::size_t from = scenery.done.left_group(i), made = scenery.done.group_of_step(i);
  Scene scene{{}, places.others(scenery, i)};
  std::vector<Pose> goal;
  for (const PartId id : step.parts) {
    const Pose& out = scenery.done.pose(id, i + 1);
    if (!step.leaves(id)) {  // already there, and waits
      scene.fixed.push_back({id, scenery.place[from] * out});
      continue;
    }
    scene.moving.push_back({id, scenery.place[made] * out});
    goal.push_back(scenery.place[from] * out);
  }

  std::vector<std::pair<LogLevel, std::string>> log;
  RunContext own = context;
  own.rng = context.rng.fork(i);
  own.threads = 1;
  own.on_progress = nullptr;
  own.on_log = [&](LogLevel level, std::string_view text) { log.emplace_back(level, text); };

  const Checker checker(*this, scene, goal, own);
  const TransferQuery query{assembly_,
                            simulator_,
                            nothing_,
                            scene,
                            goal,
                            options_.layout.up_axis(),
                            {.max_steps = options_.path_steps, .timeout = options_.path_timeout},
                            verifier_.options().max_penetration,
                            checker};
  if (options_.path_timeout > 0) own.deadline = own.deadline.earlier(Deadline::after_seconds(options_.path_timeout));
  const auto begin = Clock::now();
  PathResult result;
  try {
    result = planner.plan(query, own);
  } catch (const std::exception& e) {
    result.fail(Outcome::crashed, e.what());
  } catch (...) {
    result.fail(Outcome::crashed, "it threw something that is not a std::exception");
  }
  if (result.path() && checker.accepted(*result.path())) {
    Found found;
    found.path = result.path()->poses();
    found.max_penetration = result.path()->max_penetration();
    found.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    found.depth = result.depth;
    found.log = std::move(log);
    return found;
  }
  Found none;
  none.log = std::move(log);
  none.problem = std::string(to_string(is_success(result.outcome()) ? Outcome::crashed : result.outcome()));
  if (!result.message.empty()) none.problem += ", " + result.message;
  return none;
}

/// Transfers of the steps [first, last) that need one, found by several threads with the present scenery.
std::vector<Assembler::Found> Assembler::transfers(const Scenery& scenery, std::vector<PartPlaces>& places,
                                                   std::size_t first, std::size_t last, const RunContext& context) {
  std::vector<Found> transfers_found(last - first);
  const auto one = [&](std::size_t k, std::size_t thread) {
    const std::size_t i = first + k;
    if (!scenery.missing[scenery.done.group_of_step(i)].empty() || scenery.steps[i].placement) return;
    if (context.should_stop())
      transfers_found[k].looked_for = false;
    else
      transfers_found[k] = transfer(scenery, i, places[thread], *planners_[thread], context);
  };
  const std::size_t threads = std::min<std::size_t>(std::max(1U, context.threads), transfers_found.size());
  while (planners_.size() < threads) {
    planners_.push_back(setup_.transfer_planner());
    if (!planners_.back()) throw PluginError("transfer_planner", "nothing was made");
  }
  places.resize(std::max(places.size(), threads));
  std::atomic<std::size_t> next{0};
  parallel_for(
      threads, context,
      [&](std::size_t thread) {
        for (std::size_t k = next++; k < transfers_found.size(); k = next++) one(k, thread);
      },
      [] { return false; });
  return transfers_found;
}

PlanStep Assembler::to_step(const Scenery& scenery, std::size_t i, const Found& found, const PlanStep& there) const {
  const DisassemblyStep& step = scenery.steps[i];
  PlanStep back = reversed(there);
  back.max_penetration = std::max(there.max_penetration, found.max_penetration);
  back.planner = found.path.empty() ? "" : setup_.transfer_planner_id;
  back.seconds = found.seconds;
  back.depth = found.depth;
  back.transfer = found.path.empty() ? 0 : found.path.size() - 1;
  // If its group is not displaced, a step repeats the poses of the reversed disassembly exactly.
  const Path in = scenery.insertion(i);
  std::size_t column = 0;  // of the way
  for (std::size_t k = 0; k < step.parts.size(); ++k) {
    std::vector<Pose> poses;
    const bool waits = !step.leaves(step.parts[k]);
    for (std::size_t at = 0; at < back.transfer; ++at)
      poses.push_back(assembly_.normalization.pose_to_input(waits ? in.front()[k] : found.path[at][column]));
    if (!waits) ++column;
    if (scenery.place[scenery.done.left_group(i)].is_identity())
      poses.insert(poses.end(), back.moves[k].poses.begin(), back.moves[k].poses.end());
    else
      for (const auto& instant : in) poses.push_back(assembly_.normalization.pose_to_input(instant[k]));
    back.moves[k].poses = std::move(poses);
  }
  return back;
}

AssemblyPlan Assembler::put_together(const Disassembly& done, const std::vector<PlanStep>& written,
                                     const RunContext& context) {
  const std::vector<DisassemblyStep>& steps = done.steps();
  AssemblyPlan plan;
  std::vector<std::string> problems;
  std::size_t not_looked_for = 0;
  const auto names = [&](std::size_t i) {
    std::string text;
    for (const PartId id : steps[i].parts) text += (text.empty() ? "'" : ", '") + assembly_.parts[id].name + "'";
    return text;
  };
  Scenery scenery(done);
  place_groups(scenery, context);
  clear_insertions(scenery, context);

  // In the order of the disassembly, so that the goal of a transfer is known before its search. A group that is left
  // out has another place from then on, so transfers found for later steps are discarded. A wave holds several steps
  // per thread, so that one long search does not leave other threads idle.
  const std::size_t wave = context.threads > 1 ? 16 * context.threads : 1;
  std::vector<PartPlaces> places;  // by thread
  for (std::size_t first = 0; first < steps.size();) {
    std::vector<Found> transfers_found =
        transfers(scenery, places, first, std::min(first + wave, steps.size()), context);
    bool as_supposed = true;
    for (std::size_t k = 0; k < transfers_found.size() && as_supposed; ++k) {
      const std::size_t i = first++, made = done.group_of_step(i);
      context.progress("assembly", i, steps.size(), assembly_.parts[steps[i].parts.front()].name);
      for (const auto& [level, text] : transfers_found[k].log) context.log(level, text);
      if (!transfers_found[k].looked_for) {
        ++not_looked_for;
        scenery.leave_out(made, fmt::format("the way of {} from the layout was not looked for", names(i)));
        as_supposed = false;
      } else {
        if (scenery.missing[made].empty() && !steps[i].placement && transfers_found[k].path.empty()) {
          scenery.leave_out(
              made, fmt::format("no way from the layout was found for {}: {}", names(i), transfers_found[k].problem));
          as_supposed = false;
        }
        if (!scenery.missing[made].empty()) problems.push_back(scenery.missing[made]);
      }
      plan.steps.push_back(to_step(scenery, i, transfers_found[k], written[i]));
    }
  }
  context.progress("assembly", steps.size(), steps.size());
  std::reverse(plan.steps.begin(), plan.steps.end());
  for (std::size_t i = 0; i < plan.steps.size(); ++i) plan.steps[i].step = static_cast<unsigned>(i) + 1;
  if (not_looked_for > 0)
    problems.push_back(fmt::format("{} of {} ways from the layout were not looked for: the run was stopped before",
                                   not_looked_for, steps.size()));
  for (const auto& p : problems) plan.message += (plan.message.empty() ? "" : "; ") + p;
  if (!problems.empty()) {
    plan.status = AssemblyStatus::partial;
    context.log(LogLevel::warning, fmt::format("assembly: {}", plan.message));
  }
  return plan;
}

}  // namespace dismantle
