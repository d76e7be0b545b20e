// Simulator, World: step a scene, read contacts.
#include "world.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "bindings.h"
#include "dismantle/errors.h"
#include "interruptible.h"

namespace dismantle::python {
namespace {

constexpr std::size_t kStateColumns = 13;

struct StepOutcome {
  StepReport report;
  Trace trace;
  std::size_t bodies = 0;
};

struct ContactList {
  std::vector<Contact> contacts;
};

template <class Get>
Array rows_of(const ContactList& list, Get get) {
  std::vector<Eigen::Vector3d> rows;
  for (const Contact& c : list.contacts) rows.push_back(get(c));
  return array_of(rows);
}

/// A simulator by id, and what it has prepared last.
class HeldSimulator {
 public:
  HeldSimulator(const std::string& id, const py::dict& parameters) : registry_(make_registry()), id_(id) {
    const RegisteredType& type = registry_->find(PluginKind::simulator, id);
    ParamSet values;
    for (const auto& [key, value] : parameters) {
      const auto name = py::cast<std::string>(key);
      const auto spec =
          std::find_if(type.type.params.begin(), type.type.params.end(), [&](const auto& s) { return s.name == name; });
      if (spec == type.type.params.end())
        throw py::value_error(fmt::format("simulator '{}' has no parameter '{}'", id, name));
      values[name] = param_value(*spec, value);
    }
    simulator_ = registry_->create<Simulator>(id, values);
  }
  const std::string& id() const { return id_; }
  Capabilities capabilities() const { return simulator_->capabilities(); }

  std::shared_ptr<HeldWorld> world(const LoadedAssembly& loaded, const py::object& moving, const py::object& fixed,
                                   const std::string& space, double tolerance) {
    if (!(tolerance > 0)) throw py::value_error("tolerance: expected a number > 0, assembly units");
    const MotionSpace motion = motion_space(space);
    const Assembly& assembly = *loaded.assembly;
    Scene scene;
    for (const PartId id : part_ids(assembly, moving)) scene.moving.push_back({id, Pose{}});
    const auto moves = [&](PartId id) {
      return std::any_of(scene.moving.begin(), scene.moving.end(), [id](const PlacedPart& p) { return p.part == id; });
    };
    if (scene.moving.empty()) throw py::value_error("moving: name at least one part");
    if (scene.moving.size() > capabilities().max_moving)
      throw py::value_error(fmt::format("moving: '{}' moves at most {} parts", id_, capabilities().max_moving));
    if (fixed.is_none()) {
      for (const Part& part : assembly.parts)
        if (!moves(part.id)) scene.fixed.push_back({part.id, Pose{}});
    } else {
      for (const PartId id : part_ids(assembly, fixed)) {
        if (moves(id)) throw py::value_error("fixed: '" + assembly.parts[id].name + "' is one of the moving parts");
        scene.fixed.push_back({id, Pose{}});
      }
    }
    const CancelToken cancel;
    auto world = run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
      prepare(loaded.assembly, tolerance, cancel);
      return simulator_->world(assembly, *prepared_, scene, motion);
    });
    auto keep = std::make_shared<
        std::tuple<std::shared_ptr<Registry>, std::shared_ptr<Simulator>, std::shared_ptr<const PreparedAssembly>>>(
        registry_, simulator_, prepared_);
    return std::make_shared<HeldWorld>(loaded.assembly, keep, std::move(world), nullptr);
  }

 private:
  void prepare(const std::shared_ptr<const Assembly>& assembly, double tolerance, const CancelToken& cancel) {
    const std::lock_guard lock(mutex_);
    if (prepared_ != nullptr && assembly_ == assembly && tolerance_ == tolerance) return;
    RunContext context = make_context(cancel);
    prepared_ = simulator_->prepare(*assembly, tolerance, context);
    assembly_ = assembly;
    tolerance_ = tolerance;
  }

  std::shared_ptr<Registry> registry_;
  std::string id_;
  std::shared_ptr<Simulator> simulator_;
  std::mutex mutex_;
  std::shared_ptr<const Assembly> assembly_;
  std::shared_ptr<const PreparedAssembly> prepared_;
  double tolerance_ = 0;
};

}  // namespace

MotionSpace motion_space(const std::string& text) {
  if (text == "rigid") return MotionSpace::rigid;
  if (text == "translation") return MotionSpace::translation;
  throw py::value_error("space: expected 'rigid' or 'translation', got '" + text + "'");
}

HeldWorld::HeldWorld(std::shared_ptr<const Assembly> assembly, std::shared_ptr<void> keep, std::unique_ptr<World> world,
                     std::shared_ptr<Work> work)
    : keep_(std::move(keep)),
      assembly_(std::move(assembly)),
      world_(std::move(world)),
      work_(work != nullptr ? std::move(work) : std::make_shared<Work>()),
      bodies_(world_->scene().moving.size()),
      state_(world_->initial_state()) {}

void HeldWorld::close() { world_.reset(); }

World& HeldWorld::world() {
  if (world_ == nullptr) throw Error("this world belongs to a query that is over");
  return *world_;
}

Array HeldWorld::state_rows() const {
  Array out({bodies_, kStateColumns});
  for (std::size_t i = 0; i < bodies_; ++i) {
    const BodyState& body = state_.bodies[i];
    const Array pose = array_of(body.pose);
    double* row = out.mutable_data() + kStateColumns * i;
    std::copy_n(pose.data(), 7, row);
    for (int k = 0; k < 3; ++k) row[7 + k] = body.velocity[k], row[10 + k] = body.angular_velocity[k];
  }
  return out;
}

void HeldWorld::set_state(const Array& rows) {
  const bool flat = bodies_ == 1 && rows.ndim() == 1 && rows.size() == static_cast<py::ssize_t>(kStateColumns);
  if (!flat && (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(0)) != bodies_ ||
                static_cast<std::size_t>(rows.shape(1)) != kStateColumns))
    throw py::value_error(fmt::format("state: expected an array of shape ({}, 13)", bodies_));
  State state;
  for (std::size_t i = 0; i < bodies_; ++i) {
    const double* row = rows.data() + kStateColumns * i;
    Array pose(7);
    std::copy_n(row, 7, pose.mutable_data());
    BodyState& body = state.bodies.emplace_back();
    body.pose = pose_of(pose, "state");
    body.velocity = {row[7], row[8], row[9]};
    body.angular_velocity = {row[10], row[11], row[12]};
    if (!body.velocity.allFinite() || !body.angular_velocity.allFinite())
      throw py::value_error("state: a velocity is not finite");
  }
  world();
  state_ = state;
}

State HeldWorld::state_at(const py::object& poses) const {
  if (poses.is_none()) return state_;
  const std::vector<Pose> rows = poses_of(py::cast<Array>(poses), "poses");
  if (rows.size() != bodies_)
    throw py::value_error(fmt::format("poses: expected {} rows, one per moving part", bodies_));
  State state;
  for (const Pose& pose : rows) state.bodies.push_back({pose});
  return state;
}

void HeldWorld::set_poses(const Array& rows) {
  world();
  state_ = state_at(rows);
}

void HeldWorld::reset() { state_ = world().initial_state(); }

py::object HeldWorld::step(const Array& wrench, double duration, bool in_body_frame) {
  World& simulated = world();
  const bool flat = bodies_ == 1 && wrench.ndim() == 1 && wrench.size() == 6;
  if (!flat && (wrench.ndim() != 2 || static_cast<std::size_t>(wrench.shape(0)) != bodies_ || wrench.shape(1) != 6))
    throw py::value_error(
        fmt::format("wrench: expected an array of shape {}", bodies_ == 1 ? "(6,)" : fmt::format("({}, 6)", bodies_)));
  if (!(duration > 0) || !std::isfinite(duration))
    throw py::value_error("duration: expected a finite number > 0, seconds");
  Action action;
  action.in_body_frame = in_body_frame;
  for (std::size_t i = 0; i < bodies_; ++i) {
    const double* row = wrench.data() + 6 * i;
    action.wrenches.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
    if (!action.wrenches.back().force.allFinite() || !action.wrenches.back().torque.allFinite())
      throw py::value_error("wrench: a number is not finite");
  }
  StepOutcome outcome;
  outcome.bodies = bodies_;
  {
    py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    outcome.report = simulated.advance(state_, action, duration, &outcome.trace);
    work_->steps += outcome.report.steps;
  }
  return py::cast(std::move(outcome));
}

double HeldWorld::penetration(const py::object& poses) {
  World& simulated = world();
  const State state = state_at(poses);
  py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  ++work_->state_checks;
  return simulated.penetration(state);
}

py::object HeldWorld::contacts(const py::object& poses) {
  World& simulated = world();
  const State state = state_at(poses);
  ContactList list;
  {
    py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    ++work_->state_checks;
    simulated.contacts(state, list.contacts);
  }
  return py::cast(std::move(list));
}

bool HeldWorld::separated(const py::object& poses) {
  World& simulated = world();
  const State state = state_at(poses);
  py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  return simulated.separated(state);
}

bool HeldWorld::body_separated(std::size_t body) {
  World& simulated = world();
  if (body >= bodies_) throw py::index_error(fmt::format("no moving part {}: there are {}", body, bodies_));
  return simulated.body_separated(state_, body);
}

void bind_world(py::module_& m) {
  py::class_<Capabilities>(m, "Capabilities", "What a simulator can do.")
      .def_readonly("dynamics", &Capabilities::dynamics, "World.step() works.")
      .def_readonly("contacts", &Capabilities::contacts, "World.contacts() works.")
      .def_readonly("distance", &Capabilities::distance, "World.penetration() tells free states from colliding ones.")
      .def_readonly("max_moving", &Capabilities::max_moving, "Largest number of parts that may move simultaneously.");
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
          "(C,): depths; > 0 = penetrating beyond what was there when assembled.")
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
  py::class_<HeldWorld, std::shared_ptr<HeldWorld>>(
      m, "World",
      "A scene of a simulator: some parts move, others are fixed, all others are absent. It has a current state. "
      "Frames: "
      "assembly units, world axes, seconds, radians; a pose (7,) is x, y, z, qw, qx, qy, qz and takes the part's "
      "assembled "
      "points to where they are. Same states and wrenches give the same result to the last bit.")
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
           "simulator with `dynamics`.")
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
          "center", [](HeldWorld& w, std::size_t body) { return array_of(w.world().center(body)); },
          py::arg("body") = 0, "(3,): centre of a moving part in its assembled frame.")
      .def(
          "radius", [](HeldWorld& w, std::size_t body) { return w.world().radius(body); }, py::arg("body") = 0,
          "Largest distance of the part's points from its centre.")
      .def(
          "torque_arm", [](HeldWorld& w, std::size_t body) { return w.world().torque_arm(body); }, py::arg("body") = 0,
          "Length that makes unit force and unit torque comparable: torque = force * torque_arm.")
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
  py::class_<HeldSimulator, std::shared_ptr<HeldSimulator>>(m, "Simulator", "A simulator plugin.")
      .def(py::init<const std::string&, const py::dict&>(), py::arg("id") = "sdf_penalty",
           py::arg("parameters") = py::dict(),
           "Makes the simulator of that id; parameters that are not given have their defaults.")
      .def_property_readonly("id", &HeldSimulator::id, "Id of the plugin.")
      .def_property_readonly("capabilities", &HeldSimulator::capabilities, "Capabilities.")
      .def("world", &HeldSimulator::world, py::arg("assembly"), py::arg("moving"), py::arg("fixed") = py::none(),
           py::arg("space") = "rigid", py::arg("tolerance") = 0.01,
           "Makes a World. moving, fixed: names or numbers of parts; fixed None: all that do not move. space: 'rigid' "
           "or "
           "'translation' (orientation is locked). tolerance: penetration that the verifier lets pass, assembly units, "
           "> 0.");
}

}  // namespace dismantle::python
