#include "units.h"

#include <STEPConstruct_UnitContext.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <algorithm>
#include <cmath>

namespace dismantle::step_import {

std::optional<double> millimetres_in(const Handle(StepRepr_RepresentationContext) & context) {
  Handle(StepRepr_GlobalUnitAssignedContext) units;
  if (const auto both = Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(context);
      !both.IsNull())
    units = both->GlobalUnitAssignedContext();
  if (const auto plain = Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(context);
      !plain.IsNull())
    units = plain->GlobalUnitAssignedContext();
  if (units.IsNull()) return std::nullopt;
  STEPConstruct_UnitContext tool;
  tool.ComputeFactors(units);
  if (!tool.LengthDone() || !(tool.LengthFactor() > 0)) return std::nullopt;
  return tool.LengthFactor();
}

std::vector<double> length_units(const Handle(Interface_InterfaceModel) & model) {
  std::vector<double> found;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto context = Handle(StepRepr_RepresentationContext)::DownCast(model->Value(i));
    const std::optional<double> unit = context.IsNull() ? std::nullopt : millimetres_in(context);
    if (unit && std::ranges::none_of(found, [&](double u) { return std::abs(u - *unit) <= 1e-9 * u; }))
      found.push_back(*unit);
  }
  return found;
}

}  // namespace dismantle::step_import
