#include "lost_products.h"

#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_ShapeAspect.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_BooleanResult.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_Face.hxx>
#include <StepShape_FaceBasedSurfaceModel.hxx>
#include <StepShape_HalfSpaceSolid.hxx>
#include <StepShape_RightAngularWedge.hxx>
#include <StepShape_RightCircularCone.hxx>
#include <StepShape_RightCircularCylinder.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_Sphere.hxx>
#include <StepShape_Torus.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace dismantle::step_import {
namespace {

using Definition = const StepBasic_ProductDefinition*;

/// Whether an item of a representation is a body: Open CASCADE gives a shape for those that it reads.
bool is_body(const Handle(Standard_Transient) & item) {
  for (const Handle(Standard_Type) & type :
       {STANDARD_TYPE(StepShape_SolidModel), STANDARD_TYPE(StepShape_Block), STANDARD_TYPE(StepShape_Sphere),
        STANDARD_TYPE(StepShape_Torus), STANDARD_TYPE(StepShape_RightCircularCone),
        STANDARD_TYPE(StepShape_RightCircularCylinder), STANDARD_TYPE(StepShape_RightAngularWedge),
        STANDARD_TYPE(StepShape_BooleanResult), STANDARD_TYPE(StepShape_HalfSpaceSolid),
        STANDARD_TYPE(StepShape_ShellBasedSurfaceModel), STANDARD_TYPE(StepShape_FaceBasedSurfaceModel),
        STANDARD_TYPE(StepData_UndefinedEntity)})
    if (item->IsKind(type)) return true;
  return false;
}

class Account {
 public:
  Account(STEPCAFControl_Reader& reader, const UnreadItems& unread, TextEncoding encoding)
      : reader_(reader),
        unread_(unread),
        encoding_(encoding),
        session_(reader.Reader().WS()),
        graph_(session_->Graph()),
        process_(session_->TransferReader()->TransientProcess()) {}

  std::vector<LostProduct> run() {
    const Handle(Interface_InterfaceModel) model = session_->Model();
    find_external();
    std::vector<LostProduct> lost;
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(model->Value(i));
      if (definition.IsNull()) continue;
      const Declared declared = declared_by(definition);
      const bool arrived = TopExp_Explorer(TransferBRep::ShapeResult(process_, definition), TopAbs_VERTEX).More();
      if (arrived || !is_part(definition)) {
        if (const std::string types = listed(declared.unread); !types.empty())
          lost.push_back({name_of_product(*definition, encoding_) + ":" + types,
                          "a part of its product's shape is not read: " + types + kAdvice});
        continue;
      }
      if (const auto external = external_.find(definition.get()); external != external_.end()) {
        if (!external->second.empty()) lost.push_back({name_of_product(*definition, encoding_), external->second});
        continue;
      }
      lost.push_back(described(*definition, declared));
    }
    add_loose(*model, lost);
    add_damaged(*model, lost);
    std::ranges::stable_sort(lost, std::greater{}, &LostProduct::by_meaning);
    return lost;
  }

 private:
  /// Whether something says that it has a shape or a place, and it is no assembly.
  bool is_part(const Handle(StepBasic_ProductDefinition) & definition) const {
    bool part = false;
    for (Interface_EntityIterator it = graph_.Sharings(definition); it.More(); it.Next()) {
      if (const auto usage = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(it.Value()); !usage.IsNull()) {
        if (usage->RelatingProductDefinition() == definition) return false;
        part = true;
      }
      if (it.Value()->IsKind(STANDARD_TYPE(StepRepr_ProductDefinitionShape))) part = true;
    }
    return part;
  }

  /// External references and why they gave nothing; empty: they gave a shape.
  void find_external() {
    STEPConstruct_ExternRefs references(session_);
    references.LoadExternRefs();
    for (int i = 1; i <= references.NbExternRefs(); ++i) {
      const Handle(StepBasic_ProductDefinition) definition = references.ProdDef(i);
      if (definition.IsNull()) continue;
      const std::string file = decoded(recoded(references.FileName(i), encoding_));
      Handle(STEPCAFControl_ExternFile) read;
      const bool there = reader_.ExternFile(references.FileName(i), read) && !read.IsNull() &&
                         read->GetTransferStatus() && !read->GetLabel().IsNull();
      external_[definition.get()] =
          there ? "" : "its file '" + file + "' is missing or cannot be read: put it beside this one";
    }
  }

  /// What the representations of a product consist of.
  struct Declared {
    std::set<std::string> types;   ///< of all items
    std::set<std::string> unread;  ///< of bodies without a shape
    std::set<const Standard_Transient*> seen;
  };

  Declared declared_by(const Handle(StepBasic_ProductDefinition) & definition) {
    Declared out;
    for (Interface_EntityIterator it = graph_.Sharings(definition); it.More(); it.Next()) {
      if (!it.Value()->IsKind(STANDARD_TYPE(StepRepr_ProductDefinitionShape))) continue;
      for (Interface_EntityIterator by = graph_.Sharings(it.Value()); by.More(); by.Next()) {
        if (by.Value()->IsKind(STANDARD_TYPE(StepRepr_ShapeAspect))) continue;  // of tolerances and dimensions
        for (Interface_EntityIterator of = graph_.Shareds(by.Value()); of.More(); of.Next()) collect(of.Value(), out);
      }
    }
    return out;
  }

  void collect(const Handle(Standard_Transient) & entity, Declared& out) {
    if (entity.IsNull() || !out.seen.insert(entity.get()).second) return;
    if (const auto representation = Handle(StepRepr_Representation)::DownCast(entity); !representation.IsNull()) {
      if (const auto found = unread_.find(representation.get()); found != unread_.end()) {
        out.types.insert(found->second.begin(), found->second.end());
        out.unread.insert(found->second.begin(), found->second.end());
      }
      for (int i = 1; i <= representation->NbItems(); ++i) collect_item(representation->ItemsValue(i), out);
      // Relations with a transformation place components.
      for (Interface_EntityIterator it = graph_.Sharings(entity); it.More(); it.Next())
        if (const auto relation = Handle(StepRepr_RepresentationRelationship)::DownCast(it.Value());
            !relation.IsNull() &&
            !relation->IsKind(STANDARD_TYPE(StepRepr_RepresentationRelationshipWithTransformation))) {
          collect(relation->Rep1(), out);
          collect(relation->Rep2(), out);
        }
    } else if (const auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity); !unknown.IsNull()) {
      // A representation of a kind that is not known. Beside bodies it is their shape again, such as triangles in
      // AP242.
      std::set<std::string> types;
      for (Interface_EntityIterator it = graph_.Shareds(entity); it.More(); it.Next())
        if (Handle(StepData_UndefinedEntity)::DownCast(it.Value())) types.insert(type_of(it.Value()));
      if (types.empty()) types.insert(type_of(entity));
      out.types.merge(types);
    }
  }

  void collect_item(const Handle(StepRepr_RepresentationItem) & item, Declared& out) {
    if (item.IsNull() || item->DynamicType() == STANDARD_TYPE(StepRepr_RepresentationItem)) return;  // one of unread_
    if (const auto mapped = Handle(StepRepr_MappedItem)::DownCast(item); !mapped.IsNull()) {
      if (!mapped->MappingSource().IsNull()) collect(mapped->MappingSource()->MappedRepresentation(), out);
      return;
    }
    placed_.insert(item.get());
    out.types.insert(type_of(item));
    if (is_body(item) && TransferBRep::ShapeResult(process_, item).IsNull()) out.unread.insert(type_of(item));
  }

  /// Solids that no product has.
  void add_loose(const Interface_InterfaceModel& model, std::vector<LostProduct>& lost) const {
    for (int i = 1; i <= model.NbEntities(); ++i) {
      const auto solid = Handle(StepShape_SolidModel)::DownCast(model.Value(i));
      if (solid.IsNull() || placed_.contains(solid.get()) || !TransferBRep::ShapeResult(process_, solid).IsNull())
        continue;
      bool of_another = false;  // of a CSG tree, a replica
      for (Interface_EntityIterator it = graph_.Sharings(solid); it.More(); it.Next())
        of_another = of_another || is_body(it.Value());
      if (of_another) continue;
      std::string name = solid->Name().IsNull() ? "" : decoded(recoded(solid->Name()->ToCString(), encoding_));
      if (name.empty()) name = std::string("solid ") + model.StringLabel(solid)->ToCString();
      lost.push_back({name, "it is in no product of the file: " + type_of(solid)});
    }
  }

  /// Shells that came without some of their faces.
  void add_damaged(const Interface_InterfaceModel& model, std::vector<LostProduct>& lost) const {
    for (int i = 1; i <= model.NbEntities(); ++i) {
      const auto shell = Handle(StepShape_ConnectedFaceSet)::DownCast(model.Value(i));
      if (shell.IsNull() || TransferBRep::ShapeResult(process_, shell).IsNull()) continue;
      int missing = 0;
      for (int k = 1; k <= shell->NbCfsFaces(); ++k) {
        const Handle(StepShape_Face) face = shell->CfsFacesValue(k);
        missing += face.IsNull() || TransferBRep::ShapeResult(process_, face).IsNull();
      }
      if (missing == 0) continue;
      const std::string name = std::string("shell ") + model.StringLabel(shell)->ToCString();
      lost.push_back({name, std::to_string(missing) + " of its " + std::to_string(shell->NbCfsFaces()) +
                                " faces are damaged, or the file lacks them"});
    }
  }

  static std::string listed(const std::set<std::string>& types) {
    std::string list;
    for (const std::string& type : types) list += (list.empty() ? "" : ", ") + type;
    return list;
  }

  LostProduct described(const StepBasic_ProductDefinition& definition, Declared declared) const {
    const std::string name = name_of_product(definition, encoding_);
    std::set<std::string>& types = declared.types;
    if (types.empty()) return {name, "the file has no shape for it"};
    std::erase_if(types, [](const std::string& type) { return type.starts_with("AXIS2_PLACEMENT"); });
    if (types.empty()) return {name, "it is nothing but a coordinate system", true};
    return {name, "its shape is not read: " + listed(types) + kAdvice};
  }

  static constexpr const char* kAdvice = "; export it as a boundary representation (AP214 or AP242)";
  STEPCAFControl_Reader& reader_;
  const UnreadItems& unread_;
  TextEncoding encoding_;
  Handle(XSControl_WorkSession) session_;
  const Interface_Graph& graph_;
  Handle(Transfer_TransientProcess) process_;
  std::map<Definition, std::string> external_;
  std::set<const Standard_Transient*> placed_;  // items of representations of products
};

}  // namespace

std::vector<LostProduct> lost_products(STEPCAFControl_Reader& reader, const UnreadItems& unread,
                                       TextEncoding encoding) {
  return Account(reader, unread, encoding).run();
}

}  // namespace dismantle::step_import
