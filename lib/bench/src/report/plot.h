/// Curves as SVG.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// Success over time, logarithmic in time, with a legend. `style`: for a picture that stands alone; empty: the page has it.
std::string svg_of(const std::vector<Curve>& curves, const std::string& style = "");

/// Colour of the i-th line; told apart by people who do not see red and green, and by dashes from the ninth on.
std::string colour_of(std::size_t i);

}  // namespace dismantle::bench
