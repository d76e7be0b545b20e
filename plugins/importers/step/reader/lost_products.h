/// Products of a file that gave no shape, or not all of it.
#pragma once

#include <STEPCAFControl_Reader.hxx>
#include <string>
#include <vector>

#include "product_names.h"
#include "structure.h"

namespace dismantle::step_import {

struct LostProduct {
  std::string name;
  std::string problem;      ///< what its shape consists of, and why it is not read
  bool by_meaning = false;  ///< nothing but coordinate systems
};

/// Compares the products that the file declares with what was transferred. Assemblies and documents do not count. Those
/// that lack more than others of their name come last. Products of which bodies are missing, solids that are in no
/// product, and shells without some of their faces are among them. `reader`: after the transfer.
std::vector<LostProduct> lost_products(STEPCAFControl_Reader& reader, const UnreadItems& unread, TextEncoding encoding);

}  // namespace dismantle::step_import
