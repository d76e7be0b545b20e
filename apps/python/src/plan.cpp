// Plan: plan.json as arrays.
#include "dismantle/plan.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"
#include "overlap.h"

namespace dismantle::python {
namespace {

std::vector<unsigned> forced_numbers(const Plan& plan) {
  std::vector<unsigned> numbers;
  for (const auto& step : plan.disassembly)
    if (step.forced) numbers.push_back(step.step);
  return numbers;
}

using PlanClass = py::class_<HeldPlan>;

/// Reading and writing, and texts about the plan.
void bind_plan_texts(PlanClass& plan) {
  plan.def_static(
          "read",
          [](const std::filesystem::path& file) {
            return HeldPlan{read_plan(file), {}};
          },
          py::arg("path"), "Reads a plan.json. Raises InputError with the place of what is wrong.")
      .def_static(
          "from_json",
          [](const std::string& text) {
            return HeldPlan{plan_from_json(text, "<text>"), {}};
          },
          py::arg("text"), "The plan of a plan.json's text.")
      .def(
          "to_json", [](const HeldPlan& self) { return to_json(self.plan); },
          "Text of plan.json. The same plan gives the same text.")
      .def(
          "write",
          [](const HeldPlan& self, const std::filesystem::path& file) { write_file(file, to_json(self.plan)); },
          py::arg("path"), "Writes plan.json; replaces the file as a whole.")
      .def(
          "write_glb",
          [](const HeldPlan& self, const std::filesystem::path& file, const HeldAssembly& loaded) {
            const auto bytes = to_glb(self.plan, *loaded.assembly);
            write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
          },
          py::arg("path"), py::arg("assembly"),
          "Writes the animation as glTF binary, a node for each part, for viewers and Blender. assembly: the one that "
          "the "
          "plan is for.")
      .def(
          "page", [](const HeldPlan& self, const HeldAssembly& loaded) { return page_of(self.plan, *loaded.assembly); },
          py::arg("assembly"),
          "The page that shows the plan in a browser, one HTML text that needs no network. assembly: the one that the "
          "plan is "
          "for. Raises Error when this build has no viewer.")
      .def(
          "explain",
          [](const HeldPlan& self, const std::string& part) { return explain_text(explain(self.plan, {}, part)); },
          py::arg("part") = "",
          "What was tried, where parts are blocked and what can be done about it, in words; of one part, or of all. "
          "Raises InputError when there is no such part.")
      .def(
          "summary", [](const HeldPlan& self) { return summary_text(self.plan); }, "What came out, in words.")
      .def(py::pickle([](const HeldPlan& self) { return py::make_tuple(to_json(self.plan), self.info); },
                      [](const py::tuple& state) {
                        return HeldPlan{plan_from_json(py::cast<std::string>(state[0]), "<pickle>"),
                                        py::cast<std::map<std::string, py::object>>(state[1])};
                      }))
      .def("__repr__", [](const HeldPlan& self) {
        return fmt::format("<Plan of '{}': {}, {} steps, {} parts>", self.plan.assembly.source,
                           to_string(self.plan.status), self.plan.disassembly.size(), self.plan.assembly.parts.size());
      });
}

/// What was planned, and how it ended.
void bind_plan_steps(PlanClass& plan) {
  plan.def_property_readonly(
          "steps", [](const HeldPlan& self) { return self.plan.disassembly; },
          "List of Step: how the assembly is taken apart, in order.")
      .def_property_readonly(
          "assembly_steps", [](const HeldPlan& self) { return self.plan.assembly_steps; },
          "List of Step: how it is put together, from the layout on.")
      .def_property_readonly(
          "complete", [](const HeldPlan& self) { return self.plan.status == PlanStatus::complete; },
          "True when what was asked for is done, by verified steps alone: every group is down to one part or to parts "
          "that "
          "are kept together, or the part that was asked for is out.")
      .def_property_readonly(
          "status", [](const HeldPlan& self) { return to_string(self.plan.status); },
          "'complete': what was asked for is done, by verified steps alone; 'forced': the same, and some steps are "
          "forced; 'partial': parts are still together that were to be separated.")
      .def_property_readonly(
          "forced", [](const HeldPlan& self) { return forced_numbers(self.plan); },
          "Numbers of the steps that are forced: not valid motions, see Step.forced.")
      .def_property_readonly(
          "assembly_status", [](const HeldPlan& self) { return to_string(self.plan.assembly_status); },
          "What assembly_steps are. 'complete': from the layout on; 'partial': some parts have no path from the "
          "layout; "
          "'reversed': the disassembly backwards, no layout was asked for.")
      .def_property_readonly(
          "assembly_message", [](const HeldPlan& self) { return self.plan.assembly_message; },
          "Why assembly_status is 'partial'; else empty.")
      .def_property_readonly(
          "overlaps",
          [](const HeldPlan& self) {
            std::vector<HeldOverlap> out;
            for (const auto& o : self.plan.assembly.overlaps) out.push_back(overlap_of(self.plan.assembly, o));
            return out;
          },
          "List of Overlap: pairs that are in each other when assembled.")
      .def_property_readonly(
          "certificates", [](const HeldPlan& self) { return self.plan.certificates; },
          "List of Certificate: proofs that parts cannot be separated.")
      .def_property_readonly(
          "objective", [](const HeldPlan& self) { return self.plan.objective; },
          "Objective: what the steps were judged by, and the sum of all costs.");
}

/// Parts and facts of the run.
void bind_plan_facts(PlanClass& plan) {
  plan.def_property_readonly(
          "removed",
          [](const HeldPlan& self) {
            std::vector<std::string> names;
            for (const auto& step : self.plan.disassembly)
              for (const auto& group : step.separates) names.insert(names.end(), group.begin(), group.end());
            return names;
          },
          "Names of the parts that steps separate, in order.")
      .def_property_readonly(
          "remaining", [](const HeldPlan& self) { return self.plan.remaining; },
          "Names of the parts that were never removed.")
      .def_property_readonly(
          "unsolved", [](const HeldPlan& self) { return self.plan.unsolved; },
          "List of Unsolved: why parts are still there.")
      .def_property_readonly(
          "names",
          [](const HeldPlan& self) {
            std::vector<std::string> names;
            for (const auto& part : self.plan.assembly.parts) names.push_back(part.name);
            return names;
          },
          "Names of all parts.")
      .def_property_readonly(
          "source", [](const HeldPlan& self) { return self.plan.assembly.source; }, "The input that the plan is for.")
      .def_property_readonly(
          "scale", [](const HeldPlan& self) { return self.plan.assembly.scale; }, "Assembly units per input unit.")
      .def_property_readonly(
          "unit", [](const HeldPlan& self) { return self.plan.assembly.unit; },
          "Input unit; empty when the files do not say.")
      .def_property_readonly(
          "seed", [](const HeldPlan& self) { return self.plan.seed; }, "Seed of the run.")
      .def_property_readonly(
          "tolerance", [](const HeldPlan& self) { return self.plan.verified_max_penetration; },
          "Penetration above the initial overlap with which every step was verified; assembly units.")
      .def_readonly(
          "info", &HeldPlan::info,
          "dict of facts about the run that made it (outcome, interrupted, attempts, memoised, prepare_seconds, "
          "plan_seconds, proof_seconds, planner_counts, sequence_counts, precedence); empty for a plan that was "
          "read.");
}

}  // namespace

void bind_plan(py::module_& m) {
  auto outcome = py::enum_<Outcome>(m, "Outcome", "How an attempt ended.");
  for (int k = 0; k <= static_cast<int>(Outcome::crashed); ++k)
    outcome.value(std::string(to_string(static_cast<Outcome>(k))).c_str(), static_cast<Outcome>(k));
  bind_overlap(m);
  bind_step(m);
  bind_unsolved(m);
  bind_verdicts(m);
  PlanClass plan(m, "Plan", "An order in which the parts come out, with a path for each (docs/plan-format.md).");
  bind_plan_texts(plan);
  bind_plan_steps(plan);
  bind_plan_facts(plan);
  m.def(
      "interpolate",
      [](const Array& a, const Array& b, double u) {
        return array_of(screw_interpolate(pose_of(a, "a"), pose_of(b, "b"), u));
      },
      py::arg("a"), py::arg("b"), py::arg("u"),
      "(7,): the pose at u in [0, 1] of the screw motion from pose a (7,) to pose b (7,), as plans prescribe it.");
}

}  // namespace dismantle::python
