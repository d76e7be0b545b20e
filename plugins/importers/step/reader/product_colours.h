/// Chooses one colour for a body from the colours of its instances, product, solid and faces.
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

/// The colour of the label itself, not of its parents.
std::optional<Rgba8> colour_of(const TDF_Label& label);

/// The colours in one product.
class ProductColours {
 public:
  ProductColours(const TDF_Label& product, const Handle(XCAFDoc_ShapeTool) & shapes);

  /// The colour with the largest area. A face has its own colour, else that of the body, else that of the product.
  std::optional<Rgba8> of(const TopoDS_Shape& body, const Surface& surface) const;

 private:
  std::optional<Rgba8> find(const TopoDS_Shape& shape) const;

  std::optional<Rgba8> product_;
  TopTools_DataMapOfShapeInteger index_;
  std::vector<Rgba8> colours_;
};

}  // namespace dismantle::step_import
