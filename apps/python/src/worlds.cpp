#include "worlds.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bindings.h"
#include "world.h"

namespace dismantle::python {

HeldWorlds::HeldWorlds(Make make, std::size_t count, unsigned threads)
    : make_(std::move(make)), worlds_(count), executor_(threads) {
  parallel_for(
      count, &executor_,
      [&](std::size_t n) {
        worlds_[n].world = make_();
        worlds_[n].state = worlds_[n].world->initial_state();
      },
      [] { return false; });
  bodies_ = first().scene().moving.size();
}

std::vector<std::size_t> HeldWorlds::all() const {
  std::vector<std::size_t> numbers(worlds_.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

template <class Work>
void HeldWorlds::for_each(const std::vector<std::size_t>& which, Work work) {
  py::gil_scoped_release release;
  const std::lock_guard lock(mutex_);
  parallel_for(
      which.size(), &executor_, [&](std::size_t k) { work(worlds_[which[k]], which[k]); }, [] { return false; });
}

std::vector<StepReport> HeldWorlds::step(const Array& wrenches, double duration, bool in_body_frame) {
  const auto extent = [&](py::ssize_t axis) { return static_cast<std::size_t>(wrenches.shape(axis)); };
  const bool flat = bodies_ == 1 && wrenches.ndim() == 2 && extent(0) == size() && extent(1) == 6;
  const bool deep = wrenches.ndim() == 3 && extent(0) == size() && extent(1) == bodies_ && extent(2) == 6;
  if (!flat && !deep)
    throw py::value_error(fmt::format("wrenches: expected an array of shape ({}, {}6)", size(),
                                      bodies_ == 1 ? "" : fmt::format("{}, ", bodies_)));
  if (!(duration > 0) || !std::isfinite(duration))
    throw py::value_error("duration: expected a finite number > 0, seconds");
  const double* const rows = wrenches.data();
  if (!std::all_of(rows, rows + wrenches.size(), [](double x) { return std::isfinite(x); }))
    throw py::value_error("wrenches: a number is not finite");
  std::vector<StepReport> reports(size());
  for_each(all(), [&](One& one, std::size_t n) {
    Action action;
    action.in_body_frame = in_body_frame;
    for (std::size_t i = 0; i < bodies_; ++i) {
      const double* row = rows + 6 * (n * bodies_ + i);
      action.wrenches.push_back({{row[0], row[1], row[2]}, {row[3], row[4], row[5]}});
    }
    reports[n] = one.world->advance(one.state, action, duration, nullptr);
  });
  return reports;
}

void HeldWorlds::reset(const py::object& which) {
  std::vector<std::size_t> numbers = all();
  if (!which.is_none()) {
    numbers = py::cast<std::vector<std::size_t>>(which);
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    if (!numbers.empty() && numbers.back() >= size())
      throw py::index_error(fmt::format("no world {}: there are {}", numbers.back(), size()));
  }
  for_each(numbers, [&](One& one, std::size_t) {
    one.world = make_();
    one.state = one.world->initial_state();
  });
}

void HeldWorlds::set_state(std::size_t world, const Array& rows) {
  if (world >= size()) throw py::index_error(fmt::format("no world {}: there are {}", world, size()));
  const State state = state_of(rows, bodies_);
  for_each({world}, [&](One& one, std::size_t) {
    one.world = make_();
    one.state = state;
  });
}

Array HeldWorlds::states() {
  Array out({size(), bodies_, kStateColumns});
  double* to = out.mutable_data();
  const std::lock_guard lock(mutex_);  // the holder of the mutex never waits for the interpreter's lock
  for (const One& one : worlds_)
    for (const BodyState& body : one.state.bodies) to = write_state(body, to);
  return out;
}

Array HeldWorlds::displacements() {
  Array out({size(), bodies_, std::size_t{3}});
  double* to = out.mutable_data();
  const std::lock_guard lock(mutex_);
  for (One& one : worlds_)
    for (std::size_t i = 0; i < bodies_; ++i) {
      const Eigen::Vector3d center = one.world->center(i);
      const Eigen::Vector3d displacement = one.state.bodies[i].pose * center - center;
      to = std::copy_n(displacement.data(), 3, to);
    }
  return out;
}

Array HeldWorlds::mean_normals() {
  Array out({size(), bodies_, std::size_t{3}});
  double* const rows = out.mutable_data();
  for_each(all(), [&](One& one, std::size_t n) {
    one.world->contacts(one.state, one.contacts);
    const std::vector<PlacedPart>& moving = one.world->scene().moving;
    for (std::size_t i = 0; i < bodies_; ++i) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double count = 0;
      for (const Contact& c : one.contacts)
        if (c.moving == moving[i].part) sum += c.normal, ++count;
      if (count > 0) sum /= count;
      std::copy_n(sum.data(), 3, rows + 3 * (n * bodies_ + i));
    }
  });
  return out;
}

Array HeldWorlds::penetrations() {
  Array out(static_cast<py::ssize_t>(size()));
  double* const to = out.mutable_data();
  for_each(all(), [&](One& one, std::size_t n) { to[n] = one.world->penetration(one.state); });
  return out;
}

py::array_t<bool> HeldWorlds::separated() {
  py::array_t<bool> out(static_cast<py::ssize_t>(size()));
  bool* const to = out.mutable_data();
  for_each(all(), [&](One& one, std::size_t n) { to[n] = one.world->separated(one.state); });
  return out;
}

namespace {

template <class T, class Get>
py::array_t<T> column(const std::vector<StepReport>& reports, Get get) {
  py::array_t<T> out(static_cast<py::ssize_t>(reports.size()));
  std::transform(reports.begin(), reports.end(), out.mutable_data(), get);
  return out;
}

World& world_with_body(World& world, std::size_t body) {
  const std::size_t bodies = world.scene().moving.size();
  if (body >= bodies) throw py::index_error(fmt::format("no moving part {}: there are {}", body, bodies));
  return world;
}

}  // namespace

void bind_worlds(py::module_& m) {
  py::class_<HeldWorlds, std::shared_ptr<HeldWorlds>>(
      m, "Worlds",
      "N equal scenes of a simulator with a state each, stepped together: Simulator.worlds(). Frames as in World. What "
      "a world does depends neither on the others nor on the number of threads. After reset(), and after a state was "
      "set, the same calls give the same results to the last bit.")
      .def("__len__", &HeldWorlds::size)
      .def(
          "step",
          [](HeldWorlds& w, const Array& wrenches, double duration, bool in_body_frame) {
            const std::vector<StepReport> reports = w.step(wrenches, duration, in_body_frame);
            py::dict out;
            out["steps"] = column<std::int64_t>(reports, [](const StepReport& r) { return r.steps; });
            out["travel"] = column<double>(reports, [](const StepReport& r) { return r.travel; });
            out["stalled"] = column<bool>(reports, [](const StepReport& r) { return r.stalled; });
            out["finite"] = column<bool>(reports, [](const StepReport& r) { return r.finite; });
            return out;
          },
          py::arg("wrenches"), py::arg("duration") = 0.1, py::arg("in_body_frame") = false,
          "As World.step() in each world. wrenches: (N, 6), or (N, M, 6) for M moving parts. Returns a dict of arrays "
          "(N,): steps, travel, stalled, finite.")
      .def("reset", &HeldWorlds::reset, py::arg("which") = py::none(),
           "Puts the moving parts back to where they began, at rest. which: numbers of worlds; None: all.")
      .def("set_state", &HeldWorlds::set_state, py::arg("world"), py::arg("state"),
           "Sets the state (M, 13) of one world.")
      .def_property_readonly("states", &HeldWorlds::states,
                             "(N, M, 13): pose (7), velocity of the centre (3), angular velocity (3).")
      .def_property_readonly("displacements", &HeldWorlds::displacements,
                             "(N, M, 3): ways of the centres from where they are assembled.")
      .def_property_readonly("mean_normals", &HeldWorlds::mean_normals,
                             "(N, M, 3): mean of the normals of the contacts of each moving part; 0 without contact.")
      .def_property_readonly("penetrations", &HeldWorlds::penetrations, "(N,): as World.penetration().")
      .def_property_readonly("separated", &HeldWorlds::separated, "(N,) bool: as World.separated().")
      .def(
          "radius", [](HeldWorlds& w, std::size_t body) { return world_with_body(w.first(), body).radius(body); },
          py::arg("body") = 0, "As World.radius().")
      .def(
          "torque_arm",
          [](HeldWorlds& w, std::size_t body) { return world_with_body(w.first(), body).torque_arm(body); },
          py::arg("body") = 0, "As World.torque_arm().");
}

}  // namespace dismantle::python
