#include "store/version.h"

#include "commit.h"

namespace dismantle::bench {

std::string version_and_commit() {
  const std::string commit = DISMANTLE_COMMIT;
  return DISMANTLE_VERSION + (commit.empty() ? "" : " (" + commit + ")");
}

}  // namespace dismantle::bench
