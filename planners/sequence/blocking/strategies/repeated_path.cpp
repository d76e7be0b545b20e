#include "blocking/strategies/repeated_path.h"

#include <algorithm>
#include <limits>
#include <string>

#include "dismantle/geometry/congruence.h"

namespace dismantle::blocking {

namespace {

/// Unit vector along which a part with this box advances: along the axis if it rotates more than it translates, as a
/// screw does; otherwise as the centre of the box moves. Zero for no motion.
Eigen::Vector3d direction_of(const Pose& from, const Pose& to, const Aabb& box) {
  const Eigen::Vector3d offset_by = to * box.center() - from * box.center();
  const Eigen::Vector3d turn = rotation_vector(to.q * from.q.conjugate());
  if (0.5 * box.size().norm() * turn.norm() < offset_by.norm()) return offset_by.stableNormalized();
  return (turn.dot(offset_by) * turn).stableNormalized();
}

}  // namespace

/// Paths of two poses are not kept: they are straight, or a rotation that a search finds in its first steps.
void RepeatedPath::on_group_changed(GroupState&, const GroupChange& change) {
  if (proposes_ || change.kind != GroupChange::Kind::removed) return;
  const Removal& removal = state_.removals().back();
  if (removal.parts.size() == 1 && removal.attempt->result.path()->poses().size() > 2)
    known_.push_back({removal.parts.front(), removal.attempt});
}

Result RepeatedPath::apply(GroupState& group) {
  for (std::size_t k = 0; k < known_.size(); ++k)
    for (const SubassemblyId id : Subassemblies(group.members)) {
      if (state_.stop()) return Result::unchanged;
      const PartId part = state_.part_of(id);
      if (!state_.is_single(id) || !state_.may_leave(group, {id}) || is_refused(group, k, part)) continue;
      if (refusals_[part] < params_.repeated_refusals && propose(group, k, id)) return Result::restart;
    }
  return Result::unchanged;
}

/// A refusal is valid while one of the parts that blocked the path is in the group, or if these are not known.
bool RepeatedPath::is_refused(const GroupState& group, std::size_t known, PartId part) const {
  const auto refusal = refused_.find({known, part});
  return refusal != refused_.end() &&
         (refusal->second.empty() || std::any_of(refusal->second.begin(), refusal->second.end(), [&](PartId blocker) {
            return group.contains(state_.subassembly_of(blocker));
          }));
}

/// Copies that were tessellated or scaled differently still have boxes of about the same size.
const std::optional<Pose>& RepeatedPath::displacement(PartId from, PartId to) {
  const auto [entry, is_new] = displacements_.try_emplace({from, to});
  if (!is_new) return entry->second;
  const Mesh &a = *state_.assembly().parts[from].mesh, &b = *state_.assembly().parts[to].mesh;
  entry->second = geometry::congruence(a, b, oracle_.tolerance());
  const double difference = (a.box().size() - b.box().size()).cwiseAbs().maxCoeff();
  if (!entry->second && difference < params_.repeated_similarity * a.box().size().norm())
    entry->second = Pose{b.box().center() - a.box().center(), Eigen::Quaterniond::Identity()};
  return entry->second;
}

/// Extends the path straight until the part is apart from all others, which may reach farther at the copy.
void RepeatedPath::extend(PartId part, const std::vector<PlacedPart>& others, Path& path) const {
  const Pose last = path.back().front();
  const Eigen::Vector3d direction =
      direction_of(path[path.size() - 2].front(), last, state_.assembly().parts[part].mesh->box());
  if (direction.isZero()) return;
  const auto extent = [&](const PlacedPart& placed, double sign) {  // the farthest corner along sign * direction
    double most = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& corner : sweep_.hull(placed.part))
      most = std::max(most, sign * direction.dot(placed.pose * corner));
    return most;
  };
  double most = 0;
  for (const PlacedPart& other : others) most = std::max(most, extent(other, 1) + extent({part, last}, -1));
  const double distance = sweep_.distance_apart({{part, last}}, others, direction, most);
  if (distance > 0) path.push_back({Pose{last.t + (distance + oracle_.tolerance()) * direction, last.q}});
}

bool RepeatedPath::propose(GroupState& group, std::size_t known, SubassemblyId id) {
  const PartId part = state_.part_of(id);
  const auto& to = displacement(known_[known].part, part);
  if (!to) {
    refused_[{known, part}] = {};
    return false;
  }
  Path path;
  for (const auto& instant : known_[known].answer->result.path()->poses())
    path.push_back({*to * instant.front() * to->inverse()});
  const Pose &first = path.front().front(), &here = state_.pose(part);
  const double reach = state_.assembly().parts[part].mesh->box().size().norm();
  if ((first.t - here.t).norm() + reach * angle_between(first.q, here.q) > oracle_.tolerance()) return false;
  path.front().front() = here;
  const Attempt attempt = state_.attempt_for(group, {id});
  extend(part, attempt.fixed, path);
  const AttemptResult& answer = oracle_.propose(attempt, path, state_.context());
  const auto& parts = state_.assembly().parts;
  state_.context().log(LogLevel::debug, "path of '" + parts[known_[known].part].name + "' proposed for '" +
                                            parts[part].name + "': " + std::string(to_string(answer.result.outcome())) +
                                            " " + answer.result.message);
  if (!is_success(answer.result.outcome())) {
    refused_[{known, part}] = answer.result.blocked_by;
    ++refusals_[part];
    return false;
  }
  proposes_ = true;
  state_.commit(group, {id}, attempt, answer, GroupChange::Kind::removed);
  proposes_ = false;
  state_.count("repeated");
  return true;
}

}  // namespace dismantle::blocking
