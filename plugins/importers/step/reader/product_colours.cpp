#include "product_colours.h"

#include <Quantity_Color.hxx>
#include <TDF_LabelSequence.hxx>
#include <XCAFDoc_ColorType.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <algorithm>
#include <cmath>
#include <map>

namespace dismantle::step_import {
namespace {

std::uint8_t byte(double share) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

Rgba8 srgb(const Quantity_ColorRGBA& colour) {
  double r = 0, g = 0, b = 0;
  colour.GetRGB().Values(r, g, b, Quantity_TOC_sRGB);
  return {byte(r), byte(g), byte(b), byte(static_cast<double>(colour.Alpha()))};
}

}  // namespace

std::optional<Rgba8> colour_of(const TDF_Label& label) {
  const Handle(XCAFDoc_ColorTool) tool = XCAFDoc_DocumentTool::ColorTool(label);
  Quantity_ColorRGBA colour;
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
    if (tool->GetColor(label, type, colour)) return srgb(colour);
  return std::nullopt;
}

ProductColours::ProductColours(const TDF_Label& product, const Handle(XCAFDoc_ShapeTool) & shapes)
    : product_(colour_of(product)) {
  TDF_LabelSequence subshapes;
  shapes->GetSubShapes(product, subshapes);
  for (const TDF_Label& label : subshapes) {
    const auto colour = colour_of(label);
    TopoDS_Shape shape;
    if (!colour || !shapes->GetShape(label, shape) || index_.IsBound(shape)) continue;
    index_.Bind(shape, static_cast<int>(colours_.size()));
    colours_.push_back(*colour);
  }
}

std::optional<Rgba8> ProductColours::find(const TopoDS_Shape& shape) const {
  int i = 0;
  if (!index_.Find(shape, i)) return std::nullopt;
  return colours_[static_cast<std::size_t>(i)];
}

std::optional<Rgba8> ProductColours::of(const TopoDS_Shape& body, const Surface& surface) const {
  const std::optional<Rgba8> own = find(body);
  const std::optional<Rgba8> rest = own ? own : product_;
  if (index_.IsEmpty()) return rest;
  std::map<std::optional<Rgba8>, double> areas;
  for (const auto& [face, area] : surface.faces) {
    // The surface was computed from the body without its location.
    const auto colour = find(face.Located(body.Location() * face.Location()));
    areas[colour ? colour : rest] += area;
  }
  if (areas.empty()) return rest;
  return std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace dismantle::step_import
