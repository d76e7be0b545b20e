/// Length units of a STEP model.
#pragma once

#include <Interface_InterfaceModel.hxx>
#include <StepRepr_RepresentationContext.hxx>
#include <optional>
#include <vector>

namespace dismantle::step_import {

/// Millimetres in the length unit of a context; nothing when it states none.
std::optional<double> millimetres_in(const Handle(StepRepr_RepresentationContext) & context);

/// Those of all contexts of shapes, each once, in the order of the file.
std::vector<double> length_units(const Handle(Interface_InterfaceModel) & model);

}  // namespace dismantle::step_import
