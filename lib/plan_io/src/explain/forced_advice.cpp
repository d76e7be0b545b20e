#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/motion_words.h"

namespace dismantle {
namespace {

/// A name in YAML, in single quotes.
std::string quoted(const std::string& name) {
  std::string out = "'";
  for (const char c : name) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

/// Two digits, above `x`, so that the step is accepted as deep as it is.
std::string at_least(double x) {
  if (!(x > 0)) return "0";
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return fmt::format("{:.4g}", std::ceil(x / unit * 1.001) * unit);
}

}  // namespace

std::string reached_text(const Plan& plan, const TextUnit& unit, const PlanStep& step) {
  if (!step.forced || step.transfer == 0 || step.moves.empty()) return {};
  auto move = std::ranges::find(step.moves, step.forced->part, &PlanMove::part);
  if (move == step.moves.end()) move = step.moves.begin();
  const double size = plan.assembly.box.empty() ? 1 : plan.assembly.box.size().maxCoeff();
  const std::vector<Pose> path(move->poses.begin(),
                               move->poses.begin() + static_cast<std::ptrdiff_t>(step.transfer) + 1);
  const MotionSummary motion = summarize_motion(path, plan.assembly.center, 1e-3 * size);
  if (motion.length < 2e-3 * size && motion.turn < 1e-2) return move->part + " cuts in from the beginning";
  return fmt::format("{} comes {} without cutting in", move->part,
                     motion_words(in_unit(motion, unit.factor), unit.name, input_frame(plan).up));
}

std::string acceptance_line(const PlanForced& forced) {
  if (!forced.accepted.empty()) return {};
  return fmt::format("constraints: {{accept: [{{part: {}, against: {}, as: snap, depth: {}}}]}}", quoted(forced.part),
                     quoted(forced.other), at_least(forced.depth));
}

std::string forced_advice(const PlanForced& forced) {
  const std::string line = acceptance_line(forced);
  if (line.empty() || forced.reason.find(line) != std::string::npos) return {};
  return fmt::format("if the real parts allow it, accept the step with `{}`", line);
}

}  // namespace dismantle
