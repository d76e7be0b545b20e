#include "dismantle/session/products.h"

#include "importers.h"

namespace dismantle {

Products products_in(const std::filesystem::path& folder, const Session& session) {
  return products_in(folder, importers_of(session.registry(), import_params_of(session.config(), session.registry())));
}

std::set<std::string> readable_extensions(const Session& session) {
  std::set<std::string> out;
  for (const auto& importer :
       importers_of(session.registry(), import_params_of(session.config(), session.registry())))
    for (const std::string& extension : importer->extensions()) out.insert(extension);
  return out;
}

}  // namespace dismantle
