/// Curves as SVG.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// Success over time, logarithmic in time, with a legend. `style`: for a standalone picture; empty: the page has it.
std::string svg_of(const std::vector<Curve>& curves, const std::string& style = "");

/// Colour of the i-th line, safe for red-green colour blindness. From the ninth line on, dashes distinguish the lines.
std::string colour_of(std::size_t i);

}  // namespace dismantle::bench
