/// Objects shared by several plugins, such as a cache of data computed from the same meshes.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dismantle/export.h"

namespace dismantle {

/// The object of that name in this process. `make` creates it when there is none; it is destroyed with its last
/// reference. All users of a name must be built with the same definition of its type. Safe to use from several threads.
DISMANTLE_API std::shared_ptr<void> shared_object(const std::string& name,
                                                  const std::function<std::shared_ptr<void>()>& make);

}  // namespace dismantle
