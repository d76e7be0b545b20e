/// Mapped items that are mirrored or scaled.
#pragma once

#include <STEPControl_Reader.hxx>
#include <string>
#include <vector>

namespace dismantle::step_import {

/// Open CASCADE places mapped items without the mirror or scale of their operator. This makes the shapes of these items
/// before the transfer of the roots, which then uses them. Returns why components of an assembly cannot be placed:
/// their operator mirrors or scales them.
std::vector<std::string> place_mapped_items(STEPControl_Reader& reader);

}  // namespace dismantle::step_import
