#include "structure.h"

#include <Interface_InterfaceModel.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepRepr_HArray1OfRepresentationItem.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepShape_ClosedShell.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <functional>
#include <istream>
#include <iterator>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "input_limits.h"

namespace dismantle::step_import {
namespace {

/// A directed graph whose nodes stand for themselves and all below them, once for each path.
class Nesting {
 public:
  void add(const Handle(Standard_Transient) & from, const Handle(Standard_Transient) & to) {
    if (!from.IsNull() && !to.IsNull()) below_[from.get()].push_back(to.get());
  }

  /// `named`: how a node is called.
  std::string problem(std::uint64_t most, std::size_t deepest, const char* what,
                      const std::function<std::string(const Standard_Transient*)>& named) {
    for (const auto& [node, children] : below_) {
      open_.clear();
      if (const std::uint64_t size = size_of(node, deepest); cycle_ != nullptr)
        return std::string(what) + " " + named(cycle_) + " contains itself";
      else if (too_deep_)
        return std::string(what) + " " + named(node) + " is nested more than " + std::to_string(deepest) + " deep";
      else if (size > most)
        return std::string(what) + " " + named(node) + " stands for more than " + std::to_string(most) + " instances";
    }
    return {};
  }

 private:
  std::uint64_t size_of(const Standard_Transient* node, std::size_t deepest) {
    if (const auto known = sizes_.find(node); known != sizes_.end()) {
      too_deep_ = too_deep_ || known->second.levels + open_.size() > deepest;
      return known->second.size;
    }
    if (!open_.insert(node).second) cycle_ = node;
    if (open_.size() > deepest) too_deep_ = true;
    if (cycle_ != nullptr || too_deep_) return 0;
    Size out;
    if (const auto found = below_.find(node); found != below_.end())
      for (const Standard_Transient* child : found->second) {
        out.size = std::min(out.size + size_of(child, deepest), kMany);
        if (cycle_ != nullptr || too_deep_) return 0;
        out.levels = std::max(out.levels, sizes_[child].levels + 1);
      }
    open_.erase(node);
    return (sizes_[node] = out).size;
  }

  struct Size {
    std::uint64_t size = 1;
    std::size_t levels = 1;
  };
  static constexpr std::uint64_t kMany = std::uint64_t{1} << 40;
  std::map<const Standard_Transient*, std::vector<const Standard_Transient*>> below_;
  std::map<const Standard_Transient*, Size> sizes_;
  std::set<const Standard_Transient*> open_;
  const Standard_Transient* cycle_ = nullptr;
  bool too_deep_ = false;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// The records of a file as text.
class Records {
 public:
  explicit Records(std::istream& in) {
    in.clear();
    in.seekg(0);
    text_.assign(std::istreambuf_iterator<char>(in), {});
    for (std::size_t at = text_.find('#'); at != std::string::npos; at = text_.find('#', at + 1)) {
      std::size_t end = at + 1;
      while (end < text_.size() && std::isdigit(static_cast<unsigned char>(text_[end])) != 0) ++end;
      std::size_t behind = end;
      while (behind < text_.size() && is_blank(text_[behind])) ++behind;
      if (behind < text_.size() && text_[behind] == '=') begins_.try_emplace(text_.substr(at, end - at), behind + 1);
    }
  }

  /// What stands behind "#id="; empty: there is none.
  std::string_view find(const std::string& id) const {
    const auto found = begins_.find(id);
    return found == begins_.end() ? std::string_view() : std::string_view(text_).substr(found->second);
  }

  /// The type of a record; what is wrong: there is none.
  std::string type(const std::string& id) const {
    std::string_view record = find(id);
    while (!record.empty() && is_blank(record.front())) record.remove_prefix(1);
    std::string out;
    while (!record.empty() && (std::isalnum(static_cast<unsigned char>(record[0])) != 0 || record[0] == '_')) {
      out += record[0];
      record.remove_prefix(1);
    }
    return out.empty() ? id + ", which the file lacks" : out;
  }

  /// "#1", "#2", ... of the items of a representation.
  std::vector<std::string> items(const std::string& id) const {
    std::string_view record = find(id);
    const auto name = record.find("REPRESENTATION");
    auto at = name == record.npos ? name : record.find('(', name);
    if (at == record.npos) return {};
    bool quoted = false;  // the name of the representation
    for (++at; at < record.size() && (quoted || record[at] != '('); ++at)
      if (record[at] == '\'') quoted = !quoted;
    std::vector<std::string> out;
    for (++at; at < record.size() && record[at] != ')'; ++at) {
      if (record[at] == '#') out.emplace_back();
      if (!out.empty() && (record[at] == '#' || std::isdigit(static_cast<unsigned char>(record[at])) != 0))
        out.back() += record[at];
    }
    return out;
  }

 private:
  std::string text_;
  std::unordered_map<std::string, std::size_t> begins_;  // by "#id": the place behind its "="
};

bool usable(const Handle(StepRepr_RepresentationItem) & item) {
  if (item.IsNull()) return false;
  const auto solid = Handle(StepShape_ManifoldSolidBrep)::DownCast(item);
  return solid.IsNull() || !solid->Outer().IsNull();
}

}  // namespace

std::string type_of(const Handle(Standard_Transient) & entity) {
  if (const auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity); !unknown.IsNull())
    return unknown->StepType();
  const std::string name = entity->DynamicType()->Name();
  std::string out;
  for (std::size_t i = name.find('_') + 1; i < name.size(); ++i) {
    if (std::isupper(static_cast<unsigned char>(name[i])) != 0 && !out.empty()) out += '_';
    out += static_cast<char>(std::toupper(static_cast<unsigned char>(name[i])));
  }
  return out;
}

std::string name_of_product(const StepBasic_ProductDefinition& definition, TextEncoding encoding) {
  const auto formation = definition.Formation();
  const auto product = formation.IsNull() ? nullptr : formation->OfProduct();
  if (product.IsNull()) return "part";
  for (const auto& text : {product->Name(), product->Id()})
    if (!text.IsNull() && text->Length() > 0) return decoded(recoded(text->ToCString(), encoding));
  return "part";
}

std::string endless_structure(STEPControl_Reader& reader, TextEncoding encoding) {
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  Nesting products, forward, backward;  // relations of representations lead both ways
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (const auto usage = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity); !usage.IsNull())
      products.add(usage->RelatingProductDefinition(), usage->RelatedProductDefinition());
    if (const auto relation = Handle(StepRepr_RepresentationRelationship)::DownCast(entity); !relation.IsNull()) {
      if (relation->IsKind(STANDARD_TYPE(StepRepr_RepresentationRelationshipWithTransformation))) continue;
      forward.add(relation->Rep1(), relation->Rep2());
      backward.add(relation->Rep2(), relation->Rep1());
    }
    const auto representation = Handle(StepRepr_Representation)::DownCast(entity);
    for (int k = 1; !representation.IsNull() && k <= representation->NbItems(); ++k) {
      const auto item = Handle(StepRepr_MappedItem)::DownCast(representation->ItemsValue(k));
      if (item.IsNull() || item->MappingSource().IsNull()) continue;
      forward.add(representation, item->MappingSource()->MappedRepresentation());
      backward.add(representation, item->MappingSource()->MappedRepresentation());
    }
  }
  const reader_process::InputLimits& limits = reader_process::kInputLimits;
  std::string out = products.problem(limits.instances, limits.nesting, "the product", [&](const auto* node) {
    const auto* definition = dynamic_cast<const StepBasic_ProductDefinition*>(node);
    return definition == nullptr ? std::string("part") : '\'' + name_of_product(*definition, encoding) + '\'';
  });
  constexpr std::size_t kDeepest = 1000;  // Open CASCADE walks them by recursion
  for (Nesting* representations : {&forward, &backward})
    if (out.empty())
      out = representations->problem(limits.instances, kDeepest, "the representation", [&](const auto* node) {
        return std::string(model->StringLabel(const_cast<Standard_Transient*>(node))->ToCString());
      });
  return out;
}

UnreadItems replace_unread_items(STEPControl_Reader& reader, std::istream& text) {
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  UnreadItems out;
  std::unique_ptr<Records> records;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto representation = Handle(StepRepr_Representation)::DownCast(model->Value(i));
    std::vector<std::string> ids;
    for (int k = 1; !representation.IsNull() && k <= representation->NbItems(); ++k) {
      const Handle(StepRepr_RepresentationItem) item = representation->ItemsValue(k);
      if (usable(item)) continue;
      if (records == nullptr) records = std::make_unique<Records>(text);
      if (ids.empty()) ids = records->items(model->StringLabel(representation)->ToCString());
      const auto at = static_cast<std::size_t>(k - 1);
      out[representation.get()].insert(at < ids.size() ? records->type(ids[at]) : "an item of an unknown kind");
      const Handle(StepRepr_RepresentationItem) nothing = new StepRepr_RepresentationItem;
      nothing->Init(new TCollection_HAsciiString(""));
      representation->Items()->SetValue(k, nothing);
    }
  }
  return out;
}

}  // namespace dismantle::step_import
