/// The tables of a suite, as its database keeps them.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/suite.h"

namespace dismantle::bench {

std::string text_of(const std::vector<SuiteTable>& tables);
/// Of text_of(); empty text: none.
std::vector<SuiteTable> suite_tables_of(const std::string& text);

}  // namespace dismantle::bench
