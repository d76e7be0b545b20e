// Plan, Step: plan.json as arrays.
#include "dismantle/plan.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/write_file.h"

namespace dismantle::python {
namespace {

HeldPlan read(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in.is_open() || in.bad() || text.bad())
    throw InputError(file.string(), "cannot be read: " + std::generic_category().message(errno));
  return {plan_from_json(text.str(), file.string()), {}};
}

void bind_step(py::module_& m) {
  py::class_<PlanStep>(m, "Step", "One step of a plan: parts that move simultaneously, pose by pose.")
      .def_readonly("number", &PlanStep::step, "Number of the step, from 1.")
      .def_property_readonly(
          "parts",
          [](const PlanStep& s) {
            std::vector<std::string> names;
            for (const auto& move : s.moves) names.push_back(move.part);
            return names;
          },
          "Names of the parts that move.")
      .def_property_readonly(
          "moves",
          [](const PlanStep& s) {
            py::dict moves;
            for (const auto& move : s.moves) moves[py::str(move.part)] = array_of(move.poses);
            return moves;
          },
          "dict: part name to its poses, (N, 7) float64 with columns x, y, z, qw, qx, qy, qz. A pose takes "
          "the part's points, as they are in the input, to where they are: x' = R(q) x + t; input units. N is "
          "the same for all parts of the step. Between two poses a part moves by the joining screw motion.")
      .def_readonly("separates", &PlanStep::separates, "Groups of parts that the step separates: lists of names.")
      .def_readonly(
          "max_penetration", &PlanStep::max_penetration,
          "Certified upper bound of the penetration along the path above the initial overlap; assembly units.")
      .def_readonly("seconds", &PlanStep::seconds, "Planning time.")
      .def_readonly("planner", &PlanStep::planner, "Id of the planner that found the path.")
      .def_readonly("depth", &PlanStep::depth, "Number of actions in the path.")
      .def_readonly("contacts", &PlanStep::contacts, "Parts touched along the path.")
      .def_readonly("after", &PlanStep::after, "Numbers of the steps that have to be done before this one.")
      .def_readonly("layer", &PlanStep::layer, "Steps of one layer need not wait for each other; from 1.")
      .def("__repr__", [](const PlanStep& s) {
        std::string names;
        for (const auto& move : s.moves) names += (names.empty() ? "'" : ", '") + move.part + "'";
        return fmt::format("<Step {}: {}, {} poses>", s.step, names,
                           s.moves.empty() ? 0 : s.moves.front().poses.size());
      });
  py::class_<PlanUnsolved>(m, "Unsolved", "A part that did not come out, and why.")
      .def_readonly("part", &PlanUnsolved::part, "Name of the part.")
      .def_readonly("outcome", &PlanUnsolved::outcome, "Outcome of the last attempt.")
      .def_readonly("blocked_by", &PlanUnsolved::blocked_by, "Names of the parts that are in its way.")
      .def_property_readonly(
          "best_pose", [](const PlanUnsolved& u) { return array_of(u.best_pose); },
          "(7,): the pose that came furthest; input units.")
      .def_readonly("message", &PlanUnsolved::message, "Why, for a reader.")
      .def_readonly("planner", &PlanUnsolved::planner, "Id of the path planner that searched; empty: none did.")
      .def_readonly("attempts", &PlanUnsolved::attempts, "Number of searches.")
      .def_readonly("seconds", &PlanUnsolved::seconds, "Time of these searches.")
      .def("__repr__",
           [](const PlanUnsolved& u) { return fmt::format("<Unsolved '{}': {}>", u.part, to_string(u.outcome)); });
}

}  // namespace

void bind_plan(py::module_& m) {
  auto outcome = py::enum_<Outcome>(m, "Outcome", "How an attempt ended.");
  for (int k = 0; k <= static_cast<int>(Outcome::crashed); ++k)
    outcome.value(std::string(to_string(static_cast<Outcome>(k))).c_str(), static_cast<Outcome>(k));
  bind_step(m);
  py::class_<HeldPlan>(m, "Plan", "An order in which the parts come out, with a path for each (docs/plan-format.md).")
      .def_static(
          "read", [](const std::filesystem::path& file) { return read(file); }, py::arg("path"),
          "Reads a plan.json. Raises InputError with the place of what is wrong.")
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
          "summary", [](const HeldPlan& self) { return summary_text(self.plan); }, "What came out, in words.")
      .def_property_readonly(
          "steps", [](const HeldPlan& self) { return self.plan.disassembly; },
          "List of Step: how the assembly is taken apart, in order.")
      .def_property_readonly(
          "assembly_steps", [](const HeldPlan& self) { return self.plan.assembly_steps; },
          "List of Step: how it is put together, from the layout on.")
      .def_property_readonly(
          "complete", [](const HeldPlan& self) { return self.plan.status == PlanStatus::complete; },
          "True when every group is down to one part.")
      .def_property_readonly(
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
          "read.")
      .def("__repr__", [](const HeldPlan& self) {
        return fmt::format("<Plan of '{}': {}, {} steps, {} parts>", self.plan.assembly.source,
                           self.plan.status == PlanStatus::complete ? "complete" : "partial",
                           self.plan.disassembly.size(), self.plan.assembly.parts.size());
      });
  m.def(
      "interpolate",
      [](const Array& a, const Array& b, double u) {
        return array_of(screw_interpolate(pose_of(a, "a"), pose_of(b, "b"), u));
      },
      py::arg("a"), py::arg("b"), py::arg("u"),
      "(7,): the pose at u in [0, 1] of the screw motion from pose a (7,) to pose b (7,), as plans prescribe it.");
}

}  // namespace dismantle::python
