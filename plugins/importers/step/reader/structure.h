/// What a file is built of, looked at before it is transferred: structures without an end, and items that are no
/// shapes.
#pragma once

#include <STEPControl_Reader.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepRepr_Representation.hxx>
#include <map>
#include <set>
#include <string>

#include "product_names.h"

namespace dismantle::step_import {

/// Why Open CASCADE would crash or not end: products or representations that contain themselves, that are nested too
/// deep, or that stand for more than a million instances. Looks at each record once. Empty: nothing of the kind.
std::string endless_structure(STEPControl_Reader& reader, TextEncoding encoding);

/// By representation: the types of its items that are not read.
using UnreadItems = std::map<const StepRepr_Representation*, std::set<std::string>>;

/// Open CASCADE crashes on a representation with an item that it does not know, that the file lacks, or whose surface
/// is missing. They are replaced by items without a shape. `text`: of the file.
UnreadItems replace_unread_items(STEPControl_Reader& reader, std::istream& text);

/// "CSG_SOLID" for an entity of the type StepShape_CsgSolid, and the name in the file of one that is not known.
std::string type_of(const Handle(Standard_Transient) & entity);

/// Name of the product of a definition; "part": it has none.
std::string name_of_product(const StepBasic_ProductDefinition& definition, TextEncoding encoding);

}  // namespace dismantle::step_import
