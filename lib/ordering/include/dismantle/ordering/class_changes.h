/// How often the class of the steps has to change in any order.
#pragma once

#include <cstddef>
#include <functional>

#include "dismantle/ordering/order_search.h"

namespace dismantle::order {

/// No order of the task (not of End::target) has fewer pairs of steps in a row whose variants are of different classes.
/// Among the orders that take the classes in a given row, one is best that takes out all that a class can before it
/// changes, since units that have left block nothing. So rows of classes are searched, by their length; `effort` is
/// spent on sets from which one class takes all that it can. Where it does not suffice, the number is that of the
/// lengths that are refuted; it does not hold if Problem::may_leave() takes what is not known for an obstacle.
std::size_t least_class_changes(Problem& problem, const Task& task,
                                const std::function<std::size_t(VariantId)>& class_of, Effort& effort);

}  // namespace dismantle::order
