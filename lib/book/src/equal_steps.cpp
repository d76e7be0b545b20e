#include "equal_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/step_runs.h"

namespace dismantle {
namespace {

class Joiner {
 public:
  Joiner(const Plan& plan, const Assembly& assembly, const std::vector<std::size_t>& items) {
    std::map<std::string, std::size_t> index_of;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) index_of.emplace(assembly.parts[i].name, i);
    const std::vector<StepRun> runs = step_runs(plan, shapes_of(plan, assembly, items));
    for (std::size_t r = 0; r < runs.size(); ++r) run_of_.insert(run_of_.end(), runs[r].count, r);
    for (const PlanComponent& component : plan.assembly.components) {
      if (!component.kept) continue;
      std::vector<std::size_t> bodies;
      for (const std::string& name : component.parts)
        if (const auto known = index_of.find(name); known != index_of.end()) bodies.push_back(known->second);
      std::ranges::sort(bodies);
      products_.insert(std::move(bodies));
    }
    const double size = assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff();
    still_ = 1e-6 * size;  // poses in a plan are rounded
    tolerance_ = stretch_tolerance(size);
  }

  std::vector<BookStep> joined(std::vector<BookStep> steps) const {
    std::vector<BookStep> out;
    for (BookStep& step : steps) {
      if (!out.empty() && follows(out.back(), step))
        append(out.back(), std::move(step));
      else
        out.push_back(std::move(step));
    }
    return out;
  }

 private:
  bool alone(const BookStep& step) const {
    if (step.shifts_only || step.movers.size() != 1) return false;
    const BookMover& mover = step.movers.front();
    if (mover.parts.size() > 1 && !products_.contains(mover.parts)) return false;
    const Eigen::Vector3d point = point_on_axis(mover.poses, mover.center);
    return summarize_motion(mover.poses, point, tolerance_).stretches.size() == 1;
  }

  bool near(const Pose& a, const Pose& b) const {
    return (a.t - b.t).norm() <= still_ && a.q.angularDistance(b.q) < 1e-6;
  }

  /// Does each part that both steps know stand at the same place in both? Poses are relative to the largest part that
  /// stays, which may be another one.
  bool same_base(const BookStep& a, const BookStep& b) const {
    std::map<std::size_t, const Pose*> first;
    for (const PlacedPart& part : a.standing) first.emplace(part.part, &part.pose);
    return std::ranges::all_of(b.standing, [&](const PlacedPart& part) {
      const auto known = first.find(part.part);
      return known == first.end() || near(*known->second, part.pose);
    });
  }

  bool follows(const BookStep& before, const BookStep& next) const {
    const std::size_t last = before.joined.empty() ? before.plan_step : before.joined.back();
    const bool neighbours = last + 1 == next.plan_step || next.plan_step + 1 == last;
    if (!neighbours || run_of_[last] != run_of_[next.plan_step] || !alone(next)) return false;
    return (!before.joined.empty() || alone(before)) && same_base(before, next);
  }

  static void append(BookStep& to, BookStep&& next) {
    to.joined.push_back(next.plan_step);
    if (next.standing.size() < to.standing.size()) to.standing = std::move(next.standing);  // taken apart
    to.movers.push_back(std::move(next.movers.front()));
  }

  std::vector<std::size_t> run_of_;              // by step of the plan
  std::set<std::vector<std::size_t>> products_;  // bodies of what is kept together
  double still_ = 0, tolerance_ = 0;             // input units
};

/// The text with the names of parts between quotes replaced.
std::string renamed(const std::string& text, const std::function<std::string(const std::string&)>& name_of) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == '\'' ? text.find('\'', at + 1) : std::string::npos;
    if (end == std::string::npos) {
      out += text[at++];
      continue;
    }
    out += "'" + name_of(text.substr(at + 1, end - at - 1)) + "'";
    at = end + 1;
  }
  return out;
}

}  // namespace

void join_equal_steps(std::vector<BookChapter>& chapters, const Plan& plan, const Assembly& assembly,
                      const std::vector<std::size_t>& items) {
  const Joiner joiner(plan, assembly, items);
  for (BookChapter& chapter : chapters) chapter.steps = joiner.joined(std::move(chapter.steps));
}

Facts facts_of_all(const std::vector<Facts>& each, const std::string& order,
                   const std::function<std::string(const std::string& part)>& name_of) {
  if (each.size() == 1) return each.front();
  struct Said {
    std::string name, text, common;
    std::set<std::size_t> steps;
  };
  std::vector<Said> all;
  for (std::size_t s = 0; s < each.size(); ++s)
    for (const auto& [name, text] : each[s]) {
      if (s > 0 && name == order) continue;
      std::string common = renamed(text, name_of);
      const auto same =
          std::ranges::find_if(all, [&, &name = name](const Said& k) { return k.name == name && k.common == common; });
      if (same == all.end())
        all.push_back({name, text, std::move(common), {s}});
      else
        same->steps.insert(s);
    }
  Facts out;
  for (const Said& said : all) {
    const bool part = said.steps.size() < each.size() && said.name != order;
    const std::string& text = said.steps.size() > 1 ? said.common : said.text;
    out.emplace_back(said.name, part ? fmt::format("({} / {}) {}", said.steps.size(), each.size(), text) : text);
  }
  return out;
}

}  // namespace dismantle
