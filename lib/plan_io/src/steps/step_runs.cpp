#include "dismantle/plan_io/step_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dismantle/errors.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan_io/bill_items.h"
#include "dismantle/plan_io/motion_words.h"

namespace dismantle {
namespace {

constexpr double kSameDirection = 0.999;  // cosine: 2.6 degrees
constexpr double kSameTurn = 0.1;         // of the larger: threads end anywhere
constexpr double kNoTurn = 0.05;          // rad

/// "screw" of "screw#3": parts of one name are numbered when the file is read.
std::string stem_of(const std::string& name) {
  const std::size_t mark = name.rfind('#');
  const bool numbered = mark != std::string::npos && mark + 1 < name.size() &&
                        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(mark) + 1, name.end(),
                                    [](unsigned char c) { return c >= '0' && c <= '9'; });
  return numbered ? name.substr(0, mark) : name;
}

/// What has to be equal in two steps of a run, except for the motion.
struct Taken {
  std::vector<std::size_t> moved;                   // shapes, sorted
  std::vector<std::vector<std::size_t>> separated;  // shapes, sorted
  bool operator==(const Taken&) const = default;
};

class Runs {
 public:
  Runs(const Plan& plan, const PartShapes& shapes) : plan_(plan) {
    for (std::size_t i = 0; i < plan.assembly.parts.size(); ++i)
      shape_of_.emplace(plan.assembly.parts[i].name, shapes.at(i));
    const Aabb& box = plan.assembly.box;
    size_ = box.empty() ? 1 : std::max(box.size().maxCoeff(), 1e-300);
    middle_ = box.empty() ? plan.assembly.center : box.center();
    for (const PlanStep& step : plan.disassembly) {
      taken_.push_back(taken(step));
      motions_.push_back(motion(step));
    }
  }

  bool alike(std::size_t a, std::size_t b) const {
    const PlanStep &first = plan_.disassembly[a], &other = plan_.disassembly[b];
    return !first.forced && !other.forced && !first.moves.empty() && !first.separates.empty() &&
           taken_[a] == taken_[b] && first.up == other.up && alike(motions_[a], motions_[b]);
  }

 private:
  std::vector<std::size_t> shapes(const std::vector<std::string>& names) const {
    std::vector<std::size_t> out;
    for (const std::string& name : names) {
      const auto known = shape_of_.find(name);
      if (known == shape_of_.end()) throw InputError(name, "a step has a part that the assembly of the plan lacks");
      out.push_back(known->second);
    }
    std::ranges::sort(out);
    return out;
  }

  Taken taken(const PlanStep& step) const {
    Taken out;
    std::vector<std::string> names;
    for (const PlanMove& move : step.moves) names.push_back(move.part);
    out.moved = shapes(names);
    for (const auto& group : step.separates) out.separated.push_back(shapes(group));
    std::ranges::sort(out.separated);
    return out;
  }

  MotionSummary motion(const PlanStep& step) const {
    if (step.moves.empty()) return {};
    const std::vector<Pose>& poses = step.moves.front().poses;
    return summarize_motion(poses, point_on_axis(poses, middle_), stretch_tolerance(size_));
  }

  static bool alike(const MotionSummary& a, const MotionSummary& b) {
    if (a.stretches.size() != b.stretches.size()) return false;
    const auto along = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
      return p.dot(q) >= kSameDirection * p.norm() * q.norm();
    };
    for (std::size_t k = 0; k < a.stretches.size(); ++k)
      if (!along(a.stretches[k], b.stretches[k])) return false;
    const double turn = std::max(a.turn, b.turn);
    return turn < kNoTurn || (std::abs(a.turn - b.turn) <= kSameTurn * turn && along(a.axis, b.axis));
  }

  const Plan& plan_;
  std::map<std::string, std::size_t> shape_of_;
  double size_ = 1;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  std::vector<Taken> taken_;
  std::vector<MotionSummary> motions_;
};

}  // namespace

PartShapes shapes_of(const Plan& plan, const Assembly& assembly) {
  return shapes_of(plan, assembly, bill_items(plan.assembly, assembly, geometry::find_congruent(assembly.parts)));
}

PartShapes shapes_of(const Plan& plan, const Assembly& assembly, const std::vector<std::size_t>& items) {
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) index_of.emplace(assembly.parts[i].name, i);
  PartShapes out;
  for (const PlanPart& part : plan.assembly.parts) {
    const auto known = index_of.find(part.name);
    if (known == index_of.end()) throw InputError(part.name, "the plan has a part that the assembly lacks");
    out.push_back(items[known->second]);
  }
  return out;
}

PartShapes shapes_of(const Plan& plan) {
  // A body of a component is that of the same place in another use of the product.
  std::map<std::string, std::pair<std::string, std::size_t>> body_of;
  for (const PlanComponent& component : plan.assembly.components)
    for (std::size_t k = 0; k < component.parts.size(); ++k)
      body_of[component.parts[k]] = {component.product, component.parts.size() * 4096 + k};
  using Key = std::tuple<std::string, std::size_t, std::string, std::string, std::string>;
  std::map<Key, std::size_t> numbers;  // the first part of each
  PartShapes out;
  for (std::size_t i = 0; i < plan.assembly.parts.size(); ++i) {
    const PlanPart& part = plan.assembly.parts[i];
    const auto body = body_of.find(part.name);
    const PartKind kind = part.kind.value_or(PartKind{});
    if (body != body_of.end())
      out.push_back(numbers.try_emplace(Key{body->second.first, body->second.second, "", "", ""}, i).first->second);
    else if (!part.product.empty())
      out.push_back(
          numbers.try_emplace(Key{part.product, 0, stem_of(part.name), kind.kind, kind.size}, i).first->second);
    else
      out.push_back(i);
  }
  return out;
}

std::vector<StepRun> step_runs(const Plan& plan, const PartShapes& shapes) {
  const Runs runs(plan, shapes);
  std::vector<StepRun> out;
  for (std::size_t s = 0; s < plan.disassembly.size(); ++s) {
    if (!out.empty() && runs.alike(out.back().first, s))
      ++out.back().count;
    else
      out.push_back({s, 1});
  }
  return out;
}

std::string run_words(const Plan& plan, const StepRun& run) {
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < plan.assembly.parts.size(); ++i) index_of.emplace(plan.assembly.parts[i].name, i);
  std::string name;
  std::size_t least = plan.assembly.parts.size();
  for (std::size_t s = run.first; s < run.first + run.count; ++s)
    for (const PlanMove& move : plan.disassembly[s].moves)
      if (const auto known = index_of.find(move.part); known != index_of.end() && known->second < least) {
        least = known->second;
        name = move.part;
      }
  const std::size_t each = plan.disassembly[run.first].moves.size();
  return fmt::format("{}x {}{}", run.count, stem_of(name), each > 1 ? fmt::format(" and {} more", each - 1) : "");
}

}  // namespace dismantle
