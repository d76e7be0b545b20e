// plan.json -> Plan: strict, every problem is reported with its location in the file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_set>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "json/hex_colour.h"
#include "json/json_place.h"
#include "json/parse_json.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;

using json_read::Place;

Eigen::Vector3d read_vector(const Place& place) {
  const auto n = place.numbers<3>();
  return {n[0], n[1], n[2]};
}

Pose read_pose(const Place& place) {
  const auto n = place.numbers<7>();
  Pose p{{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}};
  const double norm = p.q.norm();
  // Plans by other programs may be rounded to a few digits; ours are left as they are, bit for bit.
  if (!(std::abs(norm - 1) <= 1e-3)) place.fail(fmt::format("the quaternion has length {:.6g}, expected 1", norm));
  if (std::abs(norm - 1) > 1e-12) p.q.normalize();
  return p;
}

using Names = std::unordered_set<std::string>;

std::string read_part(const Place& place, const Names& parts) {
  std::string name = place.name();
  if (!parts.contains(name)) place.fail(fmt::format("there is no part '{}' in /assembly/parts", name));
  return name;
}

/// Part names, none twice.
std::vector<std::string> read_group(const Place& place, const Names& parts) {
  std::vector<std::string> out;
  Names seen;
  for (const Place& item : place.items()) {
    out.push_back(read_part(item, parts));
    if (!seen.insert(out.back()).second) item.fail(fmt::format("part '{}' stands here twice", out.back()));
  }
  return out;
}

ImportParams read_import(const Place& place) {
  ImportParams out;
  for (const auto& [importer, values] : place.members())
    for (const auto& [name, value] : values.members()) out[importer][name] = value.parameter();
  return out;
}

Aabb read_box(const Place& place) {
  const auto corners = place.items();
  if (corners.size() != 2) place.fail("expected two corners");
  const Aabb box{read_vector(corners[0]), read_vector(corners[1])};
  if (box.empty()) place.fail("the first corner is above the second");
  return box;
}

/// Files of older versions do not say what kind of overlap it is.
PlanOverlap read_overlap(const Place& place, const Names& parts) {
  place.object({"a", "b", "depth"}, {"class", "at", "region", "share", "axis", "declared", "flexible"});
  PlanOverlap o{read_part(place.at("a"), parts), read_part(place.at("b"), parts), place.at("depth").number_from_zero()};
  if (o.a == o.b) place.fail("a part cannot overlap itself");
  if (place.has("declared")) o.declared = place.at("declared").number_from_zero();
  if (place.has("flexible")) o.flexible = place.at("flexible").truth();
  const auto says = [&](const char* key) { return place.has(key); };
  if (std::ranges::none_of(std::array{"class", "at", "region", "share", "axis"}, says)) return o;
  place.object({"a", "b", "depth", "class", "at", "region", "share"}, {"axis", "declared", "flexible"});
  const auto contact = contact_class_from_string(place.at("class").text());
  if (!contact) place.at("class").fail("expected the class of a contact, as in \"uniform_interference\"");
  o.place = OverlapPlace{*contact, read_vector(place.at("at")), read_box(place.at("region")),
                         place.at("share").number_within(0, 1)};
  if (!place.has("axis")) return o;
  const Place axis = place.at("axis");
  axis.object({"point", "direction"});
  o.place->axis_point = read_vector(axis.at("point"));
  o.place->axis = read_vector(axis.at("direction"));
  if (!(std::abs(o.place->axis->norm() - 1) <= 1e-3)) axis.at("direction").fail("expected a vector of length 1");
  return o;
}

PlanAssembly read_assembly(const Place& place, Names& parts) {
  place.object({"source", "sha256", "scale", "center", "bbox", "parts", "excluded", "overlaps"},
               {"repair", "unit", "import"});
  PlanAssembly a;
  a.source = place.at("source").text();
  a.sha256 = place.at("sha256").text();
  a.scale = place.at("scale").positive();
  a.center = read_vector(place.at("center"));
  if (const Place box = place.at("bbox"); !box.is_null()) a.box = read_box(box);
  for (const Place& item : place.at("parts").items()) {
    item.object({"id", "name", "file"}, {"color", "parents", "flexible"});
    PlanPart p{item.at("id").small_count(), item.at("name").name(), item.at("file").text()};
    if (item.has("color")) {
      p.colour = rgba_from_hex(item.at("color").text());
      if (!p.colour) item.at("color").fail("expected a colour as in \"#rrggbb\"");
    }
    if (item.has("parents"))
      for (const Place& parent : item.at("parents").items()) p.parents.push_back(parent.text());
    if (item.has("flexible")) {
      p.flexible = flexible_from_string(item.at("flexible").text());
      if (!p.flexible) item.at("flexible").fail("expected \"declared\", \"coil\" or \"loop\"");
    }
    if (p.id != a.parts.size())
      item.at("id").fail(fmt::format("expected {}: parts are numbered in order", a.parts.size()));
    if (!parts.insert(p.name).second) item.at("name").fail(fmt::format("there are two parts '{}'", p.name));
    a.parts.push_back(std::move(p));
  }
  for (const Place& item : place.at("excluded").items()) {
    item.object({"name", "reason"});
    a.excluded.emplace_back(item.at("name").text(), item.at("reason").text());
  }
  for (const Place& item : place.at("overlaps").items()) a.overlaps.push_back(read_overlap(item, parts));
  if (place.has("unit")) a.unit = place.at("unit").name();
  if (place.has("import")) a.import_params = read_import(place.at("import"));
  if (place.has("repair")) {
    const Place repair = place.at("repair");
    repair.object({"weld", "repair", "max_hole"});
    a.repair = {repair.at("weld").number_within(0, 0.01), repair.at("repair").truth(),
                repair.at("max_hole").number_within(0, 1)};
  }
  return a;
}

std::vector<PlanMove> read_moves(const Place& place, const Names& parts) {
  std::vector<PlanMove> out;
  Names seen;
  for (const Place& item : place.items()) {
    item.object({"part", "poses"});
    PlanMove m;
    m.part = read_part(item.at("part"), parts);
    if (!seen.insert(m.part).second) item.at("part").fail(fmt::format("part '{}' moves twice in one step", m.part));
    const Place poses = item.at("poses");
    const auto list = poses.items();
    if (list.size() < 2) poses.fail("expected at least two poses");
    if (!out.empty() && list.size() != out.front().poses.size())
      poses.fail(fmt::format("{} poses, but {} in the first move of this step", list.size(), out.front().poses.size()));
    m.poses.reserve(list.size());
    for (const Place& pose : list) m.poses.push_back(read_pose(pose));
    out.push_back(std::move(m));
  }
  if (out.empty()) place.fail("expected at least one move");
  return out;
}

enum class StepKind { disassembly, assembly };

PlanStep read_step(const Place& place, unsigned number, StepKind kind, const Names& parts) {
  // Assembly steps are verified as the reverse of the disassembly; other programs need not repeat its figures.
  if (kind == StepKind::disassembly)
    place.object({"step", "moves", "separates", "max_penetration", "seconds", "planner", "depth", "contacts"},
                 {"after", "layer", "forced", "overlaps"});
  else
    place.object({"step", "moves"},
                 {"transfer", "separates", "max_penetration", "seconds", "planner", "depth", "contacts", "forced"});
  PlanStep s;
  s.step = place.at("step").small_count();
  if (s.step != number) place.at("step").fail(fmt::format("expected {}: steps are numbered in order", number));
  s.moves = read_moves(place.at("moves"), parts);
  if (place.has("transfer")) {
    s.transfer = place.at("transfer").small_count();
    if (s.transfer >= s.moves.front().poses.size())
      place.at("transfer")
          .fail(fmt::format("expected less than {}, the number of poses", s.moves.front().poses.size()));
  }
  if (place.has("separates"))
    for (const Place& group : place.at("separates").items()) {
      s.separates.push_back(read_group(group, parts));
      if (s.separates.back().empty()) group.fail("expected at least one part");
    }
  if (place.has("max_penetration")) s.max_penetration = place.at("max_penetration").number_from_zero();
  if (place.has("seconds")) s.seconds = place.at("seconds").number_from_zero();
  if (place.has("planner")) s.planner = place.at("planner").text();
  if (place.has("depth")) s.depth = place.at("depth").small_count();
  if (place.has("contacts")) s.contacts = read_group(place.at("contacts"), parts);
  if (place.has("after"))
    for (const Place& item : place.at("after").items()) {
      s.after.push_back(item.small_count());
      if (s.after.back() == 0 || s.after.back() >= number) item.fail("expected the number of an earlier step");
    }
  if (place.has("layer")) s.layer = place.at("layer").small_count();
  if (place.has("overlaps"))
    for (const Place& item : place.at("overlaps").items()) {
      item.object({"pair", "assembled", "allowed", "depth"}, {"at", "region"});
      const auto pair = item.at("pair").items();
      if (pair.size() != 2) item.at("pair").fail("expected two parts");
      s.overlaps.push_back({read_part(pair[0], parts), read_part(pair[1], parts),
                            item.at("assembled").number_from_zero(), item.at("allowed").number_from_zero(),
                            item.at("depth").number_from_zero()});
      if (item.has("at")) s.overlaps.back().at = read_vector(item.at("at"));
      if (item.has("region")) s.overlaps.back().region = read_box(item.at("region"));
    }
  if (place.has("forced")) {
    const Place forced = place.at("forced");
    forced.object({"pair", "depth", "assembled", "at", "reason"}, {"certificate", "lower_bound"});
    const auto pair = forced.at("pair").items();
    if (pair.size() != 2) forced.at("pair").fail("expected two parts");
    s.forced = PlanForced{read_part(pair[0], parts),
                          read_part(pair[1], parts),
                          forced.at("depth").number_from_zero(),
                          forced.at("assembled").number_from_zero(),
                          read_vector(forced.at("at")),
                          forced.at("reason").text()};
    if (forced.has("certificate")) s.forced->certificate = forced.at("certificate").count();
    if (forced.has("lower_bound")) s.forced->lower_bound = forced.at("lower_bound").truth();
  }
  return s;
}

std::vector<PlanStep> read_steps(const Place& place, StepKind kind, const Names& parts) {
  std::vector<PlanStep> out;
  for (const Place& item : place.items())
    out.push_back(read_step(item, static_cast<unsigned>(out.size() + 1), kind, parts));
  return out;
}

PlanUnsolved read_unsolved(const Place& place, const Names& parts) {
  place.object({"part", "outcome", "blocked_by", "best_pose", "message"},
               {"certificate", "planner", "attempts", "seconds", "depth", "places"});
  PlanUnsolved u;
  u.part = read_part(place.at("part"), parts);
  const std::string outcome = place.at("outcome").text();
  const auto known = outcome_from_string(outcome);
  if (!known) place.at("outcome").fail(fmt::format("unknown outcome '{}'", outcome));
  u.outcome = *known;
  u.blocked_by = read_group(place.at("blocked_by"), parts);
  u.best_pose = read_pose(place.at("best_pose"));
  u.message = place.at("message").text();
  if (place.has("certificate")) u.certificate = place.at("certificate").count();
  if (place.has("planner")) u.planner = place.at("planner").text();
  if (place.has("attempts")) u.attempts = place.at("attempts").small_count();
  if (place.has("seconds")) u.seconds = place.at("seconds").number_from_zero();
  if (place.has("depth")) u.depth = place.at("depth").small_count();
  if (place.has("places"))
    for (const Place& item : place.at("places").items()) {
      item.object({"part", "at"});
      u.places.push_back({read_part(item.at("part"), parts), read_vector(item.at("at"))});
    }
  return u;
}

PlanCertificate read_certificate(const Place& place, const Names& parts) {
  place.object({"kind", "parts", "full_tolerance", "margin", "numbers", "text"}, {"poses"});
  PlanCertificate c;
  c.kind = place.at("kind").name();
  c.parts = read_group(place.at("parts"), parts);
  if (c.parts.size() < 2) place.at("parts").fail("expected two parts at least");
  if (place.has("poses")) {
    for (const Place& item : place.at("poses").items()) c.poses.push_back(read_pose(item));
    if (c.poses.size() != c.parts.size()) place.at("poses").fail("expected one pose for each part");
  }
  c.full_tolerance = place.at("full_tolerance").truth();
  c.margin = place.at("margin").positive();
  for (const auto& [name, values] : place.at("numbers").members()) {
    std::vector<double>& list = c.numbers[name];  // which may be empty
    for (const Place& value : values.items()) list.push_back(value.number());
  }
  c.text = place.at("text").text();
  return c;
}

AssemblyStatus read_assembly_status(const Place& place) {
  const std::string text = place.text();
  for (const auto s : {AssemblyStatus::complete, AssemblyStatus::partial, AssemblyStatus::reversed})
    if (text == to_string(s)) return s;
  place.fail("expected \"complete\", \"partial\" or \"reversed\"");
}

}  // namespace

Plan plan_from_json(const std::string& text, const std::string& source) {
  const Json json = parse_json(text, source);
  const Place root(json, source, "");
  if (!json.is_object()) root.fail("expected an object");
  if (!json.contains("format") || json["format"] != "dismantle.plan")
    throw InputError(source, "not a plan: expected \"format\": \"dismantle.plan\"");
  if (!json.contains("version")) root.fail("'version' is missing");
  if (const auto version = root.at("version").count(); version != 1)
    root.at("version").fail(fmt::format("this program reads version 1 of the plan format, not {}", version));
  root.object({"format", "version", "generator", "assembly", "status", "seed", "verified_max_penetration",
               "disassembly", "assembly_steps", "remaining", "unsolved"},
              {"assembly_status", "assembly_message", "certificates"});

  Plan plan;
  Names parts;
  const Place generator = root.at("generator");
  generator.object({"name", "version"});
  plan.generator_name = generator.at("name").text();
  plan.generator_version = generator.at("version").text();
  plan.assembly = read_assembly(root.at("assembly"), parts);
  const std::string status = root.at("status").text();
  if (status != "complete" && status != "forced" && status != "partial")
    root.at("status").fail("expected \"complete\", \"forced\" or \"partial\"");
  plan.status = status == "complete" ? PlanStatus::complete
                : status == "forced" ? PlanStatus::forced
                                     : PlanStatus::partial;
  plan.seed = root.at("seed").count();
  plan.verified_max_penetration = root.at("verified_max_penetration").positive();
  plan.disassembly = read_steps(root.at("disassembly"), StepKind::disassembly, parts);
  plan.assembly_steps = read_steps(root.at("assembly_steps"), StepKind::assembly, parts);
  if (root.has("assembly_status")) plan.assembly_status = read_assembly_status(root.at("assembly_status"));
  if (root.has("assembly_message")) plan.assembly_message = root.at("assembly_message").text();
  plan.remaining = read_group(root.at("remaining"), parts);
  for (const Place& item : root.at("unsolved").items()) plan.unsolved.push_back(read_unsolved(item, parts));
  if (root.has("certificates"))
    for (const Place& item : root.at("certificates").items())
      plan.certificates.push_back(read_certificate(item, parts));
  for (std::size_t i = 0; i < plan.unsolved.size(); ++i)
    if (plan.unsolved[i].certificate && *plan.unsolved[i].certificate >= plan.certificates.size())
      root.at("unsolved").items()[i].at("certificate").fail("there is no such certificate");
  const auto check_forced = [&](const std::vector<PlanStep>& steps, const char* key) {
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (steps[i].forced && steps[i].forced->certificate && *steps[i].forced->certificate >= plan.certificates.size())
        root.at(key).items()[i].at("forced").at("certificate").fail("there is no such certificate");
  };
  check_forced(plan.disassembly, "disassembly");
  check_forced(plan.assembly_steps, "assembly_steps");
  return plan;
}

}  // namespace dismantle
