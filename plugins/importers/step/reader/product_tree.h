/// Walks the product structure of a document and lists every body at each of its places.
#pragma once

#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "product_colours.h"
#include "product_names.h"

namespace dismantle::step_import {

/// open_surface: the open shells of a product, with its faces without a shell if it has neither solids nor closed
/// shells.
enum class BodyKind { solid, closed_shell, open_surface };

/// One body at one place of the assembly.
struct PlacedBody {
  std::string name;                  ///< unique
  std::vector<std::string> parents;  ///< names of the assemblies that contain it, outermost first
  /// Of its assemblies and of its product: one id for each use, unique in the file, outermost first.
  std::vector<std::string> instances;
  std::string product;
  BodyKind kind = BodyKind::solid;
  TopoDS_Shape shape;  ///< with its location in the product, without the location of the instance
  TopLoc_Location instance;
  std::shared_ptr<const ProductColours> colours;
  std::optional<Rgba8> instance_colour;  ///< colour of the instance: overrides the colours of the product
  std::size_t faces = 0;
};

/// What the file declares and has no body of, at each of its places.
struct AbsentBody {
  std::string name;
  std::vector<std::string> parents;
  std::string problem;
  bool by_meaning = false;  ///< the file says that it is no part
};

struct ProductTree {
  std::vector<PlacedBody> bodies;
  std::vector<AbsentBody> absent;
  std::vector<std::string> warnings;  ///< faces beside bodies, by name
  std::vector<std::string> notes;     ///< curves and points beside bodies, by name
};

ProductTree walk_products(const Handle(XCAFDoc_ShapeTool) & shapes, TextEncoding encoding = TextEncoding::utf8);

}  // namespace dismantle::step_import
