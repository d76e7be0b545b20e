#include "lost_products.h"

#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_PropertyDefinitionRepresentation.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationRelationship.hxx>
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

std::string name_of(const StepBasic_ProductDefinition& definition, TextEncoding encoding) {
  const auto formation = definition.Formation();
  const auto product = formation.IsNull() ? nullptr : formation->OfProduct();
  if (product.IsNull()) return "part";
  for (const auto& text : {product->Name(), product->Id()})
    if (!text.IsNull() && text->Length() > 0) return decoded(recoded(text->ToCString(), encoding));
  return "part";
}

/// "TESSELLATED_SOLID" for an entity that Open CASCADE does not know; "StepShape_CsgSolid" for one that it does.
std::string type_of(const Handle(Standard_Transient) & entity) {
  const auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity);
  return unknown.IsNull() ? entity->DynamicType()->Name() : unknown->StepType();
}

class Account {
 public:
  Account(STEPCAFControl_Reader& reader, TextEncoding encoding)
      : reader_(reader), encoding_(encoding), session_(reader.Reader().WS()), graph_(session_->Graph()) {}

  std::vector<LostProduct> run() {
    const Handle(Interface_InterfaceModel) model = session_->Model();
    const Handle(Transfer_TransientProcess) process = session_->TransferReader()->TransientProcess();
    find_external();
    std::vector<LostProduct> lost;
    for (int i = 1; i <= model->NbEntities(); ++i) {
      const auto definition = Handle(StepBasic_ProductDefinition)::DownCast(model->Value(i));
      if (definition.IsNull() || !is_part(definition)) continue;
      if (TopExp_Explorer(TransferBRep::ShapeResult(process, definition), TopAbs_VERTEX).More()) continue;
      if (const auto external = external_.find(definition.get()); external != external_.end()) {
        if (!external->second.empty()) lost.push_back({name_of(*definition, encoding_), external->second});
        continue;
      }
      lost.push_back(described(definition));
    }
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

  void collect(const Handle(Standard_Transient) & entity, std::set<std::string>& types, int depth) const {
    if (const auto representation = Handle(StepRepr_Representation)::DownCast(entity); !representation.IsNull()) {
      for (int i = 1; i <= representation->NbItems(); ++i)
        if (const Handle(Standard_Transient) item = representation->ItemsValue(i); !item.IsNull())
          types.insert(type_of(item));
      if (depth == 0) return;
      for (Interface_EntityIterator it = graph_.Sharings(entity); it.More(); it.Next())
        if (const auto relation = Handle(StepRepr_RepresentationRelationship)::DownCast(it.Value()); !relation.IsNull())
          for (const auto& other : {relation->Rep1(), relation->Rep2()})
            if (other != representation) collect(other, types, depth - 1);
      return;
    }
    if (const auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity); !unknown.IsNull()) {
      for (Interface_EntityIterator it = graph_.Shareds(entity); it.More(); it.Next())
        if (Handle(StepData_UndefinedEntity)::DownCast(it.Value())) types.insert(type_of(it.Value()));
      if (types.empty()) types.insert(type_of(entity));
    }
  }

  LostProduct described(const Handle(StepBasic_ProductDefinition) & definition) const {
    std::set<std::string> types;
    for (Interface_EntityIterator it = graph_.Sharings(definition); it.More(); it.Next()) {
      if (!it.Value()->IsKind(STANDARD_TYPE(StepRepr_ProductDefinitionShape))) continue;
      for (Interface_EntityIterator by = graph_.Sharings(it.Value()); by.More(); by.Next())
        for (Interface_EntityIterator of = graph_.Shareds(by.Value()); of.More(); of.Next())
          collect(of.Value(), types, 1);
    }
    const std::string name = name_of(*definition, encoding_);
    std::erase_if(types, [](const std::string& type) { return type.find("MappedItem") != std::string::npos; });
    if (types.empty()) return {name, "the file has no shape for it"};
    std::erase_if(types, [](const std::string& type) { return type.find("Axis2Placement") != std::string::npos; });
    if (types.empty()) return {name, "it is nothing but a coordinate system", true};
    std::string list;
    for (const std::string& type : types) list += (list.empty() ? "" : ", ") + type;
    return {name, "its shape is not read: " + list + "; export it as a boundary representation (AP214 or AP242)"};
  }

  STEPCAFControl_Reader& reader_;
  TextEncoding encoding_;
  Handle(XSControl_WorkSession) session_;
  const Interface_Graph& graph_;
  std::map<Definition, std::string> external_;
};

}  // namespace

std::vector<LostProduct> lost_products(STEPCAFControl_Reader& reader, TextEncoding encoding) {
  return Account(reader, encoding).run();
}

}  // namespace dismantle::step_import
