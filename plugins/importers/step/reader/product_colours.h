/// One colour for a body out of those that the file gives to its instances, product, solid and faces.
#pragma once

#include <Quantity_ColorRGBA.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tessellate.h"

namespace dismantle::step_import {

using Rgba8 = std::array<std::uint8_t, 4>;  ///< sRGB, as in "#rrggbb", and opacity

/// The colour of a label itself.
std::optional<Rgba8> colour_of(const TDF_Label& label);

/// Colours within one product.
class ProductColours {
 public:
  ProductColours(const TDF_Label& product, const Handle(XCAFDoc_ShapeTool) & shapes);

  /// The colour that covers most of the body's area: that of a face, else of the body, else of the product.
  std::optional<Rgba8> of(const TopoDS_Shape& body, const Surface& surface) const;

 private:
  std::optional<Rgba8> find(const TopoDS_Shape& shape) const;

  std::optional<Rgba8> product_;
  TopTools_DataMapOfShapeInteger index_;
  std::vector<Rgba8> colours_;
};

}  // namespace dismantle::step_import
