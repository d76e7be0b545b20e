// World, StepReport, Contacts: the Python interface of a scene.
#include <pybind11/stl.h>

#include "bindings.h"
#include "world.h"

namespace dismantle::python {
namespace {

template <class Get>
Array rows_of(const ContactList& list, Get get) {
  std::vector<Eigen::Vector3d> rows;
  for (const Contact& c : list.contacts) rows.push_back(get(c));
  return array_of(rows);
}

using WorldClass = py::class_<HeldWorld, std::shared_ptr<HeldWorld>>;

void bind_step_report(py::module_& m) {
  py::class_<StepOutcome>(m, "StepReport", "What World.step() did.")
      .def_property_readonly(
          "steps", [](const StepOutcome& s) { return s.report.steps; }, "Time steps simulated.")
      .def_property_readonly(
          "travel", [](const StepOutcome& s) { return s.report.travel; },
          "Largest displacement of any point of a moving part, from begin to end; assembly units.")
      .def_property_readonly(
          "stalled", [](const StepOutcome& s) { return s.report.stalled; },
          "True: it stopped early, nothing moves any more under this wrench.")
      .def_property_readonly(
          "finite", [](const StepOutcome& s) { return s.report.finite; },
          "False: the state became non-finite and was put back to where it began.")
      .def_property_readonly(
          "poses", [](const StepOutcome& s) { return array_of_path(s.trace, s.bodies); },
          "(T, M, 7): poses along the step, begin excluded, end included.");
}

void bind_contacts(py::module_& m) {
  py::class_<ContactList>(m, "Contacts", "Contacts of a state, one row each. Assembly units, world axes.")
      .def_property_readonly(
          "points", [](const ContactList& l) { return rows_of(l, [](const Contact& c) { return c.point; }); },
          "(C, 3): places.")
      .def_property_readonly(
          "normals", [](const ContactList& l) { return rows_of(l, [](const Contact& c) { return c.normal; }); },
          "(C, 3): unit vectors that push `moving` away from `other`.")
      .def_property_readonly(
          "depths",
          [](const ContactList& l) {
            Array out(static_cast<py::ssize_t>(l.contacts.size()));
            for (std::size_t i = 0; i < l.contacts.size(); ++i) out.mutable_data()[i] = l.contacts[i].depth;
            return out;
          },
          "(C,): depths; > 0 = penetrating beyond what was there when assembled. Right after step() those of a short "
          "way "
          "are the simulator's own, linear along that way.")
      .def_property_readonly(
          "parts",
          [](const ContactList& l) {
            Indices out({l.contacts.size(), std::size_t{2}});
            std::int64_t* to = out.mutable_data();
            for (const Contact& c : l.contacts) *to++ = c.moving, *to++ = c.other;
            return out;
          },
          "(C, 2) int64: numbers of the moving part and of the other one.")
      .def("__len__", [](const ContactList& l) { return l.contacts.size(); });
}

/// State, and how it moves.
void bind_motion(WorldClass& world) {
  world
      .def_property("state", &HeldWorld::state_rows, &HeldWorld::set_state,
                    "(M, 13): pose (7), velocity of the centre (3), angular velocity (3) of each moving part.")
      .def_property(
          "poses",
          [](const HeldWorld& w) {
            std::vector<Pose> poses;
            for (const auto& body : w.state().bodies) poses.push_back(body.pose);
            return array_of(poses);
          },
          &HeldWorld::set_poses, "(M, 7): poses of the moving parts. Setting them puts the parts at rest.")
      .def("reset", &HeldWorld::reset, "Puts the moving parts back to where they began, at rest.")
      .def("step", &HeldWorld::step, py::arg("wrench"), py::arg("duration") = 0.1, py::arg("in_body_frame") = false,
           "Applies a wrench for `duration` seconds, and returns a StepReport. wrench: (6,) for one moving part, (M, "
           "6) for "
           "several: force (3) and torque about the centre (3); world axes, or those of the parts with in_body_frame. "
           "Needs a "
           "simulator with `dynamics`.");
}

/// Penetration, contacts and separation.
void bind_queries(WorldClass& world) {
  world
      .def("penetration", &HeldWorld::penetration, py::arg("poses") = py::none(),
           "Deepest penetration above what was there when assembled, >= 0; assembly units. Of the current state, or "
           "with the "
           "moving parts at `poses` (M, 7).")
      .def("contacts", &HeldWorld::contacts, py::arg("poses") = py::none(),
           "Contacts of the current state, or at `poses` (M, 7).")
      .def("separated", &HeldWorld::separated, py::arg("poses") = py::none(),
           "True when the hull of all moving parts is apart from that of all fixed parts.")
      .def("body_separated", &HeldWorld::body_separated, py::arg("body"),
           "True when the hull of moving part `body` (0 to M - 1) is apart from that of all others.")
      .def(
          "project_to_clearance", &HeldWorld::project_to_clearance, py::arg("clearance"),
          "Moves the parts, by as little as it takes, so that they keep `clearance` (assembly units, small, >= 0) from "
          "what they would touch, or half of what room there is. Simulators that cannot leave the state as it is.")
      .def(
          "add_contact_sample",
          [](HeldWorld& w, const py::object& part, const py::object& other, const Array& point) {
            const auto a = part_ids(w.assembly(), part), b = part_ids(w.assembly(), other);
            if (a.size() != 1 || b.size() != 1) throw py::value_error("expected one part and one other part");
            w.add_contact_sample(a.front(), b.front(), vector_of(point, "point"));
          },
          py::arg("part"), py::arg("other"), py::arg("point"),
          "Tells the simulator of a place where the verifier found it too permissive, as PathCheck.witness says: "
          "`point` "
          "(3,) of `part`, in its assembled frame, lay inside `other`. Simulators that sample contact add it.")
      .def("allow_overlap_everywhere", &HeldWorld::allow_overlap_everywhere,
           "From now on the depth that a pair overlaps when assembled is allowed everywhere, as the verifier does, not "
           "only where it was.");
}

/// What the world consists of.
void bind_parts(WorldClass& world) {
  world
      .def(
          "center", [](HeldWorld& w, std::size_t body) { return array_of(w.world_with_body(body).center(body)); },
          py::arg("body") = 0, "(3,): centre of a moving part in its assembled frame.")
      .def(
          "radius", [](HeldWorld& w, std::size_t body) { return w.world_with_body(body).radius(body); },
          py::arg("body") = 0, "Largest distance of the part's points from its centre.")
      .def(
          "torque_arm", [](HeldWorld& w, std::size_t body) { return w.world_with_body(body).torque_arm(body); },
          py::arg("body") = 0, "Length that makes unit force and unit torque comparable: torque = force * torque_arm.")
      .def_property_readonly(
          "moving",
          [](HeldWorld& w) {
            std::vector<std::string> names;
            for (const auto& p : w.world().scene().moving) names.push_back(w.assembly().parts[p.part].name);
            return names;
          },
          "Names of the moving parts.")
      .def_property_readonly(
          "fixed",
          [](HeldWorld& w) {
            std::vector<std::string> names;
            for (const auto& p : w.world().scene().fixed) names.push_back(w.assembly().parts[p.part].name);
            return names;
          },
          "Names of the fixed parts.");
}

}  // namespace

void bind_world(py::module_& m) {
  bind_step_report(m);
  bind_contacts(m);
  WorldClass world(
      m, "World",
      "A scene of a simulator: some parts move, others are fixed, all others are absent. It has a current state. "
      "Frames: assembly units, world axes, seconds, radians; a pose (7,) is x, y, z, qw, qx, qy, qz and takes the "
      "part's assembled points to where they are. After reset(), and after a state or poses were set, the same calls "
      "give the same results to the last bit.");
  bind_motion(world);
  bind_queries(world);
  bind_parts(world);
}

}  // namespace dismantle::python
