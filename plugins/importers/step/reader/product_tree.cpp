#include "product_tree.h"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_Location.hxx>
#include <map>
#include <set>
#include <stdexcept>

#include "input_limits.h"

namespace dismantle::step_import {
namespace {

std::string entry(const TDF_Label& label) {
  TCollection_AsciiString text;
  TDF_Tool::Entry(label, text);
  return text.ToCString();
}

/// The bodies of one product; computed once, however often it is used.
struct Product {
  struct Member {
    BodyKind kind = BodyKind::solid;
    TopoDS_Shape shape;
    std::string name;
    std::size_t faces = 0;
  };
  std::vector<Member> members;
  std::size_t free_faces = 0, wires = 0, points = 0;  // free_faces: beside members
  std::shared_ptr<const ProductColours> colours;
  /// Whether it is nothing but construction geometry.
  bool drawn() const { return members.empty() && wires + points > 0; }
};

std::size_t count(const TopoDS_Shape& shape, TopAbs_ShapeEnum what, TopAbs_ShapeEnum outside = TopAbs_SHAPE) {
  std::size_t n = 0;
  for (TopExp_Explorer it(shape, what, outside); it.More(); it.Next()) ++n;
  return n;
}

/// Where the walk is.
struct Path {
  std::vector<std::string> parents;    ///< names of assemblies
  std::vector<std::string> instances;  ///< ids of uses; one more than parents: that of what is visited
};

class Walker {
 public:
  Walker(const Handle(XCAFDoc_ShapeTool) & shapes, TextEncoding encoding)
      : shapes_(shapes), colours_(XCAFDoc_DocumentTool::ColorTool(shapes->Label())), encoding_(encoding) {}

  ProductTree walk() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    std::size_t count = 0;
    for (const TDF_Label& root : roots)
      visit(root, name(root), TopLoc_Location(), {{}, {std::to_string(++count)}}, std::nullopt);
    give_names();
    return std::move(tree_);
  }

 private:
  std::string name(const TDF_Label& label) const { return name_of(label, encoding_); }

  void leave_out(const TDF_Label& label, const std::string& instance, const std::vector<std::string>& parents,
                 std::string problem, bool by_meaning) {
    std::string own = name(label);
    if (own.empty()) own = instance.empty() ? "part" : instance;
    tree_.absent.push_back({std::move(own), parents, std::move(problem), by_meaning});
  }

  /// `instance`: name of the instance, for products without a name.
  void visit(const TDF_Label& label, const std::string& instance, const TopLoc_Location& place,
             const Path& path, const std::optional<Rgba8>& colour) {
    const std::vector<std::string>& parents = path.parents;
    if (++visited_ > reader_process::kInputLimits.instances)
      throw std::length_error("more than a million instances of products");
    if (parents.size() > reader_process::kInputLimits.nesting)
      throw std::length_error("assemblies nested more than 64 deep");
    if (!colours_->IsVisible(label)) {
      TDF_Label product;
      const bool refers = XCAFDoc_ShapeTool::GetReferredShape(label, product);
      return leave_out(refers ? product : label, instance, parents, "it is hidden in the file", true);
    }
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      TDF_Label product;
      if (!XCAFDoc_ShapeTool::GetReferredShape(label, product))
        return leave_out(label, instance, parents, "the file has no product for this component", false);
      const std::optional<Rgba8> own = colour ? colour : colour_of(label);
      visit(product, instance, place * XCAFDoc_ShapeTool::GetLocation(label), path, own);
      return;
    }
    if (XCAFDoc_ShapeTool::IsAssembly(label)) {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components, Standard_False);
      Path below = path;
      below.parents.push_back(!instance.empty() ? instance : name(label));
      below.instances.emplace_back();
      std::size_t count = 0;
      for (const TDF_Label& component : components) {
        below.instances.back() = path.instances.back() + "." + std::to_string(++count);
        visit(component, name(component), place, below, colour);
      }
      if (components.IsEmpty()) leave_out(label, instance, parents, "it is an assembly without components", false);
      return;
    }
    place_product(label, instance, place, path, colour);
  }

  void place_product(const TDF_Label& label, const std::string& instance_name, const TopLoc_Location& place,
                     const Path& path, const std::optional<Rgba8>& colour) {
    const Product& product = product_of(label);
    std::string own = name(label);
    if (own.empty()) own = instance_name.empty() ? "part" : instance_name;
    if (product.members.empty())
      return leave_out(label, instance_name, path.parents, problem_of(product), product.drawn());
    for (std::size_t i = 0; i < product.members.size(); ++i) {
      const auto& member = product.members[i];
      PlacedBody body;
      const bool alone = product.members.size() == 1;
      body.name = alone ? own : own + ":" + (member.name.empty() ? std::to_string(i + 1) : member.name);
      bearers_[body.name].push_back({tree_.bodies.size(), &product});
      body.parents = path.parents;
      body.instances = path.instances;
      body.product = own;
      body.kind = member.kind;
      body.shape = member.shape;
      body.instance = place;
      body.colours = product.colours;
      body.instance_colour = colour;
      body.faces = member.faces;
      tree_.bodies.push_back(std::move(body));
    }
    report_rest(own, product);
  }

  /// Different products with one name ("Body" in "post" and "Body" in "lid") get the name of their assembly as a
  /// prefix, if this makes all of them distinct. Bodies that still share a name are numbered.
  void give_names() {
    for (const auto& [name, bearers] : bearers_) {
      std::set<const Product*> products;
      std::set<std::string> homes;
      for (const auto& [body, product] : bearers) {
        products.insert(product);
        const auto& parents = tree_.bodies[body].parents;
        if (!parents.empty() && !parents.back().empty()) homes.insert(parents.back());
      }
      if (products.size() < 2 || homes.size() < bearers.size()) continue;
      for (const auto& [body, product] : bearers)
        tree_.bodies[body].name = tree_.bodies[body].parents.back() + "/" + name;
    }
    std::vector<std::string*> names;
    for (auto& body : tree_.bodies) names.push_back(&body.name);
    make_unique(names);
  }

  static std::string listed(const Product& product) {
    std::string list;
    const auto add = [&](std::size_t n, const char* one, const char* many) {
      if (n > 0) list += (list.empty() ? "" : ", ") + std::to_string(n) + " " + (n == 1 ? one : many);
    };
    add(product.free_faces, "face", "faces");
    add(product.wires, "curve", "curves");
    add(product.points, "point", "points");
    return list;
  }

  static std::string problem_of(const Product& product) {
    const std::string list = listed(product);
    if (list.empty()) return "it has no body: the file has no shape for it, or one of a kind that is not read";
    return "it is no body, it holds " + list;
  }

  /// Once for each name, not for each instance.
  void report_rest(const std::string& own, const Product& product) {
    const std::string list = listed(product);
    if (list.empty() || !reported_.insert(own).second) return;
    (product.free_faces > 0 ? tree_.warnings : tree_.notes)
        .push_back("'" + own + "' holds " + list + " beside its bodies: left aside");
  }

  const Product& product_of(const TDF_Label& label) {
    const auto [found, fresh] = products_.try_emplace(entry(label));
    Product& product = found->second;
    if (!fresh) return product;
    product.colours = std::make_shared<ProductColours>(label, shapes_);
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (shape.IsNull()) return product;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) add(product, BodyKind::solid, it.Current());
    TopoDS_Compound surface;  // open shells are one; faces without a shell belong to it when there is nothing else
    BRep_Builder builder;
    builder.MakeCompound(surface);
    for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next())
      if (BRep_Tool::IsClosed(it.Current()))
        add(product, BodyKind::closed_shell, it.Current());
      else
        builder.Add(surface, it.Current());
    if (!product.members.empty()) product.free_faces = count(shape, TopAbs_FACE, TopAbs_SHELL);
    for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More() && product.members.empty(); it.Next())
      builder.Add(surface, it.Current());
    if (count(surface, TopAbs_FACE) > 0) add(product, BodyKind::open_surface, surface);
    product.wires = count(shape, TopAbs_WIRE, TopAbs_FACE) + count(shape, TopAbs_EDGE, TopAbs_WIRE);
    product.points = count(shape, TopAbs_VERTEX, TopAbs_EDGE);
    name_members(label, product);
    return product;
  }

  static void add(Product& product, BodyKind kind, const TopoDS_Shape& shape) {
    product.members.push_back({kind, shape, {}, count(shape, TopAbs_FACE)});
  }

  /// Uses the names of the bodies of one product only if each body has a distinct name.
  void name_members(const TDF_Label& label, Product& product) {
    if (product.members.size() < 2) return;
    TDF_LabelSequence subshapes;
    shapes_->GetSubShapes(label, subshapes);
    std::set<std::string> different;
    for (auto& member : product.members) {
      for (const TDF_Label& subshape : subshapes)
        if (XCAFDoc_ShapeTool::GetShape(subshape).IsSame(member.shape)) member.name = name(subshape);
      if (!member.name.empty()) different.insert(member.name);
    }
    if (different.size() < product.members.size())
      for (auto& member : product.members) member.name.clear();
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  TextEncoding encoding_;
  ProductTree tree_;
  struct Bearer {
    std::size_t body;
    const Product* product;
  };
  std::map<std::string, std::vector<Bearer>> bearers_;  // by name
  std::map<std::string, Product> products_;
  std::set<std::string> reported_;
  std::size_t visited_ = 0;
};

}  // namespace

ProductTree walk_products(const Handle(XCAFDoc_ShapeTool) & shapes, TextEncoding encoding) {
  return Walker(shapes, encoding).walk();
}

}  // namespace dismantle::step_import
