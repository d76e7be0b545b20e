/// A folder of products, each of which is an assembly of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/importer.h"

namespace dismantle {

/// An input for read_input().
struct Product {
  std::string name;  ///< unique among the products; valid UTF-8, without '/'
  std::filesystem::path input;
};

/// What was found in a folder.
struct Products {
  std::vector<Product> products;        ///< in natural order of names
  std::vector<std::string> left_aside;  ///< a line for each file that may be a product and that no importer reads
};

/// One product for each file that can be read and for each sub-folder that holds one. A product has the name of its
/// folder, or of its file without extension; if several have it, files keep their extension.
/// @throws InputError when the folder cannot be read or holds no product.
DISMANTLE_API Products products_in(const std::filesystem::path& folder,
                                   const std::vector<std::shared_ptr<Importer>>& importers);

}  // namespace dismantle
