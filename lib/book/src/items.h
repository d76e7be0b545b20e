/// What a book counts as one item: parts of one shape, or a product that is kept together.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content.h"

namespace dismantle {

/// Indices into BookContent::items.
struct ItemNumbers {
  std::vector<std::optional<std::size_t>> of_part;  ///< by part; none: it has no item of its own
  std::map<std::string, std::size_t> of_component;
};

/// Fills the items of a content that has its chapters, what it does not list, and the numbers of the parts. `items`: by
/// part, of bill_items().
ItemNumbers find_items(BookContent& content, const Plan& plan, const Assembly& assembly,
                       const std::vector<std::size_t>& items, const TextUnit& unit);

/// Names in a sentence; of many, the first.
std::string listed_names(std::vector<std::string> names);
/// `box`: input units.
std::string size_text(Eigen::Vector3d box, const TextUnit& unit);

}  // namespace dismantle
