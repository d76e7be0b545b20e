// Simulator: a plugin by id, and its worlds.
#include "dismantle/simulator.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <mutex>

#include "bindings.h"
#include "dismantle/errors.h"
#include "interruptible.h"
#include "world.h"
#include "worlds.h"

namespace dismantle::python {
namespace {

/// A simulator by id, and the assembly that it prepared last.
class HeldSimulator {
 public:
  HeldSimulator(const std::string& id, const py::dict& parameters) : registry_(make_registry()), id_(id) {
    const RegisteredType& type = registry_->find(PluginKind::simulator, id);
    ParamSet values;
    const auto take = [&](const py::dict& given, const std::string& kind) {
      for (const auto& [key, value] : given) {
        const auto name = py::cast<std::string>(key);
        if (name == "advanced" && kind.empty()) continue;
        const auto spec = std::find_if(type.type.params.begin(), type.type.params.end(),
                                       [&](const auto& s) { return s.name == name && (kind.empty() || s.advanced); });
        if (spec == type.type.params.end())
          throw py::value_error(fmt::format("simulator '{}' has no {}parameter '{}'", id, kind, name));
        if (spec->advanced && kind.empty())
          log_to_python(
              LogLevel::warning,
              fmt::format("'{0}' is an advanced parameter: write parameters={{'advanced': {{'{0}': ...}}}}", name));
        values[name] = param_value(*spec, value);
      }
    };
    take(parameters, "");
    if (parameters.contains("advanced")) take(parameters["advanced"], "advanced ");
    simulator_ = registry_->create<Simulator>(id, values);
  }
  const std::string& id() const { return id_; }
  Capabilities capabilities() const { return simulator_->capabilities(); }

  std::shared_ptr<HeldWorld> world(const HeldAssembly& loaded, const py::object& moving, const py::object& fixed,
                                   const std::string& space, double tolerance) {
    return made<HeldWorld>(loaded, moving, fixed, space, tolerance, [&](auto make) {
      return std::make_shared<HeldWorld>(loaded.assembly, std::move(make), nullptr);
    });
  }

  std::shared_ptr<HeldWorlds> worlds(const HeldAssembly& loaded, const py::object& moving, std::size_t count,
                                     const py::object& fixed, const std::string& space, double tolerance,
                                     unsigned threads) {
    if (count < 1 || threads < 1) throw py::value_error("count, threads: expected a number >= 1");
    return made<HeldWorlds>(loaded, moving, fixed, space, tolerance,
                            [&](auto make) { return std::make_shared<HeldWorlds>(std::move(make), count, threads); });
  }

 private:
  /// Result of `build(make)`, where make() makes worlds of the scene.
  template <class Result, class Build>
  std::shared_ptr<Result> made(const HeldAssembly& loaded, const py::object& moving, const py::object& fixed,
                               const std::string& space, double tolerance, Build build) {
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
    check_once(scene, assembly);
    const CancelToken cancel;
    return run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
      // The captures keep the plugin loaded and the prepared assembly alive as long as the world.
      const auto make = [registry = registry_, simulator = simulator_, kept = loaded.assembly,
                         prepared = prepare(loaded.assembly, tolerance, cancel), scene,
                         motion] { return simulator->world(*kept, *prepared, scene, motion); };
      return build(make);
    });
  }

  static void check_once(const Scene& scene, const Assembly& assembly) {
    std::vector<bool> seen(assembly.parts.size());
    for (const auto* parts : {&scene.moving, &scene.fixed})
      for (const PlacedPart& p : *parts) {
        if (seen[p.part]) throw py::value_error("'" + assembly.parts[p.part].name + "' is named twice");
        seen[p.part] = true;
      }
  }

  /// Prepares fields and hulls once for many worlds of one assembly.
  std::shared_ptr<const PreparedAssembly> prepare(const std::shared_ptr<const Assembly>& assembly, double tolerance,
                                                  const CancelToken& cancel) {
    const std::lock_guard lock(mutex_);
    if (prepared_ != nullptr && assembly_ == assembly && tolerance_ == tolerance) return prepared_;
    RunContext context = make_context(Session::reader(registry_), cancel);
    prepared_ = simulator_->prepare(*assembly, tolerance, context);
    assembly_ = assembly;
    tolerance_ = tolerance;
    return prepared_;
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

void bind_simulator(py::module_& m) {
  py::class_<Capabilities>(m, "Capabilities", "What a simulator can do.")
      .def_readonly("dynamics", &Capabilities::dynamics, "World.step() works.")
      .def_readonly("contacts", &Capabilities::contacts, "World.contacts() works.")
      .def_readonly("distance", &Capabilities::distance, "World.penetration() tells free states from colliding ones.")
      .def_readonly("max_moving", &Capabilities::max_moving, "Largest number of parts that may move simultaneously.");
  py::class_<HeldSimulator, std::shared_ptr<HeldSimulator>>(m, "Simulator", "A simulator plugin.")
      .def(py::init<const std::string&, const py::dict&>(), py::arg("id") = "sdf_penalty",
           py::arg("parameters") = py::dict(),
           "Makes the simulator of that id; parameters that are not given have their defaults, advanced ones are in a "
           "dict 'advanced'.")
      .def_property_readonly("id", &HeldSimulator::id, "Id of the plugin.")
      .def_property_readonly("capabilities", &HeldSimulator::capabilities, "Capabilities.")
      .def("world", &HeldSimulator::world, py::arg("assembly"), py::arg("moving"), py::arg("fixed") = py::none(),
           py::arg("space") = "rigid", py::arg("tolerance") = kDefaultTolerance,
           "Makes a World. moving, fixed: names or numbers of parts; fixed None: all that do not move. space: 'rigid' "
           "or "
           "'translation' (orientation is locked). tolerance: penetration that the verifier lets pass, assembly units, "
           "> 0.")
      .def("worlds", &HeldSimulator::worlds, py::arg("assembly"), py::arg("moving"), py::arg("count"),
           py::arg("fixed") = py::none(), py::arg("space") = "rigid", py::arg("tolerance") = kDefaultTolerance,
           py::arg("threads") = 1,
           "Makes `count` equal worlds that are stepped together on `threads` threads: Worlds.");
}

}  // namespace dismantle::python
