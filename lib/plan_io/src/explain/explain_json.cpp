#include <numbers>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "json/json_text.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const Pose& p) { return {p.t.x(), p.t.y(), p.t.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z()}; }

Json part_json(const LeftPart& part) {
  Json blockers = Json::array();
  for (const Blocker& b : part.blockers) {
    Json one = {{"part", b.part}};
    if (b.at) one["at"] = {b.at->x(), b.at->y(), b.at->z()};
    if (b.overlap > 0) one["overlap"] = b.overlap;
    blockers.push_back(std::move(one));
  }
  return {{"part", part.part},
          {"blocked_by", std::move(blockers)},
          {"travel", part.travel},
          {"turn_degrees", part.turn * 180 / std::numbers::pi},
          {"best_pose", pose_json(part.best_pose)},
          {"planner", part.planner},
          {"attempts", part.attempts},
          {"depth", part.depth},
          {"seconds", part.seconds},
          {"message", part.message}};
}

Json reason_json(const Plan& plan, const LeftReason& reason) {
  Json parts = Json::array();
  for (const LeftPart& part : reason.parts) parts.push_back(part_json(part));
  Json out = {
      {"outcome", std::string(to_string(reason.outcome))}, {"meaning", reason.meaning}, {"parts", std::move(parts)}};
  if (const PlanCertificate* c = reason.certificate; c != nullptr)
    out["certificate"] = {{"number", reason.certificate_number},
                          {"kind", c->kind},
                          {"parts", c->parts},
                          {"full_tolerance", c->full_tolerance},
                          {"margin", plan.assembly.scale > 0 ? c->margin / plan.assembly.scale : c->margin},
                          {"text", c->text}};
  out["advice"] = reason.advice;
  return out;
}

Json fastener_json(const JobFastener& f) {
  Json out = {{"kind", f.kind},   {"size", f.size},   {"drive", f.drive},
              {"tools", f.tools}, {"steps", f.steps}, {"parts", f.parts}};
  if (f.torque) out["torque"] = *f.torque;
  if (!f.glue.empty()) out["glue"] = f.glue;
  return out;
}

}  // namespace

std::string explain_json(const Explanation& e) {
  const Plan& plan = *e.plan;
  Json steps = Json::array(), left = Json::array(), excluded = Json::array();
  for (const StepReason& s : e.steps) {
    Json one = {{"step", s.step}, {"assembly_step", step_number(plan, s.step - 1, false)}, {"parts", s.parts}};
    if (s.known) one["after"] = s.after;
    if (s.known) one["waited_for"] = s.waited_for;
    one["contacts"] = s.contacts;
    if (const auto& forced = plan.disassembly.at(s.step - 1).forced) {
      one["forced"] = {{"pair", Json::array({forced->part, forced->other})},
                       {"depth", forced->depth},
                       {"assembled", forced->assembled},
                       {"reason", forced->reason}};
      const PlanStep& step = plan.disassembly[s.step - 1];
      if (const std::string text = reached_text(plan, length_unit(plan), step); !text.empty()) {
        one["forced"]["how_far"] = text;
        for (const PlanMove& move : step.moves)
          one["forced"]["reached"].push_back({{"part", move.part}, {"pose", pose_json(move.poses.at(step.transfer))}});
      }
      if (const std::string line = acceptance_line(*forced); !line.empty()) one["forced"]["accept"] = line;
      if (forced->certificate) one["forced"]["certificate"] = *forced->certificate + 1;
      if (forced->lower_bound) one["forced"]["lower_bound"] = true;
    }
    for (const PlanVerdict& verdict : plan.disassembly.at(s.step - 1).checks)
      for (const StepNote& note : verdict.notes) one["notes"].push_back(note.text);
    if (const std::string other = other_place_words(plan, s.step - 1, true); !other.empty()) one["elsewhere"] = other;
    steps.push_back(std::move(one));
  }
  for (const LeftReason& reason : e.left) left.push_back(reason_json(plan, reason));
  for (const PlanExcluded& part : plan.assembly.excluded)
    excluded.push_back({{"name", part.name}, {"reason", part.reason}});
  const JobList job = job_list(plan);
  Json fasteners = Json::array(), tools = Json::array();
  for (const JobFastener& f : job.fasteners) fasteners.push_back(fastener_json(f));
  for (const JobTool& t : job.tools)
    tools.push_back({{"id", t.id}, {"name", t.name}, {"fasteners", t.fasteners}, {"steps", t.steps}});
  const Json out = {{"status", result_word(plan)},
                    {"unit", plan.assembly.unit.empty() ? "input units" : plan.assembly.unit},
                    {"parts", plan.assembly.parts.size()},
                    {"left", std::move(left)},
                    {"untried", e.untried},
                    {"steps", std::move(steps)},
                    {"fasteners", std::move(fasteners)},
                    {"tools", std::move(tools)},
                    {"excluded", std::move(excluded)}};
  return json_text(out);
}

}  // namespace dismantle
