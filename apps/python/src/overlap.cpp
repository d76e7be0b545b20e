#include "overlap.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <vector>

#include "arrays.h"

namespace dismantle::python {
namespace {

OverlapPlace in_input_units(OverlapPlace place, const Normalization& frame) {
  place.at = frame.to_input(place.at);
  place.region = {frame.to_input(place.region.lo), frame.to_input(place.region.hi)};
  place.axis_point = frame.to_input(place.axis_point);
  return place;
}

/// Property `get` of the place; None if there is no place.
template <class Get>
auto of_place(Get get) {
  return [get](const HeldOverlap& o) -> py::object { return o.place ? py::object(get(*o.place)) : py::none(); };
}

}  // namespace

HeldOverlap overlap_of(const Assembly& assembly, const InitialOverlap& overlap) {
  const Normalization& frame = assembly.normalization;
  HeldOverlap out{assembly.parts[overlap.a].name, assembly.parts[overlap.b].name, overlap.depth / frame.scale, {}, {}};
  if (overlap.declared) out.declared = *overlap.declared / frame.scale;
  if (overlap.place) out.place = in_input_units(*overlap.place, frame);
  return out;
}

HeldOverlap overlap_of(const PlanAssembly& assembly, const PlanOverlap& overlap) {
  HeldOverlap out{overlap.a, overlap.b, overlap.depth / assembly.scale, {}, overlap.place, overlap.flexible};
  if (overlap.declared) out.declared = *overlap.declared / assembly.scale;
  return out;
}

void bind_overlap(py::module_& m) {
  py::class_<HeldOverlap>(m, "Overlap",
                          "Two parts that are in each other when assembled. Input units and coordinates; what is not "
                          "known of a plan from an older file is None.")
      .def_readonly("a", &HeldOverlap::a, "Name of one part.")
      .def_readonly("b", &HeldOverlap::b, "Name of the other part.")
      .def_readonly("depth", &HeldOverlap::depth, "How deep, >= 0; input units.")
      .def_readonly("declared", &HeldOverlap::declared,
                    "Depth that is allowed this pair, whatever it overlaps; input units. None: nothing is said.")
      .def_readonly(
          "flexible", &HeldOverlap::flexible,
          "Of a plan: `declared` is no word of the user, but one of the two is recognised as a spring, an O-ring or "
          "a round belt.")
      .def_property_readonly(
          "contact", of_place([](const OverlapPlace& p) { return py::str(std::string(to_string(p.contact))); }),
          "Class of the contact: 'uniform_interference' (a press fit), 'local_interference' (a clip, a detent), "
          "'duplicate', 'inside', 'kissing' or 'clearance' (docs/concepts.md).")
      .def_property_readonly("at", of_place([](const OverlapPlace& p) { return array_of(p.at); }),
                             "(3,): the deepest point.")
      .def_property_readonly("region", of_place([](const OverlapPlace& p) {
                               return array_of(std::vector{p.region.lo, p.region.hi});
                             }),
                             "(2, 3): lowest and highest corner around all surface of one in the other.")
      .def_property_readonly("share", of_place([](const OverlapPlace& p) { return py::float_(p.share); }),
                             "Share of the surfaces facing each other nearby that overlaps, by area, [0, 1].")
      .def_property_readonly("axis", of_place([](const OverlapPlace& p) -> py::object {
                               if (!p.axis) return py::none();
                               return py::make_tuple(array_of(p.axis_point), array_of(*p.axis));
                             }),
                             "(point (3,), direction (3,)) of a uniform overlap all around an axis; else None.")
      .def("__repr__", [](const HeldOverlap& o) {
        return fmt::format("<Overlap '{}', '{}': {:.4g}{}>", o.a, o.b, o.depth,
                           o.place ? ", " + std::string(to_string(o.place->contact)) : "");
      });
}

}  // namespace dismantle::python
