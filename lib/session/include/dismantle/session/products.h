/// A folder of products, each of which is an assembly of its own.
#pragma once

#include <filesystem>

#include "dismantle/export.h"
#include "dismantle/preparation/products.h"
#include "dismantle/session/session.h"

namespace dismantle {

/// The products that the importers of the session can read. Throws as the other products_in().
DISMANTLE_API Products products_in(const std::filesystem::path& folder, const Session& session);

}  // namespace dismantle
