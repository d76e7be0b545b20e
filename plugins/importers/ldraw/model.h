/// A model: its parts, its sub-models and the steps in which people build it.
#pragma once

#include <string>
#include <vector>

#include "dismantle/importer.h"
#include "library.h"

namespace dismantle::ldraw {

struct Model {
  std::vector<RawPart> parts;
  std::vector<ReferenceStep> order;
};

/// @throws InputError when the first file of the document holds no part.
Model model_of(Library& library, const RunContext& context);

}  // namespace dismantle::ldraw
