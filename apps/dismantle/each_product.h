/// `dismantle plan --each FOLDER`: every product of a folder planned by itself, in a process of its own.
#pragma once

#include <string>
#include <vector>

#include "console.h"
#include "dismantle/session/session.h"

namespace dismantle::app {

struct EachProduct {
  std::string folder, output;
  unsigned jobs = 1;
  std::vector<std::string> options;  ///< of `plan`, for every product
};

/// Plans into `output`/NAME, and writes `output`/summary.csv after each product. Returns the exit status: 0 all are
/// complete, 1 not so, 130 interrupted. @throws InputError when the folder holds no product; Error.
int plan_each(const EachProduct& each, const Session& session, Console& console);

}  // namespace dismantle::app
