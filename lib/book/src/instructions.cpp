#include "instructions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "dismantle/errors.h"
#include "dismantle/plan_io/groups.h"

namespace dismantle {
namespace {

class InstructionWriter {
 public:
  InstructionWriter(const Plan& plan, const Assembly& assembly, bool disassembly)
      : plan_(plan), assembly_(assembly), disassembly_(disassembly) {
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
      index_.emplace(assembly.parts[i].name, i);
      const Aabb box = assembly.parts[i].mesh->box();
      centers_.push_back(assembly.normalization.to_input(box.center()));
      radii_.push_back(0.5 * box.size().norm() / assembly.normalization.scale);
    }
    const double size = assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff();
    still_ = 1e-6 * size;  // poses in a plan are rounded
  }

  std::vector<BookChapter> write() {
    follow();
    std::vector<BookChapter> out;
    emit(0, out);
    int letter = 0;
    for (BookChapter& chapter : out)
      if (chapter.letter == 0) chapter.letter = letter++;
    return out;
  }

 private:
  struct Group {
    std::vector<std::size_t> parts, rest;
    std::vector<BookStep> steps;          // in the order of the plan
    std::vector<std::size_t> taken_from;  // groups, in the order of the plan
  };

  std::size_t index_of(const std::string& name) const {
    const auto it = index_.find(name);
    if (it == index_.end()) throw InputError(name, "the plan has a part that the assembly lacks");
    return it->second;
  }
  std::vector<std::size_t> indices(const std::vector<std::size_t>& of_plan) const {
    std::vector<std::size_t> out;
    for (const std::size_t i : of_plan) out.push_back(index_of(plan_.assembly.parts[i].name));
    std::ranges::sort(out);
    return out;
  }

  /// Replays the plan to collect the steps of each group and the tree of groups.
  void follow() {
    std::vector<std::size_t> all;
    for (const PlanPart& part : plan_.assembly.parts) all.push_back(index_of(part.name));
    std::ranges::sort(all);
    groups_.push_back({all, all, {}, {}});
    group_of_.assign(assembly_.parts.size(), 0);
    now_.assign(assembly_.parts.size(), Pose{});
    const auto splits = follow_groups(plan_);
    for (std::size_t s = 0; s < plan_.disassembly.size(); ++s) {
      const PlanStep& step = plan_.disassembly[s];
      if (splits[s].size() > 1)
        throw InputError(fmt::format("step {}", step.step), "takes parts from two groups, which no page can show");
      if (!splits[s].empty()) {
        const auto rest = indices(splits[s].front().rest);
        const std::size_t group = group_of_[rest.front()];
        groups_[group].steps.push_back(page(step, groups_[group].rest, rest));
        groups_[group].rest = rest;
        for (const auto& piece : splits[s].front().out) {
          const auto parts = indices(piece);
          for (const std::size_t i : parts) group_of_[i] = groups_.size();
          groups_[group].taken_from.push_back(groups_.size());
          groups_.push_back({parts, parts, {}, {}});
        }
      } else if (!step.moves.empty()) {
        const std::size_t group = group_of_[index_of(step.moves.front().part)];
        groups_[group].steps.push_back(page(step, groups_[group].rest, groups_[group].rest));
        groups_[group].steps.back().shifts_only = true;
      }
      for (const PlanMove& move : step.moves) now_[index_of(move.part)] = move.poses.back();
    }
  }

  /// The step relative to the largest part of `staying`; parts that do not move are preferred.
  BookStep page(const PlanStep& step, const std::vector<std::size_t>& whole, const std::vector<std::size_t>& staying) {
    std::map<std::size_t, const std::vector<Pose>*> moved;
    for (const PlanMove& move : step.moves) moved[index_of(move.part)] = &move.poses;
    const auto better = [&](std::size_t a, std::size_t b) {
      const auto key = [&](std::size_t i) { return std::pair(moved.contains(i) ? 0 : 1, radii_[i]); };
      return key(a) < key(b);
    };
    const std::size_t seen_from = *std::ranges::max_element(staying, better);
    const std::size_t count = step.moves.empty() ? 1 : step.moves.front().poses.size();
    const auto pose_at = [&](std::size_t part, std::size_t k) {
      const auto it = moved.find(part);
      return it == moved.end() ? now_[part] : (*it->second)[k];
    };
    BookStep out;
    out.plan_step = step.step;
    for (const std::size_t part : whole) {
      std::vector<Pose> poses;
      for (std::size_t k = 0; k < count; ++k) poses.push_back(pose_at(seen_from, k).inverse() * pose_at(part, k));
      if (!disassembly_) std::ranges::reverse(poses);
      if (!moves(part, poses)) {
        out.standing.push_back({part, poses.front()});
        continue;
      }
      const auto same =
          std::ranges::find_if(out.movers, [&](const BookMover& m) { return together(m.poses, poses, part); });
      if (same != out.movers.end())
        same->parts.push_back(part);
      else
        out.movers.push_back({{part}, std::move(poses), Eigen::Vector3d::Zero()});
    }
    for (BookMover& mover : out.movers) {
      Aabb box;
      for (const std::size_t part : mover.parts) {
        const Aabb internal = assembly_.parts[part].mesh->box();
        box.extend(assembly_.normalization.to_input(internal.lo));
        box.extend(assembly_.normalization.to_input(internal.hi));
      }
      mover.center = box.center();
    }
    return out;
  }

  bool moves(std::size_t part, const std::vector<Pose>& poses) const {
    return std::ranges::any_of(
        poses, [&](const Pose& p) { return screw_travel(poses.front(), p, centers_[part], radii_[part]) > still_; });
  }
  bool together(const std::vector<Pose>& a, const std::vector<Pose>& b, std::size_t part) const {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (screw_travel(a[k], b[k], centers_[part], radii_[part]) > still_) return false;
    return true;
  }

  void emit(std::size_t number, std::vector<BookChapter>& out) {
    const auto children = [&] {
      for (const std::size_t child : groups_[number].taken_from) emit(child, out);
    };
    if (!disassembly_) children();
    Group& group = groups_[number];
    if (!group.steps.empty()) {
      if (!disassembly_) std::ranges::reverse(group.steps);
      out.push_back({group.parts, group.rest, std::move(group.steps), number == 0 ? -1 : 0});
    }
    if (disassembly_) children();
  }

  const Plan& plan_;
  const Assembly& assembly_;
  const bool disassembly_;
  std::map<std::string, std::size_t> index_;
  std::vector<Eigen::Vector3d> centers_;
  std::vector<double> radii_;
  double still_ = 0;  // input units: smaller motions relative to the base are ignored
  std::vector<Group> groups_;
  std::vector<std::size_t> group_of_;
  std::vector<Pose> now_;
};

}  // namespace

std::vector<BookChapter> instructions(const Plan& plan, const Assembly& assembly, bool disassembly) {
  return InstructionWriter(plan, assembly, disassembly).write();
}

}  // namespace dismantle
