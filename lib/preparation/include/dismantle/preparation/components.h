/// Bodies of one product of the file that are put in as one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"

namespace dismantle {

/// The `components:` section. Patterns are those of fnmatch(3) and match names of products, and of single uses of assemblies.
struct ComponentChoice {
  /// What is a unit: a product with several bodies that is used as a leaf, each body, or what is at a depth of the tree.
  enum class Level { component, solid, depth };
  std::optional<Level> level{};       ///< none: component, where the sequence planner can keep parts together
  unsigned depth = 0;                 ///< of Level::depth: in the product tree; the root is 0
  std::vector<std::string> together{};  ///< products that are kept as one, at any depth
  std::vector<std::string> apart{};     ///< products that are not
  bool operator==(const ComponentChoice&) const = default;
};

/// One use of a product with several bodies, and how it is read.
struct Component {
  std::string name;           ///< unique in the assembly
  std::string product;        ///< equal for all uses of one product
  std::vector<PartId> parts;  ///< its bodies, ascending; two or more
  bool kept = true;           ///< as one unit
  std::string reason;         ///< of this reading
};

/// The components of an assembly, in the order of their first parts. Unless `choice` says otherwise, a product with
/// several bodies that is used as a leaf is one unit. Bodies of the root are single parts, and so are those of a product
/// that holds all parts: a design of several bodies is no component. Units share no part.
DISMANTLE_API std::vector<Component> components_of(const Assembly& assembly, const ComponentChoice& choice);

/// Names that patterns can match, each once.
DISMANTLE_API std::vector<std::string> product_names(const Assembly& assembly);

}  // namespace dismantle
