/// STEP files with known contents, written by Open CASCADE.
#pragma once

#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <filesystem>
#include <string>

#include "dismantle/rgba.h"

namespace dismantle::step_import::testing {

class StepFile {
 public:
  StepFile();

  /// A product without an instance: a root of the file until an assembly uses it.
  TDF_Label product(const TopoDS_Shape& shape, const std::string& name);
  TDF_Label assembly(const std::string& name);
  /// Returns the instance.
  TDF_Label place(const TDF_Label& assembly, const TDF_Label& what, const gp_Trsf& where, const std::string& name = {});
  void paint(const TDF_Label& label, const Rgba& colour);
  /// Paints a face or solid of a product.
  void paint(const TDF_Label& product, const TopoDS_Shape& part, const Rgba& colour);
  void name(const TDF_Label& product, const TopoDS_Shape& part, const std::string& name);

  /// `unit`: "MM", "INCH", "M". Shapes are in millimetres.
  void write(const std::filesystem::path& file, const char* unit = "MM");

 private:
  Handle(TDocStd_Document) document_;
};

TopoDS_Shape box(double x, double y, double z);
TopoDS_Shape cylinder(double radius, double height);
gp_Trsf moved(double x, double y, double z);
/// Rotation about `axis` through the origin, followed by `shift`.
gp_Trsf turned(const gp_Vec& axis, double angle, const gp_Vec& shift);

}  // namespace dismantle::step_import::testing
