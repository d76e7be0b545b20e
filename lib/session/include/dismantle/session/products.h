/// A folder of products, each of which is an assembly of its own.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "dismantle/export.h"
#include "dismantle/preparation/products.h"
#include "dismantle/session/session.h"

namespace dismantle {

/// The products that the importers of the session can read. Throws as the other products_in().
DISMANTLE_API Products products_in(const std::filesystem::path& folder, const Session& session);

/// Extensions of the files that the importers of the session can read, in lower case, without the dot.
DISMANTLE_API std::set<std::string> readable_extensions(const Session& session);

}  // namespace dismantle
