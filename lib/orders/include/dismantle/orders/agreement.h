/// How much two orders agree.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dismantle/export.h"
#include "dismantle/orders/order.h"

namespace dismantle {

/// Kendall's tau-b (Kendall 1945) of two rankings of the same items, in [-1, 1]; equal values are ties. None: one of
/// them ties all items.
DISMANTLE_API std::optional<double> kendall_tau_b(std::span<const double> a, std::span<const double> b);

struct Agreement {
  std::optional<double> tau;  ///< of the parts that both orders have
  std::size_t common = 0;     ///< number of these parts
};

/// Parts of one step are ties. Equal parts can stand for each other: the k-th of a class in one order is the k-th of it
/// in the other, which gives the largest tau.
DISMANTLE_API Agreement agreement_of(const Order& a, const Order& b, const PartClasses& classes);

}  // namespace dismantle
