// Plan -> plan.json (docs/plan-format.md).
#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "json/hex_colour.h"
#include "json/json_text.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json pose_json(const Pose& p, double sign) {
  return Json::array({p.t.x(), p.t.y(), p.t.z(), sign * p.q.w(), sign * p.q.x(), sign * p.q.y(), sign * p.q.z()});
}

/// +1 or -1: makes the first of w, x, y, z that is not zero positive.
double canonical_sign(const Eigen::Quaterniond& q) {
  for (const double c : {q.w(), q.x(), q.y(), q.z()})
    if (c != 0) return c < 0 ? -1 : 1;
  return 1;
}

/// q and -q are one rotation. The first pose gets the canonical sign and each of the others that of its
/// predecessor, so that a reader who interpolates the numbers never turns the long way round.
Json poses_json(const std::vector<Pose>& poses) {
  Json out = Json::array();
  Eigen::Vector4d before = Eigen::Vector4d::Zero();
  for (const Pose& p : poses) {
    double sign = canonical_sign(p.q);
    if (!out.empty() && before.dot(p.q.coeffs()) != 0) sign = before.dot(p.q.coeffs()) < 0 ? -1 : 1;
    before = sign * p.q.coeffs();
    out.push_back(pose_json(p, sign));
  }
  return out;
}

Json box_json(const Aabb& box) { return Json::array({vector_json(box.lo), vector_json(box.hi)}); }

Json step_overlap_json(const PlanStepOverlap& o) {
  Json out = {
      {"pair", Json::array({o.part, o.other})}, {"assembled", o.assembled}, {"allowed", o.allowed}, {"depth", o.depth}};
  if (o.at) out["at"] = vector_json(*o.at);
  if (o.region) out["region"] = box_json(*o.region);
  return out;
}

Json step_json(const PlanStep& s, bool assembly) {
  Json moves = Json::array();
  for (const PlanMove& m : s.moves) moves.push_back({{"part", m.part}, {"poses", poses_json(m.poses)}});
  Json out = {{"step", s.step}, {"moves", std::move(moves)}};
  if (assembly) out["transfer"] = s.transfer;
  out["separates"] = s.separates;
  out["max_penetration"] = s.max_penetration;
  out["seconds"] = s.seconds;
  out["planner"] = s.planner;
  out["depth"] = s.depth;
  out["contacts"] = s.contacts;
  if (!assembly) {
    out["after"] = s.after;
    out["layer"] = s.layer;
    for (const PlanStepOverlap& o : s.overlaps) out["overlaps"].push_back(step_overlap_json(o));
  }
  if (s.forced) {
    Json& forced = out["forced"];
    forced = {{"pair", Json::array({s.forced->part, s.forced->other})},
              {"depth", s.forced->depth},
              {"assembled", s.forced->assembled},
              {"at", vector_json(s.forced->at)},
              {"reason", s.forced->reason}};
    if (s.forced->certificate) forced["certificate"] = *s.forced->certificate;
    if (s.forced->lower_bound) forced["lower_bound"] = true;
  }
  return out;
}

Json steps_json(const std::vector<PlanStep>& steps, bool assembly) {
  Json out = Json::array();
  for (const PlanStep& s : steps) out.push_back(step_json(s, assembly));
  return out;
}

Json import_json(const ImportParams& params) {
  Json out;
  for (const auto& [importer, values] : params)
    for (const auto& [name, value] : values)
      out[importer][name] = std::visit(
          [&whole = value](const auto& v) {
            if constexpr (std::is_constructible_v<Json, decltype(v)>)
              return Json(v);
            else
              return Json(to_text(whole));  // a choice of plugins
          },
          value);
  return out;
}

Json overlap_json(const PlanOverlap& o) {
  Json out = {{"a", o.a}, {"b", o.b}, {"depth", o.depth}};
  if (o.declared) out["declared"] = *o.declared;
  if (o.flexible) out["flexible"] = true;
  if (!o.place) return out;
  out["class"] = std::string(to_string(o.place->contact));
  out["at"] = vector_json(o.place->at);
  out["region"] = box_json(o.place->region);
  out["share"] = o.place->share;
  if (o.place->axis)
    out["axis"] = {{"point", vector_json(o.place->axis_point)}, {"direction", vector_json(*o.place->axis)}};
  return out;
}

Json assembly_json(const PlanAssembly& a) {
  Json parts = Json::array(), excluded = Json::array(), overlaps = Json::array();
  for (const PlanPart& p : a.parts) {
    parts.push_back({{"id", p.id}, {"name", p.name}, {"file", p.file}});
    if (p.colour) parts.back()["color"] = to_hex(*p.colour);
    if (p.flexible) parts.back()["flexible"] = std::string(to_string(*p.flexible));
    if (!p.parents.empty()) parts.back()["parents"] = p.parents;
  }
  for (const auto& [name, reason] : a.excluded) excluded.push_back({{"name", name}, {"reason", reason}});
  for (const PlanOverlap& o : a.overlaps) overlaps.push_back(overlap_json(o));
  Json out;
  out["source"] = a.source;
  out["sha256"] = a.sha256;
  out["scale"] = a.scale;
  out["center"] = vector_json(a.center);
  out["bbox"] = a.box.empty() ? Json(nullptr) : box_json(a.box);
  out["parts"] = std::move(parts);
  out["excluded"] = std::move(excluded);
  out["overlaps"] = std::move(overlaps);
  if (a.repair != SurfaceRepair{})
    out["repair"] = {{"weld", a.repair.weld}, {"repair", a.repair.repair}, {"max_hole", a.repair.max_hole}};
  if (!a.unit.empty()) out["unit"] = a.unit;
  if (!a.import_params.empty()) out["import"] = import_json(a.import_params);
  return out;
}

Json certificates_json(const std::vector<PlanCertificate>& certificates) {
  Json out = Json::array();
  for (const PlanCertificate& c : certificates) {
    Json one = {{"kind", c.kind}, {"parts", c.parts}};
    if (!c.poses.empty()) {
      Json poses = Json::array();
      for (const Pose& p : c.poses) poses.push_back(pose_json(p, canonical_sign(p.q)));
      one["poses"] = std::move(poses);
    }
    one["full_tolerance"] = c.full_tolerance;
    one["margin"] = c.margin;
    Json numbers = Json::object();
    for (const auto& [name, values] : c.numbers) numbers[name] = values;
    one["numbers"] = std::move(numbers);
    one["text"] = c.text;
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::string_view to_string(PlanStatus status) {
  switch (status) {
    case PlanStatus::complete:
      return "complete";
    case PlanStatus::forced:
      return "forced";
    case PlanStatus::partial:
      return "partial";
  }
  return "partial";
}

std::string_view to_string(AssemblyStatus status) {
  switch (status) {
    case AssemblyStatus::complete:
      return "complete";
    case AssemblyStatus::partial:
      return "partial";
    case AssemblyStatus::reversed:
      return "reversed";
  }
  return "reversed";
}

std::string to_json(const Plan& plan) {
  Json unsolved = Json::array();
  for (const PlanUnsolved& u : plan.unsolved)
    unsolved.push_back({{"part", u.part},
                        {"outcome", std::string(to_string(u.outcome))},
                        {"blocked_by", u.blocked_by},
                        {"best_pose", pose_json(u.best_pose, canonical_sign(u.best_pose.q))},
                        {"message", u.message}});
  for (std::size_t i = 0; i < plan.unsolved.size(); ++i) {
    const PlanUnsolved& u = plan.unsolved[i];
    if (u.certificate) unsolved[i]["certificate"] = *u.certificate;
    if (u.attempts > 0) {
      unsolved[i]["planner"] = u.planner;
      unsolved[i]["attempts"] = u.attempts;
      unsolved[i]["seconds"] = u.seconds;
      unsolved[i]["depth"] = u.depth;
    }
    Json places = Json::array();
    for (const PlanPlace& p : u.places) places.push_back({{"part", p.part}, {"at", vector_json(p.at)}});
    if (!places.empty()) unsolved[i]["places"] = std::move(places);
  }
  Json out;
  out["format"] = "dismantle.plan";
  out["version"] = 1;
  out["generator"] = {{"name", plan.generator_name}, {"version", plan.generator_version}};
  out["assembly"] = assembly_json(plan.assembly);
  out["status"] = std::string(to_string(plan.status));
  out["seed"] = plan.seed;
  out["verified_max_penetration"] = plan.verified_max_penetration;
  out["disassembly"] = steps_json(plan.disassembly, false);
  out["assembly_steps"] = steps_json(plan.assembly_steps, true);
  out["assembly_status"] = std::string(to_string(plan.assembly_status));
  out["assembly_message"] = plan.assembly_message;
  out["remaining"] = plan.remaining;
  out["unsolved"] = std::move(unsolved);
  if (!plan.certificates.empty()) out["certificates"] = certificates_json(plan.certificates);
  return json_text(out) + "\n";
}

}  // namespace dismantle
