/// The search trees that a trial has kept, as data and as pictures.
#pragma once

#include <cstdint>
#include <filesystem>

#include "store/sqlite.h"

namespace dismantle::bench {

/// Writes `search_trees.json` and `search_trees.html` to `folder` if the trial has kept any.
void write_search_trees(Sqlite& db, std::int64_t trial, const std::filesystem::path& folder);

}  // namespace dismantle::bench
