/// The pages before and after those of the steps.
#pragma once

#include "content_basis.h"

namespace dismantle {

/// Fills the title, the table of contents, the list of fasteners and tools and the account of what was checked, of a
/// content that has its items and pages.
void write_front_matter(BookContent& content, const ContentBasis& basis);

}  // namespace dismantle
