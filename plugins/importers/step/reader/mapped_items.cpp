#include "mapped_items.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <STEPControl_ActorRead.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_Axis2Placement3d.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_Transformation.hxx>
#include <TransferBRep.hxx>
#include <TransferBRep_ShapeBinder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <gp_Trsf.hxx>
#include <set>

#include "units.h"

namespace dismantle::step_import {
namespace {

gp_XYZ vector_of(const Handle(StepGeom_Direction) & direction, const gp_XYZ& otherwise) {
  if (direction.IsNull() || direction->NbDirectionRatios() < 3) return otherwise;
  const gp_XYZ v(direction->DirectionRatiosValue(1), direction->DirectionRatiosValue(2),
                 direction->DirectionRatiosValue(3));
  return v.Modulus() > 0 ? v.Normalized() : otherwise;
}

gp_XYZ point_of(const Handle(StepGeom_CartesianPoint) & point) {
  if (point.IsNull() || point->NbCoordinates() < 3) return {0, 0, 0};
  return {point->CoordinatesValue(1), point->CoordinatesValue(2), point->CoordinatesValue(3)};
}

/// The part of `v` across `axis`, unit; `otherwise` when nothing is left.
gp_XYZ across(const gp_XYZ& v, const gp_XYZ& axis, const gp_XYZ& otherwise) {
  const gp_XYZ rest = v - axis * v.Dot(axis);
  return rest.Modulus() > 1e-9 ? rest.Normalized() : otherwise;
}

/// Axes as base_axis of ISO 10303-42 has them: the third as given, the others projected. They may be left-handed.
struct Frame {
  gp_XYZ x, y, z, origin;
  double scale = 1;
  bool turns_only() const { return x.Crossed(y).Dot(z) > 0 && std::abs(scale - 1) < 1e-12; }
  gp_Trsf transform(double millimetres) const {
    gp_Trsf out;
    const gp_XYZ o = origin * millimetres;
    out.SetValues(scale * x.X(), scale * y.X(), scale * z.X(), o.X(), scale * x.Y(), scale * y.Y(), scale * z.Y(),
                  o.Y(), scale * x.Z(), scale * y.Z(), scale * z.Z(), o.Z());
    return out;
  }
};

Frame frame_of(const Handle(StepGeom_Direction) & axis1, const Handle(StepGeom_Direction) & axis2,
               const Handle(StepGeom_Direction) & axis3, const Handle(StepGeom_CartesianPoint) & origin) {
  Frame out;
  out.z = vector_of(axis3, {0, 0, 1});
  const gp_XYZ fallback = across({1, 0, 0}, out.z, {0, 1, 0});
  out.x = across(vector_of(axis1, fallback), out.z, fallback);
  const gp_XYZ right = out.z.Crossed(out.x);
  out.y = vector_of(axis2, right).Dot(right) < 0 ? right * -1.0 : right;
  out.origin = point_of(origin);
  return out;
}

Frame frame_of(const StepGeom_CartesianTransformationOperator3d& op) {
  Frame out = frame_of(op.HasAxis1() ? op.Axis1() : nullptr, op.HasAxis2() ? op.Axis2() : nullptr,
                       op.HasAxis3() ? op.Axis3() : nullptr, op.LocalOrigin());
  if (op.HasScale()) out.scale = op.Scale();
  return out;
}

class Mapper {
 public:
  explicit Mapper(STEPControl_Reader& reader) : session_(reader.WS()) {}

  std::vector<std::string> run() {
    const Handle(Interface_InterfaceModel) model = session_->Model();
    std::vector<std::string> refused;
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const Handle(Standard_Transient) entity = model->Value(i);
      if (const auto item = Handle(StepRepr_MappedItem)::DownCast(entity); !item.IsNull()) {
        place(item, 0);
        const Handle(Standard_Transient) target = item->MappingTarget();
        if (target.IsNull() || target->IsKind(STANDARD_TYPE(StepData_UndefinedEntity)))
          refused.push_back("the mapped item #" + std::to_string(model->Number(entity)) +
                            " is placed by an operator of a kind that is not read");
      }
      const auto relation = Handle(StepRepr_RepresentationRelationshipWithTransformation)::DownCast(entity);
      if (relation.IsNull()) continue;
      const Handle(Standard_Transient) value = relation->TransformationOperator().Value();
      if (value.IsNull() || value->IsKind(STANDARD_TYPE(StepData_UndefinedEntity)))
        refused.push_back("the component placed by #" + std::to_string(model->Number(entity)) +
                          " is placed by an operator of a kind that is not read");
      const auto op = Handle(StepGeom_CartesianTransformationOperator3d)::DownCast(value);
      if (!op.IsNull() && !frame_of(*op).turns_only())
        refused.push_back("the component placed by #" + std::to_string(model->Number(entity)) +
                          " is mirrored or scaled by a CARTESIAN_TRANSFORMATION_OPERATOR_3D, which is not read: write "
                          "it as a part of its own");
    }
    return refused;
  }

 private:
  void place(const Handle(StepRepr_MappedItem) & item, int depth) {
    const auto op = Handle(StepGeom_CartesianTransformationOperator3d)::DownCast(item->MappingTarget());
    if (op.IsNull() || item->MappingSource().IsNull() || !done_.insert(item.get()).second) return;
    const Frame target = frame_of(*op);
    const Handle(StepRepr_Representation) mapped = item->MappingSource()->MappedRepresentation();
    if (target.turns_only() || mapped.IsNull() || depth > 64) return;
    for (int i = 1; i <= mapped->NbItems(); ++i)
      if (const auto inner = Handle(StepRepr_MappedItem)::DownCast(mapped->ItemsValue(i)); !inner.IsNull())
        place(inner, depth + 1);

    const Handle(XSControl_TransferReader) transfer = session_->TransferReader();
    if (!transfer->BeginTransfer()) return;
    const Handle(Transfer_TransientProcess) process = transfer->TransientProcess();
    const auto actor = Handle(STEPControl_ActorRead)::DownCast(transfer->Actor());
    if (process.IsNull() || actor.IsNull()) return;
    TopoDS_Shape shape = TransferBRep::ShapeResult(process, mapped);
    if (shape.IsNull()) shape = TransferBRep::ShapeResult(actor->TransferShape(mapped, process));
    if (shape.IsNull()) return;
    const double unit = millimetres_in(mapped->ContextOfItems()).value_or(1);
    Frame source;
    if (const auto origin = Handle(StepGeom_Axis2Placement3d)::DownCast(item->MappingSource()->MappingOrigin());
        !origin.IsNull())
      source = frame_of(origin->HasRefDirection() ? origin->RefDirection() : nullptr, nullptr,
                        origin->HasAxis() ? origin->Axis() : nullptr, origin->Location());
    else
      source = frame_of(nullptr, nullptr, nullptr, nullptr);
    const gp_Trsf place = target.transform(unit) * source.transform(unit).Inverted();
    const TopoDS_Shape placed = BRepBuilderAPI_Transform(shape, place, Standard_True).Shape();
    process->Bind(item, new TransferBRep_ShapeBinder(placed));
  }

  Handle(XSControl_WorkSession) session_;
  std::set<const void*> done_;
};

}  // namespace

std::vector<std::string> place_mapped_items(STEPControl_Reader& reader) { return Mapper(reader).run(); }

}  // namespace dismantle::step_import
