// Path planners written in Python.
#include "dismantle/path_planner.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <stdexcept>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/edge_checker.h"
#include "python_type.h"
#include "run_view.h"
#include "world.h"

namespace dismantle::python {
namespace {

/// Python view of a PathQuery, valid during the search.
class QueryView {
 public:
  QueryView(const PathQuery& query, const RunContext& context, std::shared_ptr<const Assembly> assembly)
      : query_(&query), context_(&context), assembly_(std::move(assembly)), work_(std::make_shared<Work>()) {}

  /// Drops the references: objects that Python has kept raise from now on.
  void close() {
    for (const auto& world : worlds_)
      if (const auto open = world.lock()) open->close();
    query_ = nullptr;
    context_ = nullptr;
  }
  const PathQuery& query() const {
    if (query_ == nullptr) throw Error("this query is over");
    return *query_;
  }
  const Assembly& assembly() const { return *assembly_; }
  HeldAssembly loaded() const { return {{assembly_, {}}}; }
  std::uint64_t spent() const { return work_->steps + work_->state_checks; }
  bool should_stop() const {
    return query().budget.max_steps > 0 && spent() >= query().budget.max_steps ? true : context_->should_stop();
  }
  Outcome why_stopped() const { return context_->cancel.cancelled() ? Outcome::cancelled : Outcome::timeout; }
  const Work& work() const { return *work_; }
  std::uint64_t refused = 0;
  std::map<std::string, double> counts;  ///< the planner's own

  std::shared_ptr<HeldWorld> world(const std::string& space) {
    const PathQuery& q = query();
    const MotionSpace motion = motion_space(space);
    // The query exists until close().
    const auto make = [&q, motion] { return q.simulator.world(q.assembly, q.prepared, q.scene, motion); };
    std::shared_ptr<HeldWorld> held;
    {
      py::gil_scoped_release release;
      held = std::make_shared<HeldWorld>(assembly_, make, work_);
    }
    worlds_.push_back(held);
    return held;
  }

  PathCheck check(const Array& path) {
    const PathQuery& q = query();
    const Path given = path_of(path, q.scene.moving.size(), "path");
    PathCheck answer;
    {
      py::gil_scoped_release release;
      answer = q.checker.check(given);
    }
    if (!answer.accepted()) ++refused;
    return answer;
  }

  PathCheck check_edge(const Array& from, const Array& to) {
    const geometry::EdgeChecker* edges = geometry::edge_checker(query().checker);
    if (edges == nullptr) throw Error("this query checks whole paths only");
    const std::vector<Pose> begin = poses_of(from, "start"), end = poses_of(to, "end");
    py::gil_scoped_release release;
    return edges->check_edge(begin, end);
  }

 private:
  const PathQuery* query_;
  const RunContext* context_;
  std::shared_ptr<const Assembly> assembly_;
  std::shared_ptr<Work> work_;
  std::vector<std::weak_ptr<HeldWorld>> worlds_;
};

PathResult solved(const PathCheck& check, unsigned depth) {
  if (!check.accepted()) throw py::value_error("the path was refused: " + check.reason);
  PathResult result;
  result.solve(*check.verified, depth);
  return result;
}

PathResult failed(Outcome outcome, const std::string& message, const py::object& blocked_by,
                  const py::object& best_pose) {
  if (is_success(outcome)) throw py::value_error("failed() takes an outcome that is no success");
  PathResult result = PathResult::failure(outcome, message);
  for (const py::handle id : py::cast<py::iterable>(blocked_by)) result.blocked_by.push_back(py::cast<PartId>(id));
  if (!best_pose.is_none()) result.best_pose = poses_of(py::cast<Array>(best_pose), "best_pose");
  return result;
}

/// Converts the return value of `plan`: a PathResult, an accepted PathCheck, a path, or None.
PathResult result_of(const py::object& returned, QueryView& view) {
  if (py::isinstance<PathResult>(returned)) return py::cast<PathResult>(returned);
  if (py::isinstance<PathCheck>(returned)) {
    const auto check = py::cast<PathCheck>(returned);
    return check.accepted() ? solved(check, 1) : PathResult::failure(Outcome::exhausted, check.reason);
  }
  if (returned.is_none())
    return PathResult::failure(view.should_stop() ? view.why_stopped() : Outcome::exhausted,
                               "the planner found no path");
  const PathCheck check = view.check(py::cast<Array>(returned));
  if (!check.accepted()) throw std::runtime_error("plan() returned a path that the verifier refuses: " + check.reason);
  return solved(check, 1);
}

class PythonPathPlanner final : public FunctionPathPlanner {
 public:
  PythonPathPlanner(PythonType type, Held object) : type_(std::move(type)), object_(std::move(object)) {}

  PathPlannerTraits traits() const noexcept override {
    return {.needs = type_.needs, .simultaneous_motion = type_.simultaneous_motion};
  }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    py::gil_scoped_acquire lock;
    if (assembly_ == nullptr || seen_ != &query.assembly) {
      seen_ = &query.assembly;
      assembly_ = std::make_shared<const Assembly>(query.assembly);  // meshes are shared
    }
    const auto view = std::make_shared<QueryView>(query, context, assembly_);
    const auto run = std::make_shared<RunView>(context);
    PathResult result;
    std::string problem;
    try {
      result = result_of(object_->attr("plan")(view, run), *view);
    } catch (py::error_already_set& error) {
      problem = traceback_of(error);
    } catch (const py::cast_error&) {
      problem = "plan() has to return a PathResult, a PathCheck, a path (K, M, 7), or None";
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (result.stats.steps == 0) result.stats.steps = view->work().steps;
    if (result.stats.state_checks == 0) result.stats.state_checks = view->work().state_checks;
    if (result.stats.refused == 0) result.stats.refused = view->refused;
    for (const auto& [name, value] : view->counts) result.stats.extra[name] += value;
    if (result.stats.cost == 0) result.stats.cost = static_cast<double>(view->spent());
    view->close();
    run->close();
    if (!problem.empty()) throw std::runtime_error(problem);
    return result;
  }

 private:
  PythonType type_;
  Held object_;
  const Assembly* seen_ = nullptr;
  std::shared_ptr<const Assembly> assembly_;
};

std::vector<std::string> names_of(const QueryView& view, const std::vector<PlacedPart>& parts) {
  std::vector<std::string> names;
  for (const auto& p : parts) names.push_back(view.assembly().parts[p.part].name);
  return names;
}

Array placed(const std::vector<PlacedPart>& parts) {
  std::vector<Pose> poses;
  for (const auto& p : parts) poses.push_back(p.pose);
  return array_of(poses);
}

void bind_path_result(py::module_& m) {
  py::class_<PathCheck>(m, "PathCheck", "The verifier's answer about a path. True in a condition when it was accepted.")
      .def_property_readonly("accepted", &PathCheck::accepted, "True when the path is a valid removal.")
      .def("__bool__", &PathCheck::accepted)
      .def_readonly("reason", &PathCheck::reason, "Why it was refused; empty when accepted.")
      .def_property_readonly(
          "witness",
          [](const PathCheck& c) -> py::object {
            if (!c.has_witness) return py::none();
            py::dict out;
            out["part"] = c.part;
            out["other"] = c.other;
            out["point"] = array_of(c.point);
            out["instant"] = c.instant;
            out["poses"] = array_of(c.poses);
            return out;
          },
          "Where a refused path fails: dict of part, other (numbers of parts), point (3,) of `part` in its "
          "assembled frame, instant (index of the path at or just before it), poses (M, 7); None when "
          "accepted, or not known.");
  py::class_<PathResult>(m, "PathResult", "The answer of a path planner.")
      .def_static("solved", &solved, py::arg("check"), py::arg("depth") = 1,
                  "Success with an accepted PathCheck. depth: number of actions in the path.")
      .def_static(
          "failed", &failed, py::arg("outcome") = Outcome::exhausted, py::arg("message") = "",
          py::arg("blocked_by") = py::tuple(), py::arg("best_pose") = py::none(),
          "No path. blocked_by: numbers of fixed parts that are in the way; best_pose: (M, 7), the state that came "
          "furthest.")
      .def_static(
          "start_is_goal",
          [] {
            PathResult result;
            result.start_is_goal();
            return result;
          },
          "There is nothing to do: the moving parts are out already.")
      .def_property_readonly("outcome", &PathResult::outcome, "Outcome.")
      .def_readonly("message", &PathResult::message, "Failed: why.")
      .def_property(
          "nodes", [](const PathResult& r) { return r.stats.nodes; },
          [](PathResult& r, std::uint64_t n) { r.stats.nodes = n; }, "States kept in search trees, for reports.")
      .def_property(
          "cost", [](const PathResult& r) { return r.stats.cost; }, [](PathResult& r, double c) { r.stats.cost = c; },
          "Work of the search; 0: simulated steps and state checks are counted.");
}

void bind_path_query(py::module_& m) {
  py::class_<QueryView, std::shared_ptr<QueryView>>(
      m, "PathQuery",
      "One question to a path planner: how do the moving parts leave? Assembly "
      "units. Valid until plan() returns.")
      .def_property_readonly("assembly", &QueryView::loaded, "Assembly.")
      .def_property_readonly(
          "moving", [](const QueryView& v) { return names_of(v, v.query().scene.moving); },
          "Names of the M moving parts, by column of the path.")
      .def_property_readonly(
          "fixed", [](const QueryView& v) { return names_of(v, v.query().scene.fixed); },
          "Names of the fixed parts; all others are absent.")
      .def_property_readonly(
          "start", [](const QueryView& v) { return placed(v.query().scene.moving); },
          "(M, 7): where the moving parts are; the first instant of a path.")
      .def_property_readonly(
          "fixed_poses", [](const QueryView& v) { return placed(v.query().scene.fixed); },
          "(N, 7): where the fixed parts are.")
      .def_property_readonly(
          "any_of",
          [](const QueryView& v) {
            std::vector<std::string> names;
            for (const PartId id : v.query().goal.any_of) names.push_back(v.assembly().parts[id].name);
            return names;
          },
          "Empty: the moving parts leave as one group. Else they move independently until one of these is "
          "out (only for planners that declare simultaneous_motion).")
      .def_property_readonly(
          "tolerance", [](const QueryView& v) { return v.query().tolerance; },
          "Penetration above the initial overlap that the verifier tolerates; assembly units.")
      .def_property_readonly(
          "max_steps", [](const QueryView& v) { return v.query().budget.max_steps; },
          "Simulated steps plus state checks that may be spent; 0 = no limit.")
      .def_property_readonly(
          "max_depth", [](const QueryView& v) { return v.query().budget.max_depth; },
          "Largest depth of the search; 0 = no limit.")
      .def_property_readonly("spent", &QueryView::spent,
                             "Simulated steps plus state checks of the worlds of this query.")
      .def("should_stop", &QueryView::should_stop,
           "True when the budget is spent, time is up, or the user asked to stop. Ask it at least every tenth of a "
           "second.")
      .def("world", &QueryView::world, py::arg("space") = "rigid",
           "A World of these parts. space: 'rigid' or 'translation'.")
      .def(
          "count", [](QueryView& v, const std::string& name, double by) { v.query(), v.counts[name] += by; },
          py::arg("name"), py::arg("by") = 1.0,
          "Adds to a count of the planner's own: Plan.info['planner_counts'], and a column counts.NAME of bench().")
      .def(
          "is_free",
          [](QueryView& v, const Array& from, const Array& to) { return geometry::is_free(v.check_edge(from, to)); },
          py::arg("start"), py::arg("end"),
          "The verifier's continuous check of the screw motion between two lists of poses (M, 7), wherever it begins "
          "and "
          "ends: for the edges of trees and roadmaps.")
      .def("check", &QueryView::check, py::arg("path"),
           "Shows a path to the verifier: (K, M, 7), or (K, 7) for one moving part; returns a PathCheck. Between two "
           "instants each part moves by the joining screw motion, so a straight line needs its two ends only.");
}

}  // namespace

void bind_path_planner(py::module_& m) {
  bind_run_view(m);
  bind_path_result(m);
  bind_path_query(m);
  m.def("_register_path_planner", [](const py::object& declared) {
    register_python_type(
        PluginKind::path_planner, declared, [](const PythonType& type, Held object) -> std::shared_ptr<void> {
          return std::shared_ptr<PathPlanner>(std::make_shared<PythonPathPlanner>(type, std::move(object)));
        });
  });
}

}  // namespace dismantle::python
