#include "steps/fewer_poses.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace dismantle {
namespace {

constexpr std::size_t kStretches = 16;  // a long step keeps at least one pose of each such share of its poses
constexpr double kStraight = 1e-6;      // difference of displacements, of their length: not to be seen

/// Translations of all parts from pose `a` to pose `b`, below each other. Empty: a part turns, or none moves.
Eigen::VectorXd translations(const std::vector<PlanMove>& moves, std::size_t a, std::size_t b) {
  Eigen::VectorXd out(3 * static_cast<Eigen::Index>(moves.size()));
  for (std::size_t m = 0; m < moves.size(); ++m) {
    const Pose &from = moves[m].poses[a], &to = moves[m].poses[b];
    if (from.q.coeffs() != to.q.coeffs()) return {};
    out.segment<3>(3 * static_cast<Eigen::Index>(m)) = to.t - from.t;
  }
  if (out.isZero(0)) return {};
  return out;
}

}  // namespace

std::vector<std::size_t> leave_out_poses(PlanStep& step) {
  const std::size_t count = step.moves.empty() ? 0 : step.moves.front().poses.size();
  const bool same_count = std::all_of(step.moves.begin(), step.moves.end(),
                                      [&](const PlanMove& move) { return move.poses.size() == count; });
  std::vector<std::size_t> kept(count);
  std::iota(kept.begin(), kept.end(), 0U);
  if (step.forced || !same_count || count < 3) return kept;
  const std::size_t longest = std::max<std::size_t>(1, count / kStretches);
  kept = {0};
  Eigen::VectorXd first = translations(step.moves, 0, 1);  // of the stretch that begins at the last kept pose
  for (std::size_t k = 1; k + 1 < count; ++k) {
    const Eigen::VectorXd next = translations(step.moves, k, k + 1);
    const bool goes_on =
        first.size() > 0 && next.size() == first.size() && (next - first).norm() <= kStraight * first.norm();
    if (goes_on && k != step.transfer && k - kept.back() < longest) continue;
    kept.push_back(k);
    first = next;
  }
  kept.push_back(count - 1);
  step.transfer = static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), step.transfer) - kept.begin());
  for (PlanMove& move : step.moves) {
    std::vector<Pose> poses;
    poses.reserve(kept.size());
    for (const std::size_t k : kept) poses.push_back(move.poses[k]);
    move.poses = std::move(poses);
  }
  return kept;
}

PlanStep drawn_step(const PlanStep& step) {
  PlanStep drawn;
  drawn.step = step.step;
  drawn.moves = step.moves;
  drawn.transfer = step.transfer;
  drawn.up = step.up;
  drawn.forced = step.forced;
  leave_out_poses(drawn);
  return drawn;
}

}  // namespace dismantle
