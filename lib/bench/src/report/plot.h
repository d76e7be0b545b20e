/// Curves as SVG.
#pragma once

#include <string>
#include <vector>

#include "dismantle/bench/report.h"

namespace dismantle::bench {

/// What the axes of a picture are.
struct Axis {
  std::string what = "Share of trials solved over time";
  std::string unit = " s";
};

/// Shares over time or effort, logarithmic in that, with a legend. `style`: for a standalone picture; empty: the page
/// has it.
std::string svg_of(const std::vector<Curve>& curves, const std::string& style = "", const Axis& axis = {});

/// Colour of the i-th line, safe for red-green colour blindness. From the ninth line on, dashes distinguish the lines.
std::string colour_of(std::size_t i);

}  // namespace dismantle::bench
