// Assembly, Part: from files, from arrays, from samples.
#include "dismantle/assembly.h"

#include <fmt/format.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "arrays.h"
#include "bindings.h"
#include "dismantle/errors.h"
#include "dismantle/host/suggest.h"
#include "dismantle/samples/samples.h"
#include "interruptible.h"
#include "overlap.h"

namespace dismantle::python {
namespace {

/// A part with the assembly that it belongs to.
struct PartOf {
  std::shared_ptr<const Assembly> assembly;
  PartId id = 0;
  const Part& part() const { return assembly->parts[id]; }
  const Normalization& frame() const { return assembly->normalization; }
};

Array in_input_units(const Mesh& mesh, const Normalization& frame) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(mesh.vertices.size());
  for (const auto& v : mesh.vertices) points.push_back(frame.to_input(v));
  return array_of(points);
}

HeldAssembly load(const std::string& path, const std::string& file, const std::vector<std::string>& overrides) {
  const CancelToken cancel;
  return run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
    const Session session = make_session(file, overrides);
    return HeldAssembly{session.load(path, make_context(session, cancel))};
  });
}

/// Hash of names and coordinates, for parts that are not read from files.
std::string hash_of(const std::vector<RawPart>& parts) {
  py::object hash = py::module_::import("hashlib").attr("sha256")();
  const auto add = [&](const void* data, std::size_t size) {
    hash.attr("update")(py::bytes(static_cast<const char*>(data), size));
  };
  for (const auto& part : parts) {
    add(part.name.c_str(), part.name.size() + 1);
    for (const auto& v : part.mesh.vertices) add(v.data(), 3 * sizeof(double));
    for (const auto& t : part.mesh.triangles) add(t.data(), sizeof(t));
  }
  return py::cast<std::string>(hash.attr("hexdigest")());
}

HeldAssembly from_parts(std::vector<RawPart> raw, const std::string& source, const std::string& file,
                        const std::vector<std::string>& overrides) {
  std::vector<std::string> changed;
  make_names_unique(raw, changed);
  const std::string hash = hash_of(raw);
  const CancelToken cancel;
  HeldAssembly loaded = run_interruptible(cancel, py::none(), OnInterrupt::raise, [&] {
    const Session session = make_session(file, overrides);
    return HeldAssembly{session.load(InputParts{raw, hash, {}, {}}, source, make_context(session, cancel))};
  });
  loaded.raw = std::make_shared<const std::vector<RawPart>>(std::move(raw));
  return loaded;
}

HeldAssembly from_meshes(const py::dict& meshes, const std::string& unit, const std::string& file,
                         const std::vector<std::string>& overrides) {
  std::vector<RawPart> raw;
  for (const auto& [key, value] : meshes) {
    RawPart& part = raw.emplace_back();
    part.name = py::cast<std::string>(key);
    const py::sequence pair = py::cast<py::sequence>(value);
    if (py::len(pair) != 2)
      throw py::value_error(part.name + ": expected a pair of vertices (N, 3) and triangles (F, 3)");
    part.mesh = mesh_of(py::cast<Array>(pair[0]), py::cast<Indices>(pair[1]), part.name);
    part.unit = unit;
  }
  return from_parts(std::move(raw), "<python>", file, overrides);
}

HeldAssembly from_sample(const std::string& name, const py::dict& values, const std::string& file,
                         const std::vector<std::string>& overrides) {
  const samples::Sample* sample = samples::find(name);
  if (sample == nullptr) {
    std::vector<std::string> known;
    for (const auto& s : samples::list()) known.push_back(s.name);
    const auto near = nearest(name, known);
    throw py::value_error(fmt::format("unknown sample '{}'{}", name, near ? "; did you mean '" + *near + "'?" : ""));
  }
  ParamSet params;
  for (const auto& [key, value] : values) {
    const std::string word = py::cast<std::string>(key);
    const auto spec =
        std::find_if(sample->params.begin(), sample->params.end(), [&](const auto& s) { return s.name == word; });
    if (spec == sample->params.end())
      throw py::value_error(fmt::format("sample '{}' has no parameter '{}'", name, word));
    params[word] = param_value(*spec, value);
  }
  return from_parts(samples::make(name, params), "<sample " + name + ">", file, overrides);
}

void write_parts(const HeldAssembly& self, const std::filesystem::path& folder) {
  std::vector<RawPart> parts;
  for (const Part& part : self.assembly->parts) {
    RawPart& raw = parts.emplace_back();
    raw.name = part.name;
    raw.mesh.triangles = part.mesh->triangles;
    for (const auto& v : part.mesh->vertices) raw.mesh.vertices.push_back(self.assembly->normalization.to_input(v));
  }
  samples::write(self.raw != nullptr ? *self.raw : parts, folder);
}

PartOf part_of(const HeldAssembly& self, const py::object& key) {
  const auto ids = part_ids(*self.assembly, key);
  if (ids.size() != 1) throw py::value_error("expected the name or the number of one part");
  return {self.assembly, ids.front()};
}

void bind_part(py::module_& m) {
  py::class_<PartOf>(m, "Part", "One rigid part of an assembly. Immutable.")
      .def_property_readonly(
          "id", [](const PartOf& p) { return p.id; }, "Number of the part: its place in Assembly.parts.")
      .def_property_readonly(
          "name", [](const PartOf& p) { return p.part().name; }, "Name, unique in the assembly.")
      .def_property_readonly(
          "file", [](const PartOf& p) { return p.part().file; }, "Name of the file that it came from.")
      .def_property_readonly(
          "vertices", [](const PartOf& p) { return in_input_units(*p.part().mesh, p.frame()); },
          "(N, 3) float64: vertices of the repaired surface, assembled; input units.")
      .def_property_readonly(
          "internal_vertices", [](const PartOf& p) { return array_of(p.part().mesh->vertices); },
          "(N, 3) float64: the same vertices in assembly units, in the frame of simulators and planners.")
      .def_property_readonly(
          "triangles", [](const PartOf& p) { return array_of(p.part().mesh->triangles); },
          "(F, 3) int64: indices of vertices, counter-clockwise seen from outside.")
      .def_property_readonly(
          "surface",
          [](const PartOf& p) {
            return py::make_tuple(array_of(p.part().surface->vertices), array_of(p.part().surface->triangles));
          },
          "The surface with no edge longer than `assembly.subdivide`, from which simulators take their "
          "contact points: (vertices (N, 3) in assembly units, triangles (F, 3)).")
      .def_property_readonly(
          "volume",
          [](const PartOf& p) {
            const double s = p.frame().scale;
            return p.part().volume / (s * s * s);
          },
          "Volume, input units cubed; > 0.")
      .def_property_readonly(
          "colour",
          [](const PartOf& p) -> py::object {
            const auto& c = p.part().colour;
            return c ? py::object(py::make_tuple(c->r, c->g, c->b, c->a)) : py::none();
          },
          "(r, g, b, a) of its file, 0 to 255, sRGB; None when the file gives none.")
      .def_property_readonly(
          "parents", [](const PartOf& p) { return p.part().parents; },
          "Names of the assemblies of its file that it is in, outermost first.")
      .def("__repr__", [](const PartOf& p) {
        return fmt::format("<Part {} '{}', {} triangles>", p.id, p.part().name, p.part().mesh->triangles.size());
      });
}

}  // namespace

std::vector<PartId> part_ids(const Assembly& assembly, const py::handle& parts) {
  if (py::isinstance<py::str>(parts)) {
    const std::string name = py::cast<std::string>(parts);
    std::vector<std::string> known;
    for (const Part& part : assembly.parts) {
      if (part.name == name) return {part.id};
      known.push_back(part.name);
    }
    const auto near = nearest(name, known);
    throw py::key_error(fmt::format("no part '{}'{}", name, near ? "; did you mean '" + *near + "'?" : ""));
  }
  if (PyIndex_Check(parts.ptr()) != 0) {
    const auto number = py::cast<std::int64_t>(py::reinterpret_steal<py::object>(PyNumber_Index(parts.ptr())));
    if (number < 0 || static_cast<std::size_t>(number) >= assembly.parts.size())
      throw py::index_error(fmt::format("no part {}: there are {}, counted from 0", number, assembly.parts.size()));
    return {static_cast<PartId>(number)};
  }
  if (py::isinstance<PartOf>(parts)) return {py::cast<PartOf>(parts).id};
  std::vector<PartId> ids;
  for (const py::handle item : py::cast<py::iterable>(parts)) {
    const auto one = part_ids(assembly, item);
    ids.insert(ids.end(), one.begin(), one.end());
  }
  return ids;
}

void bind_assembly(py::module_& m) {
  bind_part(m);
  py::class_<HeldAssembly>(
      m, "Assembly",
      "Parts in assembled position. Immutable.\n\nTwo frames: `input` coordinates and units are those of the files; "
      "assembly units are what simulators and planners use: internal = scale * (input - center), the largest edge of "
      "the "
      "bounding box being 10 (unless `assembly.size` says otherwise). Plans are in input units.")
      .def_static("_load", &load)
      .def_static("_from_meshes", &from_meshes)
      .def_static("_from_sample", &from_sample)
      .def("write", &write_parts, py::arg("folder"),
           "Writes each part as FOLDER/NAME.obj, input units, for the command line and other programs.")
      .def_property_readonly(
          "parts",
          [](const HeldAssembly& self) {
            std::vector<PartOf> parts;
            for (const Part& part : self.assembly->parts) parts.push_back({self.assembly, part.id});
            return parts;
          },
          "List of Part, by number.")
      .def_property_readonly(
          "names",
          [](const HeldAssembly& self) {
            std::vector<std::string> names;
            for (const Part& part : self.assembly->parts) names.push_back(part.name);
            return names;
          },
          "Names of the parts, by number.")
      .def("__len__", [](const HeldAssembly& self) { return self.assembly->parts.size(); })
      .def("__getitem__", &part_of, py::arg("part"), "The part of that name or number.")
      .def_property_readonly(
          "excluded",
          [](const HeldAssembly& self) {
            std::vector<std::pair<std::string, std::string>> out;
            for (const auto& e : self.assembly->excluded) out.emplace_back(e.name, e.reason);
            return out;
          },
          "Parts of the input that are not in the assembly: list of (name, reason).")
      .def_property_readonly(
          "overlaps",
          [](const HeldAssembly& self) {
            std::vector<HeldOverlap> out;
            for (const auto& o : self.assembly->overlaps) out.push_back(overlap_of(*self.assembly, o));
            return out;
          },
          "List of Overlap: pairs that are in each other when assembled, or that the user declared.")
      .def_property_readonly(
          "scale", [](const HeldAssembly& self) { return self.assembly->normalization.scale; },
          "Assembly units per input unit; > 0.")
      .def_property_readonly(
          "center", [](const HeldAssembly& self) { return array_of(self.assembly->normalization.center); },
          "(3,): origin of the assembly frame, in input coordinates.")
      .def_property_readonly(
          "box",
          [](const HeldAssembly& self) {
            return array_of(std::vector{self.assembly->input_box.lo, self.assembly->input_box.hi});
          },
          "(2, 3): lowest and highest corner of the bounding box, input coordinates.")
      .def_property_readonly(
          "unit", [](const HeldAssembly& self) { return self.assembly->unit; },
          "Input unit ('mm', 'inch', 'm'); empty when the files do not say.")
      .def_property_readonly(
          "source", [](const HeldAssembly& self) { return self.assembly->source; }, "What it was loaded from.")
      .def_property_readonly(
          "sha256", [](const HeldAssembly& self) { return self.assembly->sha256; },
          "SHA-256 of its files, or of its names and arrays.")
      .def(
          "poses_to_input",
          [](const HeldAssembly& self, const Array& poses) {
            std::vector<Pose> out = poses_of(poses, "poses");
            for (Pose& p : out) p = self.assembly->normalization.pose_to_input(p);
            return array_of(out);
          },
          py::arg("poses"), "(N, 7) poses in assembly units to poses that act on input coordinates, (N, 7).")
      .def(
          "poses_to_internal",
          [](const HeldAssembly& self, const Array& poses) {
            std::vector<Pose> out = poses_of(poses, "poses");
            for (Pose& p : out) p = self.assembly->normalization.pose_to_internal(p);
            return array_of(out);
          },
          py::arg("poses"), "(N, 7) poses that act on input coordinates to poses in assembly units, (N, 7).")
      .def("__repr__", [](const HeldAssembly& self) {
        return fmt::format("<Assembly '{}', {} parts>", self.assembly->source, self.assembly->parts.size());
      });
  m.def(
      "samples",
      [] {
        std::vector<std::pair<std::string, std::string>> out;
        for (const auto& sample : samples::list()) out.emplace_back(sample.name, sample.summary);
        return out;
      },
      "The parametric assemblies that Assembly.from_sample() makes: list of (name, summary).");
}

}  // namespace dismantle::python
