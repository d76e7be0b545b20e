#include "assembly_time.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "dismantle/geometry/length_unit.h"
#include "dismantle/geometry/mesh_measure.h"

namespace dismantle::checks {

namespace {

using Eigen::Vector3d;

// mm: the room that a finger needs beside a part, and the depth it reaches. No round figure, so that rounding decides
// about no wall of a design.
constexpr double kFinger = 20.03;
constexpr double kHeavy = 4.5;      // kg, 10 pounds
constexpr double kFromBelow = 0.7;  // cosine to `up`
constexpr double kSameUp = 0.995;   // cosine, as the check `reorientations`

/// Millimetres of one assembly unit. Without a unit the file is taken to be in millimetres.
double millimetres(const Assembly& assembly) {
  return (assembly.unit.empty() ? 1.0 : 1000 * metres_in(assembly.unit)) / assembly.normalization.scale;
}

bool is_kind(const Part& part, std::initializer_list<const char*> kinds) {
  return part.kind && std::any_of(kinds.begin(), kinds.end(), [&](const char* k) { return part.kind->kind == k; });
}

/// Do the moving and the present parts overlap as a press fit or a clip does?
bool is_pressed(const StepQuestion& question) {
  std::vector<int> role(question.assembly.parts.size(), 0);
  for (const PlacedPart& p : question.moving) role[p.part] = 1;
  for (const PlacedPart& p : question.present) role[p.part] = 2;
  return std::any_of(question.assembly.overlaps.begin(), question.assembly.overlaps.end(),
                     [&](const InitialOverlap& o) {
                       return role[o.a] + role[o.b] == 3 && role[o.a] * role[o.b] == 2 && o.place &&
                              (o.place->contact == ContactClass::uniform_interference ||
                               o.place->contact == ContactClass::local_interference);
                     });
}

/// Does something beside the part reach farther back than a finger does?
bool is_obstructed(const StepQuestion& question, const geometry::PartBoxes& boxes, double finger) {
  const Vector3d across = question.direction.unitOrthogonal();
  Eigen::Matrix3d frame;
  frame << across.transpose(), question.direction.cross(across).transpose(), question.direction.transpose();
  Aabb column = boxes.of(question.moving, frame);
  column.inflate(finger);
  return std::any_of(question.present.begin(), question.present.end(), [&](const PlacedPart& p) {
    const Aabb box = boxes.of(p, frame);
    return box.lo.z() < column.lo.z() && (box.lo.head<2>().array() < column.hi.head<2>().array()).all() &&
           (box.hi.head<2>().array() > column.lo.head<2>().array()).all();
  });
}

}  // namespace

void TimeParameters::describe(Schema<TimeParameters>& s) {
  s.add("table", &TimeParameters::table,
        {.doc = "Seconds of a step of your own, instead of the published ones, as WHAT=SECONDS with commas between "
                "them; WHAT "
                "is a kind of part, or the name of one with * and ?. The first one that fits counts."});
}

Time::Time(const TimeParameters& params) {
  std::istringstream words(params.table);
  for (std::string word; std::getline(words, word, ',');) {
    word.erase(0, word.find_first_not_of(' '));
    const std::size_t at = word.rfind('=');
    std::istringstream number(at == std::string::npos ? "" : word.substr(at + 1));
    double value = -1;
    if (!(number >> value) || !(number >> std::ws).eof() || !(value >= 0) || at == 0)
      throw std::invalid_argument("table: write WHAT=SECONDS with a number from 0 on instead of '" + word + "'");
    table_.emplace_back(word.substr(0, word.find_last_not_of(' ', at - 1) + 1), value);
  }
}

Vector3d Time::Scene::edges_of(const Part& part) const {
  const std::lock_guard lock(mutex);
  auto& known = edges.at(part.id);
  if (!known) known = oriented_box(*part.mesh);
  return *known;
}

Symmetry Time::Scene::symmetry(const Part& part, const Vector3d& axis) const {
  const std::vector<double> key{static_cast<double>(part.id), axis.x(), axis.y(), axis.z()};
  {
    const std::lock_guard lock(mutex);
    if (const auto known = symmetries.find(key); known != symmetries.end()) return known->second;
  }
  const Symmetry found = symmetry_of(*part.mesh, axis);
  const std::lock_guard lock(mutex);
  return symmetries.emplace(key, found).first->second;
}

std::optional<double> Time::stated(const Part& part) const {
  for (const auto& [what, seconds] : table_)
    if ((part.kind && part.kind->kind == what) || fnmatch(what.c_str(), part.name.c_str(), 0) == 0) return seconds;
  return std::nullopt;
}

StepVerdict Time::verdict_of(const StepQuestion& question, bool symmetric) const {
  StepVerdict verdict;
  if (question.moving.empty()) return verdict;
  const std::shared_ptr<const Scene> scene = scenes_.of(question.assembly);
  const auto& parts = question.assembly.parts;
  const auto larger = [&](const PlacedPart& a, const PlacedPart& b) {
    return geometry::half_surface(scene->boxes.assembled()[a.part]) <
           geometry::half_surface(scene->boxes.assembled()[b.part]);
  };
  // What several parts at once are goes by the largest one.
  const PlacedPart& main = *std::max_element(question.moving.begin(), question.moving.end(), larger);
  const Part& part = parts[main.part];
  nlohmann::json data;
  std::string text;
  if (const auto own = stated(part)) {
    verdict.cost = *own;
    text = "by the table of the user";
  } else {
    const double mm = millimetres(question.assembly);
    const bool alone = question.moving.size() == 1;
    const Aabb box = scene->boxes.of(question.moving);
    const Vector3d edges = alone ? scene->edges_of(part) : box.size();
    Handled handled{.size = edges.maxCoeff() * mm, .thickness = edges.minCoeff() * mm};
    double kilograms = 0;
    for (const PlacedPart& p : question.moving)
      kilograms += parts[p.part].density.value_or(0) * parts[p.part].volume * std::pow(mm, 3) * 1e-6;
    handled.heavy = kilograms > kHeavy;
    handled.tangles = alone && is_kind(part, {"spring", "ring"});
    if (symmetric && alone && !question.direction.isZero()) {
      const Symmetry s = scene->symmetry(part, main.pose.q.conjugate() * question.direction);
      handled.alpha = s.alpha;
      handled.beta = s.beta;
    }
    Inserted inserted;
    const bool screw = alone && is_kind(part, {"screw", "nut"});
    const bool pressed = !screw && is_pressed(question);
    inserted.secured = screw     ? Inserted::Secured::screwed
                       : pressed ? Inserted::Secured::at_once
                                 : Inserted::Secured::no;
    inserted.resisting = pressed;
    inserted.hard_to_align = question.direction.isZero();
    inserted.obstructed = !question.direction.isZero() && is_obstructed(question, scene->boxes, kFinger / mm);
    inserted.held = question.direction.dot(question.up) > kFromBelow;
    const Figure handle = handling(handled), insert = insertion(inserted);
    verdict.cost = handle.seconds + insert.seconds;
    text = fmt::format("{:.2f} to take it up, {:.1f} to {}{}{}", handle.seconds, insert.seconds,
                       screw     ? "screw it in"
                       : pressed ? "press it in"
                                 : "put it in",
                       inserted.held && !screw && !pressed ? " from below and hold it" : "",
                       inserted.obstructed ? " with little room" : "");
    data["handling"] = handle.code;
    data["insertion"] = insert.code;
  }
  if (question.previous != nullptr && question.previous->up.dot(question.up) < kSameUp) {
    verdict.cost += kTurningOver;
    text += fmt::format(", {:.0f} to turn the assembly", kTurningOver);
  }
  verdict.reason = fmt::format("{:.1f} s", verdict.cost);
  data["seconds"] = verdict.cost;
  if (verdict.cost > 0)
    verdict.notes.push_back({"time", fmt::format("About {:.1f} s: {}.", verdict.cost, text), data.dump()});
  else
    verdict.reason.clear();
  return verdict;
}

StepVerdict Time::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  return verdict_of(question, true);
}

StepVerdict Time::estimate(const StepQuestion& question, const RunContext& /*context*/) const {
  return verdict_of(question, false);
}

/// The sum is that of the steps, so that the plan itself costs nothing.
StepVerdict Time::judge_plan(std::span<const StepQuestion> operations, const RunContext& /*context*/) const {
  StepVerdict verdict;
  double sum = 0;
  for (const StepQuestion& operation : operations) sum += verdict_of(operation, true).cost;
  if (sum == 0) return verdict;
  const auto minutes = static_cast<int>(std::round(sum)) / 60, seconds = static_cast<int>(std::round(sum)) % 60;
  verdict.notes.push_back(
      {"time.sum",
       fmt::format("Assembly by hand takes about {}{} s for {} step{}, without the part that is there first{}.",
                   minutes > 0 ? fmt::format("{} min ", minutes) : "", seconds, operations.size(),
                   operations.size() == 1 ? "" : "s",
                   operations.front().assembly.unit.empty() ? "; lengths are taken to be in mm" : ""),
       nlohmann::json{{"seconds", sum}}.dump()});
  return verdict;
}

}  // namespace dismantle::checks
