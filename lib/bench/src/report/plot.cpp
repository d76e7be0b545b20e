#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/plan_io/markup.h"

namespace dismantle::bench {
namespace {

/// Maps seconds and shares to coordinates of the picture.
struct Axes {
  double first = 0.1, last = 10;                          // seconds
  double left = 56, top = 16, width = 640, height = 320;  // of the plot area, pixels; the labels need the margins
  double legend = 20;                                     // height of a line of the legend, pixels
  double x(double seconds) const {
    const double t = std::clamp(seconds, first, last);
    return left + width * std::log(t / first) / std::log(last / first);
  }
  double y(double share) const { return top + height * (1 - share); }
};

Axes axes_of(const std::vector<Curve>& curves) {
  double least = 1e9, most = 0;
  for (const auto& curve : curves) {
    if (!curve.steps.empty()) least = std::min(least, curve.steps.front().first);
    most = std::max(most, curve.end);
  }
  most = std::max(most, 1e-3);
  least = std::clamp(least, 1e-3, most);
  Axes axes;
  axes.first = std::pow(10, std::floor(std::log10(least)));
  axes.last = std::max(most, 2 * axes.first);
  return axes;
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' class='{}'/>\n", x1, y1, x2, y2, style);
}

std::string grid(const Axes& axes, const std::string& unit) {
  std::string out;
  for (int percent = 0; percent <= 100; percent += 20) {
    const double y = axes.y(percent / 100.0);
    out += line(axes.left, y, axes.left + axes.width, y, "grid");
    out += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}%</text>\n", axes.left - 6, y + 4, percent);
  }
  for (double t = axes.first; t <= axes.last; t *= 10) {
    out += line(axes.x(t), axes.top, axes.x(t), axes.top + axes.height, "grid");
    out += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{:g}{}</text>\n", axes.x(t),
                       axes.top + axes.height + 18, t, unit);
  }
  return out;
}

std::string path_of(const Curve& curve, const Axes& axes) {
  std::string d = fmt::format("M{:.1f} {:.1f}", axes.x(0), axes.y(0));
  for (const auto& [seconds, share] : curve.steps) d += fmt::format("H{:.1f}V{:.1f}", axes.x(seconds), axes.y(share));
  return d + fmt::format("H{:.1f}", axes.x(curve.end));
}

}  // namespace

std::string colour_of(std::size_t i) {
  static const char* const colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                        "#b8860b", "#56b4e9", "#6a3d9a", "#666666"};
  return colours[i % std::size(colours)];
}

std::string svg_of(const std::vector<Curve>& curves, const std::string& style, const Axis& axis) {
  const Axes axes = axes_of(curves);
  const double width = axes.left + axes.width + 24,
               height = axes.top + axes.height + 40 + axes.legend * double(curves.size());
  std::string out = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' role='img' "
      "aria-label='{2}'>\n",
      width, height, escaped_markup(axis.what));
  if (!style.empty())
    out +=
        fmt::format("<style>{}</style>\n<rect width='{:.0f}' height='{:.0f}' class='page'/>\n", style, width, height);
  out += grid(axes, axis.unit);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string look = fmt::format("stroke='{}'{}", colour_of(i), i >= 8 ? " stroke-dasharray='6 4'" : "");
    const double share = curves[i].steps.empty() ? 0 : curves[i].steps.back().second;
    const std::string label = fmt::format("{}: {:.1f} % after {:.3g}{}", escaped_markup(curves[i].label), 100 * share,
                                          curves[i].end, axis.unit);
    out +=
        fmt::format("<path d='{}' class='curve' {}><title>{}</title></path>\n", path_of(curves[i], axes), look, label);
    const double y = axes.top + axes.height + 44 + axes.legend * double(i);
    out += fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' class='curve' {}/>\n", axes.left, y,
                       axes.left + 28, y, look);
    out += fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>\n", axes.left + 36, y + 4, label);
  }
  return out + "</svg>\n";
}

std::string report_svg(const ReportData& data) {
  return svg_of(curves_of(data),
                "text { font: 12px sans-serif; fill: #222 } .page { fill: #fff } .grid { stroke: #ccc } "
                ".curve { fill: none; stroke-width: 2.2 }");
}

}  // namespace dismantle::bench
