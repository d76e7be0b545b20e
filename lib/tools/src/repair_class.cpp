#include "dismantle/tools/repair_class.h"

#include <algorithm>
#include <array>

#include "dismantle/fasteners/recognise.h"
#include "dismantle/fasteners/shape.h"
#include "dismantle/tools/access.h"
#include "dismantle/tools/catalogue.h"

namespace dismantle::tools {

namespace {

using fasteners::Drive;
using fasteners::Kind;

bool fits_one(Kind kind, Drive drive, double size) {
  Fastener fastener;
  fastener.kind = kind;
  fastener.drive = drive;
  fastener.size = size;
  const std::vector<Tool>& all = standard_catalogue();
  return std::any_of(all.begin(), all.end(), [&](const Tool& tool) { return fits(tool, fastener); });
}

RepairClass class_of(const Part& part, double mm) {
  if (!part.kind) return {};
  const Kind kind = fasteners::kind_from_string(part.kind->kind).value_or(Kind::other);
  if (kind != Kind::screw && kind != Kind::nut && kind != Kind::ring) return {};
  if (part.open) return {FastenerClass::reusable, ToolClass::not_determined};
  const fasteners::Shape shape = fasteners::recognise_shape(*part.mesh, mm);
  if (kind == Kind::ring) {
    if (shape.kind != Kind::other && shape.kind != Kind::plate) return {};  // closed: an O-ring
    const double diameter = mm * part.mesh->box().size().maxCoeff();
    const bool fits = fits_one(kind, Drive::none, diameter);
    return {FastenerClass::reusable, fits ? ToolClass::basic : ToolClass::not_determined};
  }
  if (shape.drive == Drive::knurl) return {FastenerClass::reusable, ToolClass::none};
  const bool fits = shape.drive != Drive::none && fits_one(kind, shape.drive, shape.drive_size);
  return {FastenerClass::reusable, fits ? ToolClass::basic : ToolClass::not_determined};
}

}  // namespace

std::string_view to_string(FastenerClass c) {
  return std::array<std::string_view, 3>{"none", "reusable", "neither"}.at(static_cast<std::size_t>(c));
}

std::string_view to_string(ToolClass c) {
  return std::array<std::string_view, 4>{"none", "basic", "not determined", "not removable"}.at(
      static_cast<std::size_t>(c));
}

void RepairClass::add(const RepairClass& other) {
  fasteners = std::max(fasteners, other.fasteners);
  tools = std::max(tools, other.tools);
}

RepairClass repair_class(const Assembly& assembly, const std::vector<PartId>& leaving, bool forced) {
  if (forced) return {FastenerClass::neither, ToolClass::not_removable};
  RepairClass out;
  const double mm = fasteners::millimetres_per_unit(assembly);
  for (const PartId id : leaving) out.add(class_of(assembly.parts[id], mm));
  if (leaving.size() > 1 && out.fasteners != FastenerClass::none) out.tools = ToolClass::not_determined;
  return out;
}

}  // namespace dismantle::tools
