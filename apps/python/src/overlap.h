/// Python view of two parts that overlap when assembled. Input units.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"

namespace dismantle::python {

struct HeldOverlap {
  std::string a, b;
  double depth = 0;
  std::optional<double> declared;
  std::optional<OverlapPlace> place;
  bool flexible = false;
};

HeldOverlap overlap_of(const Assembly& assembly, const InitialOverlap& overlap);
HeldOverlap overlap_of(const PlanAssembly& assembly, const PlanOverlap& overlap);
void bind_overlap(pybind11::module_& m);

}  // namespace dismantle::python
