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

/// Moves the parts at each instant but the first and the last off each other, wherever there is room: a part that moves
/// alone to the middle of it, parts that drive each other by the tolerance.
Path Verification::with_room(Path path, const Work& work) const {
  const std::vector<path::Ball>& bodies = problem_.bodies;
  for (std::size_t k = 1; k + 1 < path.size() && !work.used_up(); ++k) {
    State state = problem_.world->initial_state();
    for (std::size_t i = 0; i < bodies.size(); ++i) state.bodies[i].pose = path[k][i];
    if (problem_.independent())
      problem_.move_off_contacts(state);
    else
      problem_.give_room(state);
    for (std::size_t i = 0; i < bodies.size(); ++i) path[k][i] = state.bodies[i].pose;
  }
  return path;
}

/// The k-th form, from 1 on, of a path on which parts drive each other, and so stay in contact all the way. Each
/// refusal tells the world of a contact that it did not see, and the next form keeps off that, too, also at the instant
/// of the refusal. Ends when a form is refused again as it was, or after `max_refusals` forms. The path of a part that
/// moves alone has one: in the middle of its play. The search goes on from what the world learned of it.
std::optional<Path> Verification::next_form(const Path& whole, std::size_t k, const Work& work,
                                            const Refused& last) const {
  const auto refusals = static_cast<std::size_t>(problem_.tactics.max_refusals);
  if (k > (problem_.independent() ? refusals : std::min<std::size_t>(refusals, 1))) return std::nullopt;
  if (k == 1) {
    Path path = path::thin(whole, problem_.bodies, problem_.touch_distance()), with = with_room(path, work);
    if (!problem_.independent() && same_path(with, path)) return std::nullopt;  // it touched nothing
    return with;
  }
  const auto after = static_cast<std::ptrdiff_t>(last.check.instant) + 1;
  Path next = last.path;
  if (last.check.poses.size() == problem_.bodies.size() && last.check.instant + 1 < next.size())
    next.insert(next.begin() + after, last.check.poses);
  next = path::thin(with_room(std::move(next), work), problem_.bodies, geometry::kRounding);
  if (same_path(next, last.path)) return std::nullopt;
  return next;
}

RunEnd Verification::show(const Path& whole, unsigned depth, const Work& work, PathResult& result) {
  Path path = path::thin(whole, problem_.bodies, problem_.thinning());
  for (const Path& refused : refusals_)
    if (same_path(refused, path)) return RunEnd::blocked;  // the world could not learn from the earlier refusal
  std::uint64_t refused_forms = 0;
  std::string reason;
  bool learned = false;
  Refused last;
  const auto form = [&](std::size_t k) { return k == 0 ? std::optional(path) : next_form(whole, k, work, last); };
  const auto learn_from = [&](const PathCheck& check, const Path& refused) {
    if (refused_forms == 1) reason = check.reason;
    if (!check.has_witness) return refused_forms == 1;
    learn({check.part, check.other, check.point});
    last = {refused, check};
    return learned = true;
  };
  const auto accept = [&](VerifiedPath verified) { result.solve(std::move(verified), depth); };
  if (path::show_forms(problem_.query.checker, refused_forms, form, learn_from, accept).accepted) return RunEnd::solved;
  ++refused_;
  refusals_.push_back(std::move(path));
  result.message = reason;
  return learned ? RunEnd::refused_learned : RunEnd::refused;
}

void Verification::learn(const path::ContactSample& sample) {
  problem_.world->add_contact_sample(sample.part, sample.other, sample.point);
  samples_.push_back(sample);
}

}  // namespace dismantle::push
