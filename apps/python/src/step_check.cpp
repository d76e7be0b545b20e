// Step checks that are written in Python.
#include "dismantle/step_check.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "arrays.h"
#include "bindings.h"
#include "python_type.h"

namespace dismantle::python {
namespace {

/// A StepQuestion whose data belongs to Python.
struct HeldQuestion {
  std::shared_ptr<const Assembly> assembly;
  std::vector<PlacedPart> moving, present;
  Eigen::Vector3d direction, up;
  std::optional<Trace> path{};
  std::shared_ptr<HeldQuestion> previous{};

  std::vector<std::string> names(const std::vector<PlacedPart>& parts) const {
    std::vector<std::string> out;
    for (const PlacedPart& p : parts) out.push_back(assembly->parts.at(p.part).name);
    return out;
  }
  static py::dict poses(const HeldQuestion& question, const std::vector<PlacedPart>& parts) {
    py::dict out;
    for (const PlacedPart& p : parts) out[py::str(question.assembly->parts.at(p.part).name)] = array_of(p.pose);
    return out;
  }
};

class PythonStepCheck final : public StepCheck {
 public:
  PythonStepCheck(PythonType type, Held object) : type_(std::move(type)), object_(std::move(object)) {
    py::gil_scoped_acquire lock;
    for (const py::handle word : py::cast<py::iterable>(object_->attr("remembers"))) {
      const auto text = py::cast<std::string>(word);
      bool* const remembered = text == "direction"     ? &traits_.remembers_direction
                               : text == "orientation" ? &traits_.remembers_orientation
                               : text == "shape"       ? &traits_.remembers_shape
                                                       : nullptr;
      if (remembered == nullptr)
        throw std::runtime_error(
            fmt::format("'{}' remembers '{}'; there are 'direction', 'orientation', 'shape'", type_.id, text));
      *remembered = true;
    }
    traits_.judges_plan = py::hasattr(*object_, "judge_plan");
  }

  StepCheckTraits traits() const noexcept override { return traits_; }

  StepVerdict judge(const StepQuestion& question, const RunContext&) const override {
    return ask([&] { return object_->attr("judge")(held(question)); });
  }

  StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext&) const override {
    return ask([&] {
      py::list questions;
      for (const StepQuestion& question : operations) questions.append(held(question));
      return object_->attr("judge_plan")(questions);
    });
  }

 private:
  template <class F>
  StepVerdict ask(F call) const {
    py::gil_scoped_acquire lock;
    try {
      return verdict_of(call());
    } catch (py::error_already_set& error) {
      throw std::runtime_error(fmt::format("'{}' raised: {}", type_.id, traceback_of(error)));
    }
  }

  static StepVerdict verdict_of(const py::object& answer) {
    StepVerdict verdict;
    if (answer.is_none()) return verdict;
    verdict.cost = py::cast<double>(py::float_(answer.attr("cost")));
    verdict.allowed = py::cast<bool>(answer.attr("allowed"));
    verdict.reason = py::cast<std::string>(answer.attr("reason"));
    for (const py::handle note : py::cast<py::iterable>(answer.attr("notes")))
      verdict.notes.push_back(py::cast<StepNote>(note));
    return verdict;
  }

  /// Python may keep the assembly longer than the question; a copy serves all questions about it.
  std::shared_ptr<const Assembly> shared(const Assembly& assembly) const {
    const auto same = [](const Part& a, const Part& b) { return a.mesh == b.mesh && a.name == b.name; };
    if (!assembly_ || !std::equal(assembly.parts.begin(), assembly.parts.end(), assembly_->parts.begin(),
                                  assembly_->parts.end(), same))
      assembly_ = std::make_shared<const Assembly>(assembly);
    return assembly_;
  }

  std::shared_ptr<HeldQuestion> held(const StepQuestion& question) const {
    auto out = std::make_shared<HeldQuestion>();
    out->assembly = shared(question.assembly);
    out->moving.assign(question.moving.begin(), question.moving.end());
    out->present.assign(question.present.begin(), question.present.end());
    out->direction = question.direction;
    out->up = question.up;
    if (question.path != nullptr) out->path = *question.path;
    if (question.previous != nullptr) out->previous = held(*question.previous);
    return out;
  }

  PythonType type_;
  Held object_;
  StepCheckTraits traits_;
  mutable std::shared_ptr<const Assembly> assembly_;  // guarded by the interpreter's lock
};

}  // namespace

void bind_step_check(py::module_& m) {
  py::class_<HeldQuestion, std::shared_ptr<HeldQuestion>>(
      m, "StepQuestion",
      "One step of a disassembly, seen backwards: parts are put in. Assembly units; world frame as assembled.")
      .def_property_readonly(
          "assembly",
          [](const HeldQuestion& q) {
            HeldAssembly loaded;
            loaded.assembly = q.assembly;
            return loaded;
          },
          "The Assembly.")
      .def_property_readonly(
          "moving", [](const HeldQuestion& q) { return q.names(q.moving); }, "Names of the parts that are put in.")
      .def_property_readonly(
          "present", [](const HeldQuestion& q) { return q.names(q.present); },
          "Names of the other parts of what has been built.")
      .def_property_readonly(
          "poses",
          [](const HeldQuestion& q) {
            py::dict all = HeldQuestion::poses(q, q.present);
            all.attr("update")(HeldQuestion::poses(q, q.moving));
            return all;
          },
          "dict: name of each moving and present part to its pose (7,) at the end of the operation.")
      .def_property_readonly(
          "direction", [](const HeldQuestion& q) { return array_of(q.direction); },
          "(3,): unit vector of the last stretch of the insertion; zero for a rotation in place.")
      .def_property_readonly(
          "path",
          [](const HeldQuestion& q) -> py::object {
            return q.path ? py::object(array_of_path(*q.path, q.moving.size())) : py::none();
          },
          "(K, M, 7): the insertion, columns as `moving`; None: only the direction is known.")
      .def_property_readonly(
          "up", [](const HeldQuestion& q) { return array_of(q.up); }, "(3,): how the assembly lies; unit.")
      .def_property_readonly(
          "previous", [](const HeldQuestion& q) { return q.previous; },
          "StepQuestion of the operation before, or None. Only what the check `remembers` may be used.");
  m.def("_register_step_check", [](const py::object& declared) {
    register_python_type(
        PluginKind::step_check, declared, [](const PythonType& type, Held object) -> std::shared_ptr<void> {
          return std::shared_ptr<StepCheck>(std::make_shared<PythonStepCheck>(type, std::move(object)));
        });
  });
}

}  // namespace dismantle::python
