// Step, Unsolved, Certificate: the contents of a plan.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/plan.h"

namespace dismantle::python {
namespace {

void bind_forced(py::module_& m) {
  py::class_<PlanForced>(m, "Forced", "What a forced step cuts into: the pair that is worst off.")
      .def_readonly("part", &PlanForced::part, "Name of the part that moves.")
      .def_readonly("other", &PlanForced::other, "Name of the part that it cuts into.")
      .def_readonly("depth", &PlanForced::depth, "Deepest along the whole path, measured; input units.")
      .def_readonly("assembled", &PlanForced::assembled, "What the pair overlaps when assembled; input units.")
      .def_property_readonly(
          "at", [](const PlanForced& f) { return array_of(f.at); }, "(3,): where; input coordinates.")
      .def_readonly("reason", &PlanForced::reason, "Why no verified path is known.")
      .def_readonly("certificate", &PlanForced::certificate,
                    "Index in Plan.certificates: the proof that there is no path; None: there is no proof.")
      .def_readonly("lower_bound", &PlanForced::lower_bound,
                    "True when the time was up before depth was measured to its end: it is at least that.")
      .def("__repr__", [](const PlanForced& f) {
        return fmt::format("<Forced: '{}' cuts {}{:.4g} into '{}'>", f.part, f.lower_bound ? "at least " : "", f.depth,
                           f.other);
      });
  py::class_<PlanStepOverlap>(m, "StepOverlap", "A pair that a step moves past each other although it overlaps.")
      .def_readonly("part", &PlanStepOverlap::part, "Name of the part that moves.")
      .def_readonly("other", &PlanStepOverlap::other, "Name of the other part.")
      .def_readonly("assembled", &PlanStepOverlap::assembled, "Depth when assembled; input units.")
      .def_readonly("allowed", &PlanStepOverlap::allowed,
                    "Depth that the step may have, without the tolerance; input units.")
      .def_readonly("depth", &PlanStepOverlap::depth, "Deepest along the step, measured; input units.")
      .def_property_readonly(
          "at", [](const PlanStepOverlap& o) -> py::object { return o.at ? py::object(array_of(*o.at)) : py::none(); },
          "(3,): where it is deepest, input coordinates, world; None in plans from older files.")
      .def_property_readonly(
          "region",
          [](const PlanStepOverlap& o) -> py::object {
            return o.region ? py::object(array_of(std::vector{o.region->lo, o.region->hi})) : py::none();
          },
          "(2, 3): where alone the two may be so deep, lowest and highest corner in the frame of either part as "
          "assembled; None: anywhere.");
}

}  // namespace

void bind_step(py::module_& m) {
  bind_forced(m);
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
          "Certified upper bound of the penetration along the path above the initial overlap; assembly units. Says "
          "nothing of a forced step.")
      .def_property_readonly(
          "forced", [](const PlanStep& s) { return s.forced; },
          "Forced, when no verified motion was found and the parts are taken out where they cut in least; else None. "
          "Such a step is not a valid motion.")
      .def_property_readonly(
          "overlaps", [](const PlanStep& s) { return s.overlaps; },
          "List of StepOverlap: pairs that this step moves past each other, and that overlap when assembled by more "
          "than "
          "`verify.named_overlap`.")
      .def_readonly("checks", &PlanStep::checks,
                    "List of Verdict: what the objective says of this step as an assembly operation. Steps of the "
                    "disassembly only.")
      .def_readonly("transfer", &PlanStep::transfer,
                    "Steps of assembly: index of the pose at which the motion from the layout ends and the disassembly "
                    "backwards begins; 0: there is no such motion.")
      .def_readonly("seconds", &PlanStep::seconds, "Planning time.")
      .def_readonly("planner", &PlanStep::planner, "Id of the planner that found the path.")
      .def_readonly("depth", &PlanStep::depth, "Number of actions in the path.")
      .def_readonly("contacts", &PlanStep::contacts, "Parts touched along the path.")
      .def_readonly("after", &PlanStep::after, "Numbers of the steps that have to be done before this one.")
      .def_readonly("layer", &PlanStep::layer, "Steps of one layer need not wait for each other; from 1.")
      .def("__repr__", [](const PlanStep& s) {
        std::string names;
        for (const auto& move : s.moves) names += (names.empty() ? "'" : ", '") + move.part + "'";
        return fmt::format("<Step {}: {}, {} poses{}>", s.step, names,
                           s.moves.empty() ? 0 : s.moves.front().poses.size(), s.forced ? ", forced" : "");
      });
}

void bind_verdicts(py::module_& m) {
  py::class_<StepNote>(m, "StepNote", "What a step check says for the reader of a plan.")
      .def(py::init<std::string, std::string, std::string>(), py::arg("kind"), py::arg("text"), py::arg("data") = "",
           "kind: for programs. text: one sentence for people. data: a JSON object as text, kept byte for byte; empty: "
           "none.")
      .def_readonly("kind", &StepNote::kind, "For programs.")
      .def_readonly("text", &StepNote::text, "One sentence for people.")
      .def_readonly("data", &StepNote::data, "A JSON object as text; empty: none.")
      .def("__repr__", [](const StepNote& n) { return fmt::format("<StepNote {}: {}>", n.kind, n.text); });
  py::class_<PlanVerdict>(m, "Verdict", "What a step check says about a step, or about a plan as a whole.")
      .def_readonly("type", &PlanVerdict::type, "Id of the check.")
      .def_readonly("weight", &PlanVerdict::weight, "Factor on the cost.")
      .def_readonly("cost", &PlanVerdict::cost, "Without the weight.")
      .def_readonly("allowed", &PlanVerdict::allowed, "False: the check says that nobody can carry out this step.")
      .def_readonly("reason", &PlanVerdict::reason, "Why there is a cost or a refusal.")
      .def_readonly("failed", &PlanVerdict::failed, "Not empty: the check could not judge, and why.")
      .def_readonly("notes", &PlanVerdict::notes, "List of StepNote.")
      .def_readonly("certificate", &PlanVerdict::certificate, "Certificate that proves it, or None.")
      .def("__repr__", [](const PlanVerdict& v) {
        return fmt::format("<Verdict of {}: cost {}{}>", v.type, v.cost, v.allowed ? "" : ", not allowed");
      });
  py::class_<PlanObjectiveItem>(m, "ObjectiveItem", "A check of the objective of a plan.")
      .def_readonly("type", &PlanObjectiveItem::type, "Id of the check.")
      .def_readonly("weight", &PlanObjectiveItem::weight, "Factor on its cost.")
      .def_readonly("require", &PlanObjectiveItem::require, "Steps that it does not allow were to be refused.")
      .def_readonly("cost", &PlanObjectiveItem::cost, "Sum over the plan, without the weight.")
      .def_readonly("plan", &PlanObjectiveItem::plan, "Verdict on the plan as a whole, or None.");
  py::class_<PlanObjective>(m, "Objective", "What the steps of a plan were judged by.")
      .def_readonly("cost", &PlanObjective::cost, "Weighted sum over all steps and checks.")
      .def_readonly("checks", &PlanObjective::checks, "List of ObjectiveItem; empty: the plan was not judged.")
      .def_property_readonly(
          "up", [](const PlanObjective& o) { return array_of(o.up); }, "(3,): how the assembly lies; unit.");
}

void bind_unsolved(py::module_& m) {
  py::class_<PlanUnsolved>(m, "Unsolved", "A part that did not come out, and why.")
      .def_readonly("part", &PlanUnsolved::part, "Name of the part.")
      .def_readonly("outcome", &PlanUnsolved::outcome, "Outcome of the last attempt.")
      .def_readonly("blocked_by", &PlanUnsolved::blocked_by, "Names of the parts that are in its way.")
      .def_property_readonly(
          "best_pose", [](const PlanUnsolved& u) { return array_of(u.best_pose); },
          "(7,): the pose that came furthest; input units.")
      .def_readonly("message", &PlanUnsolved::message, "Why, for a reader.")
      .def_readonly("planner", &PlanUnsolved::planner, "Id of the path planner that searched; empty: none did.")
      .def_readonly("certificate", &PlanUnsolved::certificate,
                    "Index in Plan.certificates: the proof that no motion exists; None: there is no proof.")
      .def_readonly("refused_by", &PlanUnsolved::refused_by,
                    "Id of the required step check that did not allow a removal; empty: none did.")
      .def_readonly("depth", &PlanUnsolved::depth, "Largest depth that a search was allowed; 0: one had no limit.")
      .def_property_readonly(
          "places",
          [](const PlanUnsolved& u) {
            std::vector<std::pair<std::string, Array>> out;
            for (const PlanPlace& p : u.places) out.emplace_back(p.part, array_of(p.at));
            return out;
          },
          "What the part touches at best_pose: list of (name, point (3,)), the deepest contact with each other part; "
          "input units.")
      .def_readonly("attempts", &PlanUnsolved::attempts, "Number of searches.")
      .def_readonly("seconds", &PlanUnsolved::seconds, "Time of these searches.")
      .def("__repr__",
           [](const PlanUnsolved& u) { return fmt::format("<Unsolved '{}': {}>", u.part, to_string(u.outcome)); });
  py::class_<PlanCertificate>(m, "Certificate", "A proof that parts cannot be separated; verify() checks it.")
      .def_readonly("kind", &PlanCertificate::kind, "Id of the prover that made it and checks it.")
      .def_readonly("parts", &PlanCertificate::parts, "Names of the parts.")
      .def_property_readonly(
          "poses", [](const PlanCertificate& c) { return array_of(c.poses); },
          "(N, 7): where the parts are, in their order, input units; N = 0: as assembled.")
      .def_readonly("margin", &PlanCertificate::margin, "Margin of the proof; assembly units.")
      .def_readonly("numbers", &PlanCertificate::numbers, "dict of what the prover states, by name; assembly units.")
      .def_readonly("text", &PlanCertificate::text, "The proof in words.");
}

}  // namespace dismantle::python
