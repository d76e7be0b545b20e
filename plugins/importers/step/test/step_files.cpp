#include "step_files.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <stdexcept>

namespace dismantle::step_import::testing {
namespace {

TCollection_ExtendedString text(const std::string& utf8) { return {utf8.c_str(), Standard_True}; }

Quantity_ColorRGBA colour_of(const Rgba& c) {
  return {Quantity_Color(c.r / 255.0, c.g / 255.0, c.b / 255.0, Quantity_TOC_sRGB), static_cast<float>(c.a) / 255.0f};
}

}  // namespace

StepFile::StepFile() {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
}

TDF_Label StepFile::product(const TopoDS_Shape& shape, const std::string& name) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddShape(shape, Standard_False);
  TDataStd_Name::Set(label, text(name));
  return label;
}

TDF_Label StepFile::assembly(const std::string& name) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->NewShape();
  TDataStd_Name::Set(label, text(name));
  return label;
}

TDF_Label StepFile::place(const TDF_Label& assembly, const TDF_Label& what, const gp_Trsf& where,
                          const std::string& name) {
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  const TDF_Label instance = shapes->AddComponent(assembly, what, TopLoc_Location(where));
  if (!name.empty()) TDataStd_Name::Set(instance, text(name));
  return instance;
}

void StepFile::paint(const TDF_Label& label, const Rgba& colour) {
  XCAFDoc_DocumentTool::ColorTool(document_->Main())->SetColor(label, colour_of(colour), XCAFDoc_ColorSurf);
}

void StepFile::paint(const TDF_Label& product, const TopoDS_Shape& part, const Rgba& colour) {
  paint(XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddSubShape(product, part), colour);
}

void StepFile::name(const TDF_Label& product, const TopoDS_Shape& part, const std::string& name) {
  TDataStd_Name::Set(XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddSubShape(product, part), text(name));
}

void StepFile::write(const std::filesystem::path& file, const char* unit) {
  XCAFDoc_DocumentTool::ShapeTool(document_->Main())->UpdateAssemblies();
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", unit);  // the writer reads it in its constructor
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document_, STEPControl_AsIs) || writer.Write(file.c_str()) != IFSelect_RetDone)
    throw std::runtime_error("Open CASCADE does not write " + file.string());
}

TopoDS_Shape box(double x, double y, double z) { return BRepPrimAPI_MakeBox(x, y, z).Shape(); }

TopoDS_Shape cylinder(double radius, double height) { return BRepPrimAPI_MakeCylinder(radius, height).Shape(); }

gp_Trsf moved(double x, double y, double z) {
  gp_Trsf t;
  t.SetTranslation(gp_Vec(x, y, z));
  return t;
}

gp_Trsf turned(const gp_Vec& axis, double angle, const gp_Vec& shift) {
  gp_Trsf turn, shifted;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(axis)), angle);
  shifted.SetTranslation(shift);
  return shifted * turn;
}

}  // namespace dismantle::step_import::testing
