#include "dismantle/push_search/verification.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dismantle/geometry/numerics.h"
#include "dismantle/search/candidates.h"

namespace dismantle::push {
namespace {

bool same_path(const Path& a, const Path& b) {
  const double same = std::sqrt(geometry::kRounding);  // repeated simulations differ by rounding only
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i)
      if ((a[k][i].t - b[k][i].t).norm() > same || angle_between(a[k][i].q, b[k][i].q) > same) return false;
  return true;
}

}  // namespace

/// The same path, thinned, with clearance between the parts wherever possible: parts that drive each other stay in
/// contact along the whole path, which is hard to verify. The first and the last instant do not change.
Path Verification::with_room(const Path& rubbing, const Work& work) const {
  const std::vector<path::Ball>& bodies = problem_.bodies;
  Path path = path::thin(rubbing, bodies, problem_.touch_distance());
  for (std::size_t k = 1; k + 1 < path.size() && !work.used_up(); ++k) {
    State state = problem_.world->initial_state();
    for (std::size_t i = 0; i < bodies.size(); ++i) state.bodies[i].pose = path[k][i];
    problem_.give_room(state);
    for (std::size_t i = 0; i < bodies.size(); ++i) path[k][i] = state.bodies[i].pose;
  }
  return path;
}

RunEnd Verification::show(const Path& whole, unsigned depth, const Work& work, PathResult& result) {
  Path path = path::thin(whole, problem_.bodies, problem_.thinning());
  for (const Path& refused : refusals_)
    if (same_path(refused, path)) return RunEnd::blocked;  // the world could not learn from the earlier refusal
  std::uint64_t refused_forms = 0;
  PathCheck first;
  const auto form = [&](std::size_t k) -> std::optional<Path> {
    if (k == 0) return path;
    return k == 1 && problem_.independent() ? std::optional(with_room(path, work)) : std::nullopt;
  };
  const auto learn_first = [&](const PathCheck& check, const Path&) {
    if (refused_forms == 1) first = check;  // the second form is not the path of these states any more
    return true;
  };
  const auto accept = [&](VerifiedPath verified) { result.solve(std::move(verified), depth); };
  if (path::show_forms(problem_.query.checker, refused_forms, form, learn_first, accept).accepted)
    return RunEnd::solved;
  ++refused_;
  refusals_.push_back(std::move(path));
  result.message = first.reason;
  if (!first.has_witness) return RunEnd::refused;
  learn({first.part, first.other, first.point});
  return RunEnd::refused_learned;
}

void Verification::learn(const path::ContactSample& sample) {
  problem_.world->add_contact_sample(sample.part, sample.other, sample.point);
  samples_.push_back(sample);
}

}  // namespace dismantle::push
