/// Parameters as a plan file states them.
#pragma once

#include <vector>

#include "dismantle/parameters.h"

namespace dismantle {

/// A plan file may store a number without a fraction as an integer.
inline ParamSet with_numbers(const std::vector<ParamSpec>& specs, ParamSet values) {
  for (const auto& spec : specs)
    if (const auto it = values.find(spec.name); it != values.end() && spec.type == ParamType::number)
      if (const auto* integer = std::get_if<std::int64_t>(&it->second)) it->second = static_cast<double>(*integer);
  return values;
}

}  // namespace dismantle
