#include "path_length.h"

#include <fmt/format.h>

#include <algorithm>

namespace dismantle::checks {

StepVerdict PathLength::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.path == nullptr || question.assembly.input_box.empty()) return verdict;
  const double size = question.assembly.input_box.size().maxCoeff() * question.assembly.normalization.scale;
  if (!(size > 0)) return verdict;
  double longest = 0;
  for (std::size_t column = 0; column < question.moving.size(); ++column) {
    const Eigen::Vector3d middle = question.assembly.parts.at(question.moving[column].part).mesh->box().center();
    double length = 0;
    for (std::size_t k = 1; k < question.path->size(); ++k)
      length += ((*question.path)[k][column] * middle - (*question.path)[k - 1][column] * middle).norm();
    longest = std::max(longest, length);
  }
  verdict.cost = longest / size;
  if (verdict.cost > 0) verdict.reason = fmt::format("the way in is {:.2f} times the size of the assembly", verdict.cost);
  return verdict;
}

}  // namespace dismantle::checks
