/// An order by what the checks say, not by their estimates.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "best_order/rewrite.h"

namespace dismantle::order {

/// Step by step: of the units that can leave, some that the estimates like best are judged, and the cheapest one
/// leaves; the first one that costs nothing ends the choice. All of it in each orientation, `ups`: OrderScene::ups.
/// Empty: no order, or none that is cheaper than `known` by what has been judged. `verdicts`: how many judgements there
/// may be.
std::vector<Step> by_verdict(std::vector<Block>& blocks, const std::vector<std::optional<Eigen::Vector3d>>& ups,
                             double known, std::uint64_t verdicts);

}  // namespace dismantle::order
