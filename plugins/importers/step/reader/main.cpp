// step_reader FILE LINEAR LINEAR_OF_ASSEMBLY ANGULAR MAX_TRIANGLES: reads a STEP file and writes its bodies to standard
// output in the format of stream_format.h. The plugin starts it as a separate process because Open CASCADE may
// crash or hang.
#include <unistd.h>

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <Standard_Version.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "product_tree.h"
#include "stream_writer.h"
#include "tessellate.h"

namespace dismantle::step_import {
namespace {

using reader_process::Body;
using reader_process::Failure;
using reader_process::StreamWriter;

struct Arguments {
  std::string file;
  double linear = 0, linear_of_assembly = 0, angular = 0;
  std::uint64_t max_triangles = 0;
};

struct Unit {
  const char* in_file;  ///< prefix of the name in Open CASCADE
  const char* name;
  double millimetres;
};
constexpr Unit kUnits[] = {{"millimet", "mm", 1},     {"centimet", "cm", 10},  {"decimet", "dm", 100},
                           {"micromet", "um", 0.001}, {"kilomet", "km", 1e6},  {"met", "m", 1000},
                           {"inch", "inch", 25.4},    {"foot", "foot", 304.8}, {"feet", "foot", 304.8},
                           {"mile", "mile", 1609344}, {"mil", "mil", 0.0254}};

class Converter {
 public:
  Converter(const Arguments& arguments, StreamWriter& out) : arguments_(arguments), out_(out) {}

  /// Returns the exit status.
  int run() {
    const Handle(TDocStd_Document) document = read();
    if (document.IsNull()) return 1;
    const ProductTree tree = walk_products(XCAFDoc_DocumentTool::ShapeTool(document->Main()));
    for (const auto& warning : tree.warnings) out_.warning(warning);
    const double assembly = measure(tree);
    for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
      out_.phase("tessellating", i, tree.bodies.size());
      if (!convert(tree.bodies[i], assembly)) return 1;
    }
    out_.end();
    return 0;
  }

 private:
  Handle(TDocStd_Document) read() {
    out_.phase("reading STEP", 0, 0);
    const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
    Handle(TDocStd_Document) document;
    application->NewDocument("MDTV-XCAF", document);
    STEPCAFControl_Reader reader;
    reader.SetColorMode(Standard_True);
    reader.SetNameMode(Standard_True);
    reader.SetLayerMode(Standard_False);
    reader.SetPropsMode(Standard_False);
    reader.SetGDTMode(Standard_False);
    reader.SetMatMode(Standard_False);
    reader.SetViewMode(Standard_False);
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
    if (reader.ReadFile(arguments_.file.c_str()) != IFSelect_RetDone) {
      out_.failure(Failure::unreadable, "Open CASCADE cannot read it: the file is damaged or is no STEP file");
      return {};
    }
    find_unit(reader.ChangeReader());
    const int roots = reader.ChangeReader().NbRootsForTransfer();
    out_.phase("building shapes", 0, static_cast<std::size_t>(std::max(roots, 0)));
    if (roots == 0 || !reader.Transfer(document)) {
      out_.failure(Failure::unreadable, "no shape in it could be built");
      return {};
    }
    return document;
  }

  /// Shapes are read in millimetres and written in the file's own unit, if it has one.
  void find_unit(STEPControl_Reader& reader) {
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader.FileUnits(lengths, angles, solid_angles);
    std::vector<const Unit*> found;
    for (const TCollection_AsciiString& text : lengths) {
      std::string name = text.ToCString();
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      const Unit* unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                      [&](const Unit& u) { return name.rfind(u.in_file, 0) == 0; });
      if (unit == std::end(kUnits)) {
        out_.warning("length unit '" + name + "' is not known: coordinates are in millimetres");
        found.clear();
        break;
      }
      if (std::find(found.begin(), found.end(), unit) == found.end()) found.push_back(unit);
    }
    if (found.size() > 1) out_.warning("the file has several length units: coordinates are in millimetres");
    const Unit& unit = found.size() == 1 ? *found[0] : kUnits[0];
    millimetres_ = unit.millimetres;
    out_.unit(unit.name);
  }

  /// Measures the diagonal of the box around all bodies (returned) and of each body without its location. Millimetres.
  double measure(const ProductTree& tree) {
    Bnd_Box all;
    for (const PlacedBody& body : tree.bodies) {
      const TopoDS_Shape local = body.shape.Located(TopLoc_Location());
      int known = 0;
      if (!index_.Find(local, known)) {
        known = static_cast<int>(boxes_.size());
        index_.Bind(local, known);
        Bnd_Box box;
        BRepBndLib::Add(local, box, Standard_False);
        boxes_.push_back(box);
      }
      const Bnd_Box& box = boxes_[static_cast<std::size_t>(known)];
      if (!box.IsVoid()) all.Add(box.Transformed((body.instance * body.shape.Location()).Transformation()));
    }
    surfaces_.resize(boxes_.size());
    return diagonal(all);
  }

  static double diagonal(const Bnd_Box& box) {
    return box.IsVoid() || box.IsOpen() ? 0 : std::sqrt(box.SquareExtent());
  }

  /// Returns false when the triangle limit is exceeded.
  bool convert(const PlacedBody& placed, double assembly) {
    Body body;
    body.name = placed.name;
    body.parents = placed.parents;
    if (placed.kind == BodyKind::open_shell) {
      body.problem = "it is a surface and no solid (an open shell of " + std::to_string(placed.faces) +
                     (placed.faces == 1 ? " face" : " faces") + "): close or thicken it in the CAD program";
      out_.body(body);
      return true;
    }
    int index = 0;
    index_.Find(placed.shape.Located(TopLoc_Location()), index);
    const Surface& surface = surface_of(static_cast<std::size_t>(index), placed, assembly);
    body.colour = placed.instance_colour ? placed.instance_colour : placed.colours->of(placed.shape, surface);
    total_ += surface.triangles.size();
    if (total_ > arguments_.max_triangles) {
      out_.failure(Failure::too_many_triangles,
                   "more than " + std::to_string(arguments_.max_triangles) + " triangles up to '" + placed.name + "'");
      return false;
    }
    if (surface.triangles.empty()) body.problem = "none of its faces could be tessellated: its geometry is damaged";
    place(surface, (placed.instance * placed.shape.Location()).Transformation(), body);
    out_.body(body);
    return true;
  }

  const Surface& surface_of(std::size_t index, const PlacedBody& placed, double assembly) {
    auto& surface = surfaces_[index];
    if (surface) return *surface;
    const double own = diagonal(boxes_[index]);
    double linear = arguments_.linear * own;
    if (arguments_.linear_of_assembly > 0) linear = std::min(linear, arguments_.linear_of_assembly * assembly);
    surface = tessellate(placed.shape, linear > 0 ? linear : 1e-3, arguments_.angular);
    if (surface->missing_faces > 0 && !surface->triangles.empty())
      out_.warning("'" + placed.name + "': " + std::to_string(surface->missing_faces) + " of " +
                   std::to_string(placed.faces) + " faces could not be tessellated");
    if (placed.kind == BodyKind::closed_shell)
      out_.warning("'" + placed.name + "' is a closed surface and no solid: read as a solid");
    return *surface;
  }

  void place(const Surface& surface, const gp_Trsf& place, Body& body) const {
    body.vertices.reserve(surface.vertices.size());
    for (const auto& v : surface.vertices) {
      gp_XYZ p(v[0], v[1], v[2]);
      place.Transforms(p);
      if (millimetres_ != 1) p /= millimetres_;
      body.vertices.push_back({p.X(), p.Y(), p.Z()});
    }
    body.triangles = surface.triangles;
    if (place.IsNegative())
      for (auto& t : body.triangles) std::swap(t[1], t[2]);
  }

  const Arguments& arguments_;
  StreamWriter& out_;
  double millimetres_ = 1;
  TopTools_DataMapOfShapeInteger index_;  // of distinct bodies, without location
  std::vector<Bnd_Box> boxes_;
  std::vector<std::optional<Surface>> surfaces_;
  std::uint64_t total_ = 0;
};

std::string text_of(const Standard_Failure& failure) {
  const char* message = failure.GetMessageString();
  return std::string(failure.DynamicType()->Name()) + (message && *message ? std::string(": ") + message : "");
}

int convert(const Arguments& arguments, StreamWriter& out) {
  try {
    return Converter(arguments, out).run();
  } catch (const Standard_OutOfMemory&) {
    out.failure(Failure::out_of_memory, "");
  } catch (const Standard_Failure& failure) {
    out.failure(Failure::unreadable, "Open CASCADE gave up on it (" + text_of(failure) + ")");
  } catch (const std::bad_alloc&) {
    out.failure(Failure::out_of_memory, "");
  } catch (const std::exception& failure) {
    out.failure(Failure::unreadable, failure.what());
  }
  return 1;
}

}  // namespace
}  // namespace dismantle::step_import

int main(int argc, char** argv) {
  using namespace dismantle::step_import;
  if (argc != 6) {
    std::fprintf(stderr, "step_reader (Open CASCADE %s) is started by the importer of STEP files\n",
                 OCC_VERSION_COMPLETE);
    return 2;
  }
  const Arguments arguments{argv[1], std::strtod(argv[2], nullptr), std::strtod(argv[3], nullptr),
                            std::strtod(argv[4], nullptr), std::strtoull(argv[5], nullptr, 10)};
  // Open CASCADE prints to standard output.
  const int stream = ::dup(STDOUT_FILENO);
  if (stream < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 2;
  dismantle::reader_process::StreamWriter out(stream);
  const int status = convert(arguments, out);
  // Destroying the document takes time and can crash; the process ends anyway.
  std::_Exit(status);
}
