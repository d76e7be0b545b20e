// step_reader FILE LINEAR LINEAR_OF_ASSEMBLY ANGULAR MAX_TRIANGLES: reads a STEP file and writes its bodies to standard
// output in the format of stream_format.h. The plugin starts it as a separate process because Open CASCADE may
// crash or hang.
#include <sys/resource.h>
#include <unistd.h>

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <Standard_Version.hxx>
#include <TDocStd_Document.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "compressed.h"
#include "dismantle/geometry/length_unit.h"
#include "lost_products.h"
#include "mapped_items.h"
#include "product_tree.h"
#include "stream_writer.h"
#include "structure.h"
#include "tessellate.h"
#include "units.h"

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

/// Has this process come near its limit of address space? Open CASCADE gives up a face whose triangles find no memory,
/// as it does with a damaged one, and says nothing.
bool memory_is_short() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmPeak:", 0) == 0) return 2 * 1024 * std::stoull(line.substr(7)) > limit.rlim_cur;
  return false;
}

class Converter {
 public:
  Converter(const Arguments& arguments, StreamWriter& out) : arguments_(arguments), out_(out) {}

  /// Returns the exit status.
  int run() {
    const Handle(TDocStd_Document) document = read();
    if (document.IsNull()) return 1;
    ProductTree tree = walk_products(XCAFDoc_DocumentTool::ShapeTool(document->Main()), encoding_);
    for (const auto& warning : tree.warnings) out_.warning(warning);
    for (const auto& note : tree.notes) out_.note(note);
    add_lost(tree);
    const double assembly = measure(tree);
    for (std::size_t i = 0; i < tree.bodies.size(); ++i) {
      out_.phase("tessellating", i, tree.bodies.size());
      if (!convert(tree.bodies[i], assembly)) return 1;
    }
    for (const AbsentBody& absent : tree.absent) {
      Body body;
      body.name = absent.name;
      body.parents = absent.parents;
      body.problem = absent.problem;
      body.by_meaning = absent.by_meaning;
      out_.body(body);
    }
    out_.end();
    return 0;
  }

 private:
  /// Products that are in the file and not in the tree; those that are there without a body get their reason.
  void add_lost(ProductTree& tree) {
    std::set<const AbsentBody*> hidden;
    std::vector<AbsentBody> more;
    for (const AbsentBody& absent : tree.absent)
      if (absent.by_meaning) hidden.insert(&absent);
    for (const LostProduct& lost : lost_products(reader_, unread_, encoding_)) {
      bool known = false;
      for (AbsentBody& absent : tree.absent) {
        if (absent.name != lost.name || hidden.contains(&absent)) continue;
        absent.problem = lost.problem;
        absent.by_meaning = lost.by_meaning;
        known = true;
      }
      if (!known) more.push_back({lost.name, {}, lost.problem, lost.by_meaning});
    }
    std::ranges::move(more, std::back_inserter(tree.absent));
  }

  Handle(TDocStd_Document) read() {
    out_.phase("reading STEP", 0, 0);
    const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
    Handle(TDocStd_Document) document;
    application->NewDocument("MDTV-XCAF", document);
    STEPCAFControl_Reader& reader = reader_;
    reader.SetColorMode(Standard_True);
    reader.SetNameMode(Standard_True);
    reader.SetLayerMode(Standard_False);
    reader.SetPropsMode(Standard_False);
    reader.SetGDTMode(Standard_False);
    reader.SetMatMode(Standard_False);
    reader.SetViewMode(Standard_False);
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
    // Each byte becomes one character, and none is lost: see recoded().
    Interface_Static::SetCVal("read.step.codepage", "iso8859-1");
    const std::unique_ptr<std::istream> text = text_of_file();
    encoding_ = encoding_of(*text);
    if (encoding_ != TextEncoding::utf8)
      out_.warning(std::string("names are not in UTF-8, as the standard has it: read as ") +
                   (encoding_ == TextEncoding::gb18030 ? "GB18030" : "Latin-1 (Windows-1252)"));
    text->clear();
    text->seekg(begin_of(*text));
    if (reader.ChangeReader().ReadStream(arguments_.file.c_str(), *text) != IFSelect_RetDone) {
      out_.failure(Failure::unreadable, "Open CASCADE cannot read it: the file is damaged or is no STEP file");
      return {};
    }
    find_unit(reader.ChangeReader().Model());
    if (const std::string endless = endless_structure(reader.ChangeReader(), encoding_); !endless.empty()) {
      out_.failure(Failure::unreadable, endless);
      return {};
    }
    unread_ = replace_unread_items(reader.ChangeReader(), *text);
    print_first_error(*reader.ChangeReader().Model());
    for (const std::string& refused : place_mapped_items(reader.ChangeReader())) {
      out_.failure(Failure::unreadable, refused);
      return {};
    }
    const int roots = reader.ChangeReader().NbRootsForTransfer();
    out_.phase("building shapes", 0, static_cast<std::size_t>(std::max(roots, 0)));
    if (roots == 0 || !reader.Transfer(document)) {
      out_.failure(Failure::unreadable, "no shape in it could be built");
      return {};
    }
    return document;
  }

  /// Where the text begins: behind a byte order mark, which Open CASCADE takes for an error.
  static std::streamoff begin_of(std::istream& text) {
    text.seekg(0);
    char mark[3] = {};
    text.read(mark, 3);
    const bool marked = text.gcount() == 3 && std::string(mark, 3) == "\xEF\xBB\xBF";
    text.clear();
    return marked ? 3 : 0;
  }

  /// For the message of a crash.
  static void print_first_error(const Interface_InterfaceModel& model) {
    for (int i = 1; i <= model.NbEntities(); ++i)
      if (const Handle(Interface_Check) check = model.Check(i, Standard_True); check->HasFailed()) {
        std::fprintf(stderr, "first error in the file: %s %s: %s\n", model.StringLabel(model.Value(i))->ToCString(),
                     type_of(model.Value(i)).c_str(), check->CFail(1));
        return;
      }
  }

  std::unique_ptr<std::istream> text_of_file() const {
    if (is_compressed(arguments_.file)) return std::make_unique<std::istringstream>(unpacked(arguments_.file));
    return std::make_unique<std::ifstream>(arguments_.file, std::ios::binary);
  }

  /// Shapes are read in millimetres and written in the file's own unit, if it has one.
  void find_unit(const Handle(Interface_InterfaceModel) & model) {
    const std::vector<double> units = length_units(model);
    std::string name = "mm";
    if (units.size() == 1) {
      name = unit_of_length(units[0] / 1000);
      if (name.empty()) {
        out_.warning("its length unit of " + std::to_string(units[0]) +
                     " mm is not known: coordinates are in millimetres");
        name = "mm";
      }
    } else if (units.size() > 1) {
      out_.warning("the file has several length units: coordinates are in millimetres");
    }
    millimetres_ = 1000 * metres_in(name);
    out_.unit(name);
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
    body.instances = placed.instances;
    body.product = placed.product;
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
    if (surface.triangles.empty() && memory_is_short()) {
      out_.failure(Failure::out_of_memory, "");
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
  STEPCAFControl_Reader reader_;
  UnreadItems unread_;
  TextEncoding encoding_ = TextEncoding::utf8;
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
