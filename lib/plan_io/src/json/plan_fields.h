/// The keys of plan.json (docs/plan-format.md), each described once: both the reader and the writer are made from this.
///
/// `fields(v, x)` calls v(key, member, presence, rule) for each key of a struct, in the order of the file. The rule
/// reads a value and says what is wrong with it; without one, and for writing, the type of the member decides.
/// `v.object` is an object without a struct of its own, `v.inlined` an optional struct whose keys stand among those of
/// its owner: all of them or none. A new key is one line here.
#pragma once

#include <fmt/format.h>

#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "json/hex_colour.h"
#include "json/json_place.h"

namespace dismantle::plan_json {

constexpr const char* kFormat = "dismantle.plan";
constexpr unsigned kVersion = 1;

enum class Presence {
  required,
  optional,   ///< may be missing; always written
  if_set,     ///< may be missing; written unless it is empty, false or the default
  unwritten,  ///< may be missing; not written this time
  unknown,    ///< not a key of this object
};
using enum Presence;

constexpr Presence when(bool written) { return written ? optional : unwritten; }

/// The member's type decides how it is read.
struct ByType {};

/// The writer's structs are constant.
template <class T, class Struct>
concept Is = std::is_same_v<std::remove_const_t<T>, Struct>;

/// The poses of a motion. q and -q are one rotation: the first pose is written with the canonical sign and each of the
/// others with that of its predecessor, so that a reader who interpolates the numbers never turns the long way round.
struct Motion {
  std::vector<Pose> operator()(const Place& place) const {
    return checked(
        list(pose), [](const auto& poses) { return poses.size() >= 2; }, "at least two poses")(place);
  }
  static Json write(const std::vector<Pose>& poses);
};

void fields(auto& v, Is<PlanMove> auto& m) {
  v("part", m.part, required, part);
  v("poses", m.poses, required, Motion{});
}

void fields(auto& v, Is<PlanStepOverlap> auto& o) {
  v("pair", std::tie(o.part, o.other), required, pair);
  v("assembled", o.assembled, required, from_zero);
  v("allowed", o.allowed, required, from_zero);
  v("depth", o.depth, required, from_zero);
  v("at", o.at, if_set, vector);
  v("region", o.region, if_set, box);
}

void fields(auto& v, Is<PlanForced> auto& f) {
  v("pair", std::tie(f.part, f.other), required, pair);
  v("depth", f.depth, required, from_zero);
  v("assembled", f.assembled, required, from_zero);
  v("at", f.at);
  v("reason", f.reason);
  v("certificate", f.certificate, if_set);
  v("lower_bound", f.lower_bound, if_set);
  v("accepted", f.accepted, if_set);
}

/// A JSON object of a third party, as text.
struct ObjectText {
  std::string operator()(const Place& place) const {
    place.expect(place.json().is_binary(), "an object");
    const auto& bytes = place.json().get_binary();
    return {bytes.begin(), bytes.end()};
  }
  static Json write(const std::string& text) { return Json::binary({text.begin(), text.end()}); }
};

void fields(auto& v, Is<StepNote> auto& n) {
  v("kind", n.kind, required, name);
  v("text", n.text);
  v("data", n.data, if_set, ObjectText{});
}

void fields(auto& v, Is<PlanVerdict> auto& c) {
  v("type", c.type, required, name);
  v("weight", c.weight, required, from_zero);
  v("cost", c.cost, required, from_zero);
  v("allowed", c.allowed);
  v("reason", c.reason, if_set);
  v("failed", c.failed, if_set);
  v("notes", c.notes, if_set);
  v("certificate", c.certificate, if_set);
}

void fields(auto& v, Is<PlanObjectiveItem> auto& item) {
  v("type", item.type, required, name);
  v("weight", item.weight, required, from_zero);
  v("require", item.require, if_set);
  v("parameters", item.parameters, if_set);
  v("cost", item.cost, required, from_zero);
  v("plan", item.plan, if_set);
}

void fields(auto& v, Is<PlanAlternative> auto& a) {
  v("step", a.step, when(a.step > 0));
  v("place", a.place, when(a.step > 0));
  v("checks", a.checks);
}

void fields(auto& v, Is<PlanObjective> auto& o) {
  v("up", o.up, required, unit_vector);
  v("cost", o.cost, required, from_zero);
  v("least_cost", o.least_cost, if_set, from_zero);
  v("alternatives", o.alternatives, if_set);
  v("checks", o.checks);
}

enum class StepKind { disassembly, assembly };

void step_fields(auto& v, Is<PlanStep> auto& s, StepKind kind) {
  const bool assembly = kind == StepKind::assembly;
  // Assembly steps are verified as the reverse of the disassembly; other programs need not repeat its figures.
  const Presence figure = assembly ? optional : required;
  v("step", s.step);
  v("moves", s.moves);
  v("transfer", s.transfer, assembly ? optional : unknown);
  v("valid_to", s.transfer, assembly ? unknown : when(s.transfer > 0));
  v("separates", s.separates, figure, list(some_parts));
  v("max_penetration", s.max_penetration, figure, from_zero);
  v("seconds", s.seconds, figure, from_zero);
  v("planner", s.planner, figure);
  v("depth", s.depth, figure);
  v("contacts", s.contacts, figure, group);
  const Presence order = assembly ? unknown : when(s.layer > 0);
  v("after", s.after, order);
  v("layer", s.layer, order);
  v("overlaps", s.overlaps, assembly ? unknown : if_set);
  v("up", s.up, assembly ? unknown : if_set, unit_vector);
  v("checks", s.checks, assembly ? unknown : if_set);
  v("forced", s.forced, if_set);
}

void fields(auto& v, Is<PlanPlace> auto& p) {
  v("part", p.part, required, part);
  v("at", p.at);
}

void fields(auto& v, Is<PlanUnsolved> auto& u) {
  const Presence searched = when(u.attempts > 0);
  v("part", u.part, required, part);
  v("outcome", u.outcome, required, choice(outcome_from_string, "an outcome, as in \"timeout\""));
  v("blocked_by", u.blocked_by, required, group);
  v("best_pose", u.best_pose);
  v("message", u.message);
  v("certificate", u.certificate, if_set);
  v("planner", u.planner, searched);
  v("attempts", u.attempts, searched);
  v("seconds", u.seconds, searched, from_zero);
  v("depth", u.depth, searched);
  v("refused_by", u.refused_by, if_set);
  v("places", u.places, if_set);
}

void fields(auto& v, Is<PlanCertificate> auto& c) {
  v("kind", c.kind, required, name);
  v("parts", c.parts, required, group);
  v("poses", c.poses, if_set);
  v("full_tolerance", c.full_tolerance);
  v("margin", c.margin, required, positive);
  v("numbers", c.numbers);
  v("text", c.text);
}

void fields(auto& v, Is<PartKind> auto& k) {
  v("kind", k.kind, required, name);
  v("size", k.size, if_set);
  v("confidence", k.confidence, required, from_zero_to(1));
  v("reason", k.reason, if_set);
  v("stated", k.stated, if_set);
}

void fields(auto& v, Is<PlanPart> auto& p) {
  v("id", p.id);
  v("name", p.name, required, name);
  v("file", p.file);
  v("color", p.colour, if_set, choice(rgba_from_hex, "a colour as in \"#rrggbb\""));
  v("flexible", p.flexible, if_set, enumerator(Flexible::material, "\"declared\", \"coil\", \"loop\" or \"material\""));
  v("parents", p.parents, if_set);
  v("product", p.product, if_set);
  v("open", p.open, if_set);
  v.inlined(p.kind);
  // Of a screw; it comes from the notes of the steps whenever a plan is written (plan_write.cpp).
  v.object("fastens", unwritten, [](auto& fastens) {
    std::vector<std::string> clamps, into, only;
    fastens("clamps", clamps, if_set);
    fastens("into", into, if_set);
    fastens("only", only, if_set);
  });
}

void fields(auto& v, Is<PlanComponent> auto& c) {
  v("name", c.name, required, name);
  v("product", c.product);
  v("parts", c.parts, required, group);
  v("kept", c.kept);
  v("reason", c.reason);
}

void fields(auto& v, Is<PlanReferenceStep> auto& s) {
  v("step", s.step);
  v("parts", s.parts, required, group);
  v("group", s.group);
  v("up", s.up, required, unit_vector);
}

void fields(auto& v, Is<OverlapPlace> auto& p) {
  v("class", p.contact, required,
    choice(contact_class_from_string, "the class of a contact, as in \"uniform_interference\""));
  v("at", p.at);
  v("region", p.region, required, box);
  v("share", p.share, required, from_zero_to(1));
  v.object("axis", when(p.axis.has_value()), [&](auto& axis) {
    axis("point", p.axis_point);
    axis("direction", p.axis, required, unit_vector);
  });
}

void fields(auto& v, Is<PlanOverlap> auto& o) {
  v("a", o.a, required, part);
  v("b", o.b, required, part);
  v("depth", o.depth, required, from_zero);
  v("declared", o.declared, if_set, from_zero);
  v("flexible", o.flexible, if_set);
  v.inlined(o.place);  // files of older versions do not say what kind of overlap it is
}

void fields(auto& v, Is<PlanExcluded> auto& e) {
  v("name", e.name);
  v("reason", e.reason);
  v("unusable", e.unusable, if_set);
}

/// Files of older versions do not say what was asked for.
void fields(auto& v, Is<PlanAsked> auto& a) {
  v("part", a.part, if_set, part);
  v("target", a.target, if_set, part);
  v("together", a.together, if_set, list(group));
}

void fields(auto& v, Is<SurfaceRepair> auto& r) {
  v("weld", r.weld, required, from_zero_to(0.01));
  v("repair", r.repair);
  v("max_hole", r.max_hole, required, from_zero_to(1));
}

void fields(auto& v, Is<PlanAssembly> auto& a) {
  v("source", a.source);
  v("sha256", a.sha256);
  v("scale", a.scale, required, positive);
  v("center", a.center);
  v("bbox", a.box, required, box_or_null);
  v("parts", a.parts);
  v("excluded", a.excluded);
  v("overlaps", a.overlaps);
  v("repair", a.repair, if_set);
  v("unit", a.unit, if_set, name);
  v("import", a.import_params, if_set);
  v("components", a.components, if_set);
  v("reference_order", a.reference_order, if_set);
}

void fields(auto& v, Is<Plan> auto& p) {
  v("format", std::string(kFormat));
  v("version", unsigned{kVersion});
  v.object("generator", required, [&](auto& generator) {
    generator("name", p.generator_name);
    generator("version", p.generator_version);
  });
  v("assembly", p.assembly);
  v("asked", p.asked, if_set);
  v("status", p.status, required, enumerator(PlanStatus::partial, "\"complete\", \"forced\" or \"partial\""));
  v("seed", p.seed);
  v("verified_max_penetration", p.verified_max_penetration, required, positive);
  v("objective", p.objective, if_set);
  v.list("disassembly", p.disassembly, [](auto& step, auto& s) { step_fields(step, s, StepKind::disassembly); });
  v.list("assembly_steps", p.assembly_steps, [](auto& step, auto& s) { step_fields(step, s, StepKind::assembly); });
  v("assembly_status", p.assembly_status, optional,
    enumerator(AssemblyStatus::reversed, "\"complete\", \"partial\" or \"reversed\""));
  v("assembly_message", p.assembly_message, optional);
  v("remaining", p.remaining, required, group);
  v("unsolved", p.unsolved);
  v("certificates", p.certificates, if_set);
}

}  // namespace dismantle::plan_json
