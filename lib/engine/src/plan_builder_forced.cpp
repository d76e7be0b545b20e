// Forced steps of a plan, which no oracle has accepted.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "plan_builder.h"

namespace dismantle {

namespace {

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

/// Index of the proof that `moving` cannot leave `rest`: among proofs about parts of both and no others, the one about
/// the pair of `worst`, else the first.
std::optional<std::size_t> PlanBuilder::proof_against(const std::vector<PartId>& moving,
                                                      const std::vector<PartId>& rest, const MotionDepth& worst) const {
  std::vector<std::string> these, those;
  for (const PartId id : moving) these.push_back(assembly_.parts[id].name);
  for (const PartId id : rest) those.push_back(assembly_.parts[id].name);
  const auto in = [](const std::vector<std::string>& names) {
    return [&names](const std::string& name) { return has_name(names, name); };
  };
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < plan_.certificates.size(); ++k) {
    const std::vector<std::string>& about = plan_.certificates[k].parts;
    const bool divided =
        std::any_of(about.begin(), about.end(), in(these)) && std::any_of(about.begin(), about.end(), in(those)) &&
        std::all_of(about.begin(), about.end(), [&](const std::string& n) { return in(these)(n) || in(those)(n); });
    if (!divided) continue;
    if (!best) best = k;
    if (about.size() == 2 && has_name(about, assembly_.parts[worst.part].name) &&
        has_name(about, assembly_.parts[worst.other].name))
      return k;
  }
  return best;
}

/// Why no verified path is known: a proof, or the message and the cost of the searches, in machine-independent counts.
std::string PlanBuilder::why_forced(const std::vector<PartId>& parts, std::optional<std::size_t> proof) const {
  std::string text = proof ? plan_.certificates[*proof].text : std::string();
  if (proof && plan_.certificates[*proof].full_tolerance) return text;
  SearchEffort effort;
  for (const PartId id : parts) {
    const std::string& name = assembly_.parts[id].name;
    const auto u = std::find_if(plan_.unsolved.begin(), plan_.unsolved.end(),
                                [&](const PlanUnsolved& left) { return left.part == name; });
    if (u != plan_.unsolved.end() && !u->certificate && text.empty()) text = u->message;
    const SearchEffort own = oracle_.effort_on(id);
    effort.attempts += own.attempts;
    effort.depth = std::max(effort.depth, own.depth);
    effort.cost += own.cost;
  }
  if (!text.empty()) text += "; ";
  if (effort.attempts == 0) return text + "no straight motion was found to be valid, and no search came to its end";
  return text + fmt::format("{} of '{}'{}, {:.0f} steps and state checks, found no path",
                            effort.attempts == 1 ? "1 search" : fmt::format("{} searches", effort.attempts),
                            planner_id_, effort.depth == 0 ? "" : fmt::format(" to depth {}", effort.depth),
                            effort.cost);
}

void PlanBuilder::force(const std::vector<PartId>& parts, const Path& path, const MotionDepth& worst, bool exact,
                        const Certificate* proof, double seconds) {
  std::vector<PartId>& group = group_of(parts);
  const auto moves = [&](PartId id) { return std::find(parts.begin(), parts.end(), id) != parts.end(); };
  std::vector<PartId> rest;
  std::copy_if(group.begin(), group.end(), std::back_inserter(rest), [&](PartId id) { return !moves(id); });
  if (rest.empty()) throw std::logic_error("a forced step that leaves nothing behind");
  AttemptResult no_answer;  // the constraints are only checked on the moving parts
  check_constraints({parts, &no_answer}, rest);

  const Normalization& to = assembly_.normalization;
  const InitialOverlap* overlap = assembly_.overlap_of(worst.part, worst.other);
  PlanStep step;
  step.step = static_cast<unsigned>(plan_.disassembly.size()) + 1;
  step.separates.emplace_back();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PlanMove move{assembly_.parts[parts[i]].name, {}};
    for (const auto& instant : path) move.poses.push_back(to.pose_to_input(instant[i]));
    step.separates.back().push_back(move.part);
    step.moves.push_back(std::move(move));
    poses_[parts[i]] = path.back()[i];
  }
  step.seconds = seconds;
  step.planner = "forced";
  step.depth = 1;
  step.contacts = {assembly_.parts.at(worst.other).name};
  step.forced = PlanForced{assembly_.parts.at(worst.part).name,
                           assembly_.parts.at(worst.other).name,
                           worst.depth / to.scale,
                           (overlap == nullptr ? 0 : overlap->depth) / to.scale,
                           to.to_input(worst.point),
                           {},
                           proof != nullptr ? index_of(*proof) : proof_against(parts, rest, worst),
                           !exact};
  step.forced->reason = why_forced(parts, step.forced->certificate);

  const auto from = static_cast<std::size_t>(&group - groups_.data());
  plan_.assembly_steps.insert(plan_.assembly_steps.begin(), reversed(step));
  plan_.disassembly.push_back(std::move(step));
  for (std::size_t i = 0; i < plan_.assembly_steps.size(); ++i)
    plan_.assembly_steps[i].step = static_cast<unsigned>(i) + 1;
  recorded_.push_back({parts, from, std::make_shared<const Path>(path), false, {}});
  groups_[from] = std::move(rest);
  groups_.push_back(parts);
  ++forced_;
  refresh_status();
}

void PlanBuilder::drop_solved() {
  const std::vector<PartId> together = left();
  std::erase_if(plan_.unsolved, [&](const PlanUnsolved& u) {
    return std::none_of(together.begin(), together.end(),
                        [&](PartId id) { return assembly_.parts[id].name == u.part; });
  });
}

std::vector<std::vector<PlacedPart>> PlanBuilder::open_groups() const {
  std::vector<std::vector<PlacedPart>> open;
  if (fulfilled()) return open;
  for (const auto& group : groups_) {
    if (stays_together(group)) continue;
    std::vector<PlacedPart> placed;
    for (const PartId id : group) placed.push_back({id, poses_[id]});
    std::sort(placed.begin(), placed.end(), [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; });
    open.push_back(std::move(placed));
  }
  return open;
}

}  // namespace dismantle
