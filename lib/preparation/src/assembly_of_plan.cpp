#include "dismantle/preparation/assembly_of_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "dismantle/constraints.h"
#include "dismantle/errors.h"
#include "dismantle/preparation/declared_overlaps.h"
#include "dismantle/preparation/flexible_parts.h"
#include "dismantle/preparation/prepare.h"

namespace dismantle {
namespace {

void check_same_files(const Plan& plan, const InputParts& input, const std::string& source) {
  if (input.sha256 == plan.assembly.sha256) return;
  throw InputError(
      source, fmt::format("these are not the files that the plan was made for: their SHA-256 is {}, the plan says {}",
                          input.sha256, plan.assembly.sha256));
}

/// Removes the parts that are not in the plan. Parts that it states as rigid stay rigid, whatever the file says of
/// them.
void keep_parts_of(const Plan& plan, std::vector<RawPart>& parts, const std::string& source) {
  std::set<std::string> planned, excluded, found;
  for (const auto& part : plan.assembly.parts) planned.insert(part.name);
  for (const auto& part : plan.assembly.excluded) excluded.insert(part.name);
  for (const auto& part : parts) {
    found.insert(part.name);
    if (!planned.contains(part.name) && !excluded.contains(part.name))
      throw InputError(source, fmt::format("the plan neither moves nor leaves out part '{}'", part.name));
  }
  for (const auto& name : planned)
    if (!found.contains(name)) throw InputError(source, fmt::format("has no part '{}', which the plan is about", name));
  std::erase_if(parts, [&](const RawPart& part) { return !planned.contains(part.name); });
  std::set<std::string> material;
  for (const auto& part : plan.assembly.parts)
    if (part.flexible == Flexible::material) material.insert(part.name);
  for (auto& part : parts) part.flexible = part.flexible && material.contains(part.name);
}

std::shared_ptr<const Mesh> moved(const Mesh& mesh, const Normalization& from, const Normalization& to) {
  Mesh out = mesh;
  for (auto& v : out.vertices) v = to.to_internal(from.to_input(v));
  return std::make_shared<const Mesh>(std::move(out));
}

/// Converts the assembly to other units.
void set_normalization(Assembly& assembly, const Normalization& to) {
  const Normalization from = assembly.normalization;
  if (from.scale == to.scale && from.center == to.center) return;
  const double factor = to.scale / from.scale;
  for (auto& part : assembly.parts) {
    const bool shared = part.surface == part.mesh;
    part.mesh = moved(*part.mesh, from, to);
    if (part.surface) part.surface = shared ? part.mesh : moved(*part.surface, from, to);
    part.volume *= factor * factor * factor;
  }
  const auto moved_point = [&](const Eigen::Vector3d& p) { return to.to_internal(from.to_input(p)); };
  for (auto& overlap : assembly.overlaps) {
    overlap.depth *= factor;
    if (overlap.declared) *overlap.declared *= factor;
    if (!overlap.place) continue;
    OverlapPlace& place = *overlap.place;
    place.at = moved_point(place.at);
    place.axis_point = moved_point(place.axis_point);
    if (!place.region.empty()) place.region = {moved_point(place.region.lo), moved_point(place.region.hi)};
  }
  assembly.normalization = to;
}

/// Recognises only parts that the plan states as flexible. Parts that it states as rigid stay rigid.
void recognise_flexible_of(const Plan& plan, Assembly& assembly, const RunContext& context) {
  std::vector<std::string> named;
  for (const PlanPart& part : plan.assembly.parts)
    if (part.flexible == Flexible::coil || part.flexible == Flexible::loop) named.push_back(part.name);
  if (!named.empty()) recognise_flexible(assembly, context, &named);
}

/// What parts are is read off the plan: step checks judge again by what they knew.
void set_kinds_of(const Plan& plan, Assembly& assembly) {
  std::map<std::string, const PlanPart*> planned;
  for (const PlanPart& part : plan.assembly.parts) planned[part.name] = &part;
  for (Part& part : assembly.parts) part.kind = planned.at(part.name)->kind;
}

/// What the plan keeps together is one body.
void set_units_of(const Plan& plan, Assembly& assembly) {
  std::map<std::string, PartId> ids;
  for (const Part& part : assembly.parts) ids[part.name] = part.id;
  Constraints kept;
  for (const std::vector<std::string>& list : plan.asked.together) {
    kept.together.emplace_back();
    for (const std::string& name : list)
      if (const auto id = ids.find(name); id != ids.end()) kept.together.back().push_back(id->second);
  }
  set_units(assembly, kept);
}

}  // namespace

Assembly assembly_of_plan(const Plan& plan, InputParts input, const std::string& source, RunContext& context) {
  check_same_files(plan, input, source);
  keep_parts_of(plan, input.parts, source);
  PrepareOptions options;
  options.weld = plan.assembly.repair.weld;
  options.repair = plan.assembly.repair.repair;
  options.max_hole = plan.assembly.repair.max_hole;
  options.unit = plan.assembly.unit;
  options.drop_duplicates = false;  // the plan says which parts stay
  options.subdivide = 0;
  options.flexible = FlexibleParts::declared;  // shapes are recognised below, only of parts that the plan names
  options.max_triangles = std::numeric_limits<std::int64_t>::max();
  PrepareReport report;
  Assembly assembly = prepare_assembly(std::move(input.parts), source, input.sha256, options, context, report);
  for (const auto& part : report.parts)
    if (!part.kept)
      throw InputError(source,
                       fmt::format("part '{}', which the plan is about, cannot be used: {}", part.name, part.reason));
  set_normalization(assembly, {plan.assembly.scale, plan.assembly.center});
  recognise_flexible_of(plan, assembly, context);
  set_kinds_of(plan, assembly);
  set_units_of(plan, assembly);
  for (const PlanOverlap& o : plan.assembly.overlaps)
    if (o.declared && !o.flexible) declare_overlap(assembly, o.a, o.b, *o.declared);
  return assembly;
}

}  // namespace dismantle
