#include "state_based/translate_out.h"

namespace dismantle::state_based {

blocking::Result TranslateOut::apply(GroupState& group) {
  const Subassemblies ids = state_.preferred(group, group.members);
  for (const SubassemblyId id : ids) {
    if (state_.stop()) break;
    if (!state_.is_single(id) || !state_.may_leave(group, {id})) continue;
    while (const auto waypoints = states_.path_out(group, id)) {
      if (propose(group, id, *waypoints)) return blocking::Result::restart;
      states_.refuse(id);
    }
  }
  return blocking::Result::unchanged;
}

bool TranslateOut::propose(GroupState& group, SubassemblyId id, const std::vector<Eigen::Vector3d>& waypoints) {
  const Attempt attempt = state_.attempt_for(group, {id});
  const PlacedPart& part = attempt.moving.front();
  Path path;
  for (const Eigen::Vector3d& t : waypoints) path.push_back({Pose{part.pose.t + t, part.pose.q}});
  state_.show_progress(part.part);
  const AttemptResult& answer = oracle_.propose(attempt, path, state_.context());
  if (!is_success(answer.result.outcome())) {
    state_.set_failure(
        {part.part, answer.result.outcome(), answer.result.blocked_by, {}, answer.result.message, answer.certificate});
    return false;
  }
  state_.commit(group, {id}, attempt, answer, blocking::GroupChange::Kind::removed);
  state_.count(waypoints.size() == 2 ? "straight" : "translations");
  return true;
}

}  // namespace dismantle::state_based
