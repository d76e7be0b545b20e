#include "dismantle/session/products.h"

#include "importers.h"

namespace dismantle {

Products products_in(const std::filesystem::path& folder, const Session& session) {
  return products_in(folder, importers_of(session.registry(), import_params_of(session.config(), session.registry())));
}

}  // namespace dismantle
