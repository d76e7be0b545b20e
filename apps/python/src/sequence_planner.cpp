// Sequence planners written in Python.
#include "dismantle/sequence_planner.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/part_set.h"
#include "python_type.h"
#include "run_view.h"

namespace dismantle::python {
namespace {

/// An answer of the oracle, valid during the run.
struct Answer {
  const AttemptResult* result = nullptr;
  std::shared_ptr<bool> open;
  const AttemptResult& get() const {
    if (!*open) throw Error("this answer belongs to a run that is over");
    return *result;
  }
};

/// Oracle, observer and bookkeeping of one call of plan().
class SequenceView {
 public:
  SequenceView(const Assembly& assembly, const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
               RunContext& context)
      : assembly_(&assembly),
        oracle_(&oracle),
        observer_(&observer),
        context_(&context),
        open_(std::make_shared<bool>(true)),
        constraints_(&query.constraints),
        disassembly_(assembly.parts.size(), query.start) {
    for (const auto& group : query.start)
      for (const PlacedPart& p : group) left_.push_back(p.part);
    steps_ = left_.size() - query.start.size();
  }
  void close() { *open_ = false; }
  PathOracle& oracle() const {
    check_open();
    return *oracle_;
  }
  const std::vector<PartId>& left() const { return left_; }
  std::vector<std::vector<PartId>> groups() const {
    std::vector<std::vector<PartId>> present = disassembly_.groups();
    std::erase_if(present, [](const auto& group) { return group.empty(); });
    return present;
  }
  const std::vector<Removal>& removals() const { return removals_; }
  std::map<std::string, double>& counts() { return counts_; }
  const std::map<std::string, double>& counts() const { return counts_; }
  const Constraints& constraints() const {
    check_open();
    return *constraints_;
  }
  /// Do the constraints let these parts leave the rest of their group?
  bool may_leave(const py::object& parts) const {
    const std::vector<PlacedPart> leaving = placed(parts, "moving");
    const std::vector<PlacedPart> rest = without(disassembly_.around(leaving.front().part), leaving);
    return dismantle::may_leave(ids_of(leaving), ids_of(rest), constraints());
  }
  bool is_done() const { return fulfilled(disassembly_, constraints()); }
  const Assembly& assembly() const { return *assembly_; }
  RunContext& context() const { return *context_; }

  Attempt question(const py::object& moving, const py::object& fixed, unsigned max_depth, const py::object& any_of,
                   bool resume) const {
    Attempt attempt;
    attempt.max_depth = max_depth;
    attempt.resume = resume;
    attempt.moving = placed(moving, "moving");
    if (fixed.is_none()) {
      attempt.fixed = without(disassembly_.around(attempt.moving.front().part), attempt.moving);
    } else {
      attempt.fixed = placed(fixed, "fixed");
    }
    attempt.goal.any_of = part_ids(*assembly_, any_of);
    return attempt;
  }

  Answer attempt(const py::object& moving, const py::object& fixed, unsigned max_depth, const py::object& any_of,
                 bool resume, std::uint64_t seed, unsigned best_of, std::uint64_t improve_steps,
                 const std::vector<Eigen::Vector3d>& without, double angle) {
    PathOracle& asked = oracle();
    Attempt question = this->question(moving, fixed, max_depth, any_of, resume);
    question.seed = seed;
    question.best_of = best_of;
    question.improve_steps = improve_steps;
    question.goal.angle = angle;
    for (const Eigen::Vector3d& direction : without) {
      if (!(direction.norm() > 0) || !direction.allFinite())
        throw py::value_error("without: directions are finite vectors, not zero");
      question.goal.without.push_back(direction.normalized());
    }
    const AttemptResult* result = nullptr;
    {
      py::gil_scoped_release release;
      result = &asked.attempt(question, *context_);
    }
    return {result, open_};
  }

  Answer propose(const py::object& moving, const Array& path, const py::object& fixed, bool placement) {
    PathOracle& asked = oracle();
    Attempt question = this->question(moving, fixed, 0, py::tuple(), false);
    if (!std::is_sorted(question.moving.begin(), question.moving.end(),
                        [](const auto& a, const auto& b) { return a.part < b.part; }))
      throw py::value_error("moving: parts in ascending order of their numbers, as the columns of the path");
    question.goal.placement = placement;
    const Path given = path_of(path, question.moving.size(), "path");
    const AttemptResult* result = nullptr;
    {
      py::gil_scoped_release release;
      result = &asked.propose(question, given, *context_);
    }
    return {result, open_};
  }

  void prefetch(const py::object& moves, unsigned max_depth) {
    PathOracle& asked = oracle();
    std::vector<Attempt> attempts;
    for (const py::handle moving : py::cast<py::iterable>(moves))
      attempts.push_back(
          question(py::reinterpret_borrow<py::object>(moving), py::none(), max_depth, py::tuple(), false));
    py::gil_scoped_release release;
    asked.prefetch(attempts, *context_);
  }

  py::object prove(const py::object& parts) {
    PathOracle& asked = oracle();
    SeparationQuestion question;
    question.parts = part_ids(*assembly_, parts);
    const Certificate* proof = nullptr;
    {
      py::gil_scoped_release release;
      proof = asked.prove(question, *context_);
    }
    return proof == nullptr ? py::object(py::none()) : py::str(proof->text);
  }

  /// Records a successful attempt as a removal.
  void remove(const Answer& answer) {
    check_open();
    const AttemptResult& result = answer.get();
    if (!is_success(result.result.outcome()))
      throw py::value_error(fmt::format("remove() takes an answer that is a success, this one is '{}'",
                                        to_string(result.result.outcome())));
    removals_.push_back({ids_of(result.attempt.moving), &result});
    DisassemblyStep step = step_of(removals_.back());
    left_ = without(left_, step.leaving());
    disassembly_.add(std::move(step));
    py::gil_scoped_release release;
    observer_->removed(removals_.back(), left_.size());
    context_->progress("sequence", disassembly_.steps().size(), steps_);
  }

  void check_open() const {
    if (!*open_) throw Error("this oracle belongs to a run that is over");
  }

 private:
  /// Parts by name or number, at their current poses.
  std::vector<PlacedPart> placed(const py::object& parts, const char* what) const {
    std::vector<PlacedPart> out;
    for (const PartId id : part_ids(*assembly_, parts)) out.push_back({id, disassembly_.pose(id)});
    if (out.empty() && std::string_view(what) == "moving") throw py::value_error("moving: name at least one part");
    return out;
  }

  const Assembly* assembly_;
  PathOracle* oracle_;
  SequenceObserver* observer_;
  RunContext* context_;
  std::shared_ptr<bool> open_;
  std::vector<PartId> left_;  // not removed yet
  const Constraints* constraints_;
  Disassembly disassembly_;
  std::size_t steps_ = 0;  // when all are apart
  std::vector<Removal> removals_;
  std::map<std::string, double> counts_;
};

/// `returned`: None, or answers about remaining parts.
SequenceResult result_of(const py::object& returned, const SequenceView& view) {
  SequenceResult result;
  result.removals = view.removals();
  result.remaining = view.left();
  result.counts = view.counts();
  const RunContext& context = view.context();
  if (!returned.is_none())
    for (const py::handle item : py::cast<py::iterable>(returned)) {
      if (!py::isinstance<Answer>(item))
        throw py::type_error("plan() has to return None, or a sequence of answers of the oracle");
      const AttemptResult& answer = py::cast<Answer>(item).get();
      if (is_success(answer.result.outcome())) continue;
      for (const PlacedPart& p : answer.attempt.moving)
        if (std::find(result.remaining.begin(), result.remaining.end(), p.part) != result.remaining.end())
          result.unsolved.push_back({p.part, answer.result.outcome(), answer.result.blocked_by,
                                     answer.attempt.moving.size() == 1 ? answer.result.best_pose : std::vector<Pose>{},
                                     answer.result.message, answer.certificate});
    }
  if (view.is_done()) {
    result.outcome = Outcome::solved;
    result.unsolved.clear();
  } else {
    const bool crashed = std::any_of(result.unsolved.begin(), result.unsolved.end(),
                                     [](const Unsolved& u) { return u.outcome == Outcome::crashed; });
    result.outcome = context.cancel.cancelled() ? Outcome::cancelled
                     : crashed                  ? Outcome::crashed
                     : context.should_stop()    ? Outcome::timeout
                                                : Outcome::exhausted;
  }
  return result;
}

class PythonSequencePlanner final : public SequencePlanner {
 public:
  PythonSequencePlanner(PythonType type, Held object) : type_(std::move(type)), object_(std::move(object)) {
    py::gil_scoped_acquire lock;
    keeps_constraints_ = py::cast<bool>(py::bool_(object_->attr("keeps_constraints")));
  }

  SequencePlannerTraits traits() const noexcept override { return {.keeps_constraints = keeps_constraints_}; }

  SequenceResult plan(const SequenceQuery& query, PathOracle& oracle, SequenceObserver& observer,
                      RunContext& context) override {
    py::gil_scoped_acquire lock;
    const HeldAssembly loaded{{std::make_shared<const Assembly>(query.assembly), {}}};
    const auto view = std::make_shared<SequenceView>(*loaded.assembly, query, oracle, observer, context);
    const auto run = std::make_shared<RunView>(context);
    SequenceResult result;
    std::string problem;
    try {
      result = result_of(object_->attr("plan")(loaded, view, run), *view);
    } catch (py::error_already_set& error) {
      problem = traceback_of(error);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    view->close();
    run->close();
    if (!problem.empty()) throw std::runtime_error(fmt::format("'{}' raised: {}", type_.id, problem));
    return result;
  }

 private:
  PythonType type_;
  Held object_;
  bool keeps_constraints_ = false;
};

void bind_answer(py::module_& m) {
  py::class_<Answer>(m, "Answer",
                     "An answer of the oracle. True in a condition when the parts can leave. Assembly units.")
      .def("__bool__", [](const Answer& a) { return is_success(a.get().result.outcome()); })
      .def_property_readonly(
          "outcome", [](const Answer& a) { return a.get().result.outcome(); }, "Outcome.")
      .def_property_readonly(
          "moving", [](const Answer& a) { return ids_of(a.get().attempt.moving); },
          "Numbers of the parts that move, ascending: columns of the path.")
      .def_property_readonly(
          "path",
          [](const Answer& a) -> py::object {
            const auto& path = a.get().result.path();
            if (!path) return py::none();
            return array_of_path(path->poses(), a.get().attempt.moving.size());
          },
          "(K, M, 7): the verified path; None when there is none.")
      .def_property_readonly(
          "blocked_by", [](const Answer& a) { return a.get().result.blocked_by; },
          "Numbers of the parts that are in the way, most often touched first.")
      .def_property_readonly(
          "message", [](const Answer& a) { return a.get().result.message; }, "Failed: why.")
      .def_property_readonly(
          "seconds", [](const Answer& a) { return a.get().seconds; }, "Planning time.")
      .def_property_readonly(
          "max_penetration", [](const Answer& a) { return a.get().max_penetration; },
          "Certified bound over the path, above the initial overlap.")
      .def_property_readonly(
          "proof",
          [](const Answer& a) -> py::object {
            const Certificate* proof = a.get().certificate;
            return proof == nullptr ? py::object(py::none()) : py::str(proof->text);
          },
          "Why it is proved that the parts cannot leave, in words; None: it is not proved.");
}

}  // namespace

void bind_sequence_planner(py::module_& m) {
  bind_answer(m);
  py::class_<SequenceView, std::shared_ptr<SequenceView>>(
      m, "Oracle",
      "All that a sequence planner sees of geometry: can these parts leave while those stay? It remembers answers, and "
      "every "
      "path in them is verified. Parts are given by name or number. Valid until plan() returns.")
      .def_property_readonly("left", &SequenceView::left, "Numbers of the parts that were not removed yet, ascending.")
      .def_property_readonly("groups", &SequenceView::groups,
                             "Lists of numbers of parts that are still together; at first one with all parts.")
      .def("attempt", &SequenceView::attempt, py::arg("moving"), py::arg("fixed") = py::none(),
           py::arg("max_depth") = 0, py::arg("any_of") = py::tuple(), py::arg("resume") = false, py::arg("seed") = 0,
           py::arg("best_of") = 1, py::arg("improve_steps") = 0, py::arg("without") = std::vector<Eigen::Vector3d>{},
           py::arg("angle") = Goal{}.angle,
           "Can `moving` leave as one group, while `fixed` (None: all others of their group) stay where they are? "
           "Returns an Answer. "
           "max_depth: effort, 0 = no limit. any_of: the moving parts move independently until one of these is out. "
           "resume: the "
           "search may resume an earlier one. Another answer to the same question: seed draws other random numbers; "
           "best_of takes the shortest path of so many seeds; improve_steps lets a search that says that it may "
           "improve go on for a better path; without: directions (N, 3) in which they must not leave, each by `angle` "
           "in radians.")
      .def("propose", &SequenceView::propose, py::arg("moving"), py::arg("path"), py::arg("fixed") = py::none(),
           py::arg("placement") = false,
           "Checks a path (K, M, 7) that the caller has found, in place of a search; returns an Answer. placement: the "
           "parts are "
           "moved and stay in their group.")
      .def(
          "count", [](SequenceView& v, const std::string& name, double by) { v.check_open(), v.counts()[name] += by; },
          py::arg("name"), py::arg("by") = 1.0,
          "Adds to a count of the planner's own: Plan.info['sequence_counts'], and a column counts.NAME of bench().")
      .def_property_readonly(
          "constraints",
          [](const SequenceView& v) {
            const Constraints& c = v.constraints();
            py::dict out;
            out["base"] = c.base;
            out["together"] = c.together;
            out["before"] = c.before;
            out["target"] = c.target ? py::object(py::int_(*c.target)) : py::object(py::none());
            return out;
          },
          "The user's constraints, for classes with keeps_constraints: dict of base (numbers of parts that are never "
          "moved), "
          "together (lists of numbers), before (pairs: the second leaves only after the first), target (a number or "
          "None).")
      .def("may_leave", &SequenceView::may_leave, py::arg("moving"),
           "Do the constraints let these parts leave the rest of their group?")
      .def_property_readonly("is_done", &SequenceView::is_done,
                             "True when all is apart that the constraints do not keep together, or the target is out.")
      .def("prefetch", &SequenceView::prefetch, py::arg("moves"), py::arg("max_depth") = 0,
           "Hint: attempts with these groups of moving parts will probably be asked for, in this order, all others of "
           "their "
           "group being fixed. Answers never depend on it.")
      .def("prove", &SequenceView::prove, py::arg("parts"),
           "Is it proved that these parts, as assembled, cannot be separated? The proof in words, or None.")
      .def("remove", &SequenceView::remove, py::arg("answer"),
           "Books the removal of an answer that is a success: a step of the plan. Do it as soon as it is decided, so "
           "that an "
           "interruption loses nothing.")
      .def_property_readonly(
          "tolerance", [](const SequenceView& v) { return v.oracle().tolerance(); },
          "Penetration above the initial overlap that the verifier tolerates; assembly units.");
  m.def("_register_sequence_planner", [](const py::object& declared) {
    register_python_type(
        PluginKind::sequence_planner, declared, [](const PythonType& type, Held object) -> std::shared_ptr<void> {
          return std::shared_ptr<SequencePlanner>(std::make_shared<PythonSequencePlanner>(type, std::move(object)));
        });
  });
}

}  // namespace dismantle::python
