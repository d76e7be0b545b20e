#include "dismantle/tools/access.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arcs.h"
#include "frame.h"

namespace dismantle::tools {
namespace {

Eigen::Vector3d direction_at(const Use& use, const Fastener& fastener, double angle) {
  const Frame frame(use, fastener);
  return std::cos(angle) * frame.axes.col(0) + std::sin(angle) * frame.axes.col(1);
}

/// Begin of the swing in the middle of the largest range without a blocked angle.
std::optional<double> largest_room(const Arcs& blocked, double swing) {
  if (blocked.empty()) return 0;
  double widest = 0, start = 0;
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    const double from = blocked[i].second;
    const double to = i + 1 < blocked.size() ? blocked[i + 1].first : blocked.front().first + kTurn;
    if (to - from > widest) widest = to - from, start = (from + to - swing) / 2;
  }
  if (!(widest > 0) || widest < swing) return std::nullopt;
  return std::fmod(start + kTurn, kTurn);
}

bool meets(const Arcs& arcs, double from, double to) {
  const auto within = [&](double shift) {
    return std::any_of(arcs.begin(), arcs.end(),
                       [&](const auto& arc) { return arc.first + shift < to && from < arc.second + shift; });
  };
  return within(0) || within(kTurn) || within(-kTurn);
}

/// The fewest obstacles that some swing meets. The set changes only where a swing begins at the end of an arc, or ends
/// at the begin of one.
std::vector<std::size_t> fewest(std::span<const Arcs* const> blocked, double swing) {
  const double turn = std::min(swing, kTurn);
  std::vector<double> starts{0};
  for (const Arcs* arcs : blocked)
    for (const auto& arc : *arcs) {
      starts.push_back(arc.second);
      starts.push_back(arc.first - turn);
    }
  std::vector<std::size_t> best, now;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    now.clear();
    const double slack = 1e-12;  // also a swing of zero has a length
    for (std::size_t i = 0; i < blocked.size(); ++i) {
      if (meets(*blocked[i], starts[k] + slack, starts[k] + std::max(turn - slack, 2 * slack))) now.push_back(i);
      if (k > 0 && now.size() >= best.size()) break;
    }
    if (k == 0 || now.size() < best.size()) best = now;
  }
  return best;
}

}  // namespace

bool fits(const Tool& tool, const Fastener& fastener) {
  return std::any_of(tool.fits.begin(), tool.fits.end(), [&](const Fit& fit) {
    const bool what = fit.drive ? *fit.drive == fastener.drive : fit.kind == fastener.kind;
    return what && fit.least <= fastener.size && fastener.size <= fit.most;
  });
}

Access room_for(const Use& use, const Fastener& fastener, std::span<const Arcs* const> blocked) {
  Access out;
  out.use = &use;
  Arcs all;
  for (const Arcs* arcs : blocked) all.insert(all.end(), arcs->begin(), arcs->end());
  if (const auto start = largest_room(joined(std::move(all)), use.swing)) {
    out.start = *start;
    out.handle = direction_at(use, fastener, *start + use.swing / 2);
    return out;
  }
  out.obstacles = fewest(blocked, use.swing);
  return out;
}

Access find_access(const Tool& tool, const Fastener& fastener, std::span<const Obstacle> present, bool hand) {
  Access best;
  for (const Use& use : tool.uses) {
    std::vector<Arcs> arcs;
    for (const Obstacle& obstacle : present) arcs.push_back(blocked_angles(use, fastener, obstacle, hand));
    std::vector<const Arcs*> blocked;
    for (const Arcs& a : arcs) blocked.push_back(&a);
    Access access = room_for(use, fastener, blocked);
    if (access.reaches()) return access;
    if (best.use == nullptr || access.obstacles.size() < best.obstacles.size()) best = std::move(access);
  }
  return best;
}

}  // namespace dismantle::tools
