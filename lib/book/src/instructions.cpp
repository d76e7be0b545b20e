#include "instructions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/plan_io/step_numbers.h"

namespace dismantle {
namespace {

class InstructionWriter {
 public:
  InstructionWriter(const Plan& plan, const Assembly& assembly, bool disassembly)
      : plan_(plan), history_(plan), assembly_(assembly), disassembly_(disassembly) {
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
    find_steps();
    std::vector<BookChapter> out;
    emit(0, out);
    std::vector<BookChapter*> named;
    for (BookChapter& chapter : out)
      if (chapter.letter == 0) named.push_back(&chapter);
    std::ranges::sort(named, {}, [](const BookChapter* chapter) { return chapter->steps.front().number; });
    for (std::size_t k = 0; k < named.size(); ++k) named[k]->letter = static_cast<int>(k);
    return out;
  }

 private:
  struct Group {
    std::vector<std::size_t> parts, rest;  // when it comes to be, and at the end
    std::vector<BookStep> steps;           // in the order of the plan
    std::vector<std::size_t> taken_from;   // groups, in the order of the plan
  };

  std::size_t index_of(const std::string& name) const {
    const auto it = index_.find(name);
    if (it == index_.end()) throw InputError(name, "the plan has a part that the assembly lacks");
    return it->second;
  }
  /// Parts of a group after `done` steps, ascending.
  std::vector<std::size_t> members(std::size_t group, std::size_t done) const {
    std::vector<std::size_t> out;
    for (const std::size_t i : history_.members(group, done)) out.push_back(index_of(plan_.assembly.parts[i].name));
    std::ranges::sort(out);
    return out;
  }

  /// Collects the steps of each group and the tree of groups.
  void find_steps() {
    groups_.resize(history_.groups());
    groups_[0].parts = members(0, 0);
    for (std::size_t s = 0; s < history_.steps(); ++s) {
      const PlanStep& step = plan_.disassembly[s];
      const auto& splits = history_.splits(s);
      if (splits.size() > 1)
        throw InputError(fmt::format("step {}", step.step), "takes parts from two groups, which no page can show");
      if (!splits.empty()) {
        Group& group = groups_[splits.front().from];
        group.steps.push_back(page(s, splits.front().from));
        group.taken_from.insert(group.taken_from.end(), splits.front().out.begin(), splits.front().out.end());
        for (const std::size_t piece : splits.front().out) groups_[piece].parts = members(piece, s + 1);
      } else if (!step.moves.empty()) {
        const std::size_t group = history_.group_of(history_.index_of(step.moves.front().part), s);
        groups_[group].steps.push_back(page(s, group));
        groups_[group].steps.back().shifts_only = true;
      }
    }
    for (std::size_t g = 0; g < groups_.size(); ++g) groups_[g].rest = members(g, history_.steps());
  }

  /// What step `s` does to a group, relative to the largest part that stays in it; parts that do not move are
  /// preferred.
  BookStep page(std::size_t s, std::size_t group) const {
    const PlanStep& step = plan_.disassembly[s];
    const std::vector<std::size_t> whole = members(group, s), staying = members(group, s + 1);
    std::map<std::size_t, const std::vector<Pose>*> moved;
    for (const PlanMove& move : step.moves) moved[index_of(move.part)] = &move.poses;
    const auto better = [&](std::size_t a, std::size_t b) {
      const auto key = [&](std::size_t i) { return std::pair(moved.contains(i) ? 0 : 1, radii_[i]); };
      return key(a) < key(b);
    };
    const std::size_t seen_from = *std::ranges::max_element(staying, better);
    const std::size_t count = step.moves.empty() ? 1 : step.moves.front().poses.size();
    const auto poses_of = [&](std::size_t part) {
      const auto it = moved.find(part);
      if (it != moved.end()) return *it->second;
      return std::vector<Pose>(count, history_.pose_of(history_.index_of(assembly_.parts[part].name), s));
    };
    const std::vector<Pose> base = poses_of(seen_from);
    BookStep out;
    out.number = step_number(plan_, s, disassembly_);
    out.plan_step = s;
    if (step.up) out.up = base.front().q.conjugate() * *step.up;
    for (DrawnTool& tool : drawn_tools(step.checks)) {
      const Pose back = base.front().inverse();
      tool.origin = back * tool.origin;
      tool.axis = back.q * tool.axis;
      tool.x = back.q * tool.x;
      out.tools.push_back(std::move(tool));
    }
    for (const std::size_t part : whole) {
      std::vector<Pose> poses = poses_of(part);
      for (std::size_t k = 0; k < count; ++k) poses[k] = base[k].inverse() * poses[k];
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
  const PlanHistory history_;
  const Assembly& assembly_;
  const bool disassembly_;
  std::map<std::string, std::size_t> index_;
  std::vector<Eigen::Vector3d> centers_;
  std::vector<double> radii_;
  double still_ = 0;  // input units: smaller motions relative to the base are ignored
  std::vector<Group> groups_;
};

}  // namespace

std::vector<BookChapter> instructions(const Plan& plan, const Assembly& assembly, bool disassembly) {
  return InstructionWriter(plan, assembly, disassembly).write();
}

}  // namespace dismantle
