#include "group_oracle.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "dismantle/aabb.h"

namespace dismantle {

namespace {

std::shared_ptr<const Mesh> placed(const std::shared_ptr<const Mesh>& mesh, const Pose& pose) {
  if (!mesh || pose.is_identity()) return mesh;
  auto moved = std::make_shared<Mesh>(*mesh);
  for (Eigen::Vector3d& v : moved->vertices) v = pose * v;
  return moved;
}

/// Converts an accepted path to the same motion of renumbered parts in the group's frame; it stays accepted.
class Renamed final : public PathChecker {
 public:
  PathCheck check(const Path&) const override {
    throw std::logic_error("a path of another assembly cannot be checked");
  }
  VerifiedPath rename(Path poses, const VerifiedPath& path, std::optional<PartId> released) const {
    return accept(std::move(poses), path.max_penetration(), released);
  }
};

Assembly assembly_of(const Assembly& whole, const std::vector<PlacedPart>& group) {
  Assembly out;
  out.source = whole.source;
  out.sha256 = whole.sha256;
  out.normalization = whole.normalization;
  out.repair = whole.repair;
  out.import_params = whole.import_params;
  out.unit = whole.unit;
  out.input_box = whole.input_box;
  for (const PlacedPart& p : group) {
    Part part = whole.parts.at(p.part);
    part.id = static_cast<PartId>(out.parts.size());
    part.mesh = placed(part.mesh, p.pose);
    part.surface = placed(part.surface, p.pose);
    out.parts.push_back(std::move(part));
  }
  for (std::size_t a = 0; a < group.size(); ++a)
    for (std::size_t b = a + 1; b < group.size(); ++b)
      if (const InitialOverlap* known = whole.overlap_of(group[a].part, group[b].part); known != nullptr) {
        // The place is in the frame of the whole assembly; the group may have been moved since.
        out.overlaps.push_back({static_cast<PartId>(a), static_cast<PartId>(b), known->depth, {}, known->allowed()});
      }
  return out;
}

}  // namespace

GroupOracle::GroupOracle(const Assembly& whole, PathOracle& oracle, std::vector<PlacedPart> group, unsigned most_depth)
    : oracle_(oracle),
      group_(std::move(group)),
      most_depth_(most_depth),
      assembly_(assembly_of(whole, group_)),
      constraints_(constraints_of_group(oracle.constraints())),
      known_(group_.size()) {
  if (most_depth == 0) throw std::invalid_argument("searches need a depth");
  for (std::size_t i = 0; i < group_.size(); ++i) {
    if (i > 0 && group_[i].part <= group_[i - 1].part) throw std::invalid_argument("a group is sorted by part");
    moved_.push_back(!group_[i].pose.is_identity());
    known_[i].emplace_back(Pose{}, group_[i].pose);
  }
}

std::optional<PartId> GroupOracle::local(PartId whole) const {
  const auto at =
      std::lower_bound(group_.begin(), group_.end(), whole, [](const PlacedPart& p, PartId id) { return p.part < id; });
  if (at == group_.end() || at->part != whole) return std::nullopt;
  return static_cast<PartId>(at - group_.begin());
}

std::vector<PartId> GroupOracle::to_local(const std::vector<PartId>& parts) const {
  std::vector<PartId> list;
  for (const PartId id : parts)
    if (const auto here = local(id)) list.push_back(*here);
  return list;
}

Constraints GroupOracle::constraints_of_group(const Constraints& all) const {
  Constraints own;
  own.base = to_local(all.base);
  for (const auto& list : all.together)
    if (auto here = to_local(list); here.size() > 1) own.together.push_back(std::move(here));
  for (const auto& [first, then] : all.before)
    if (const auto a = local(first), b = local(then); a && b) own.before.emplace_back(*a, *b);
  if (all.target) own.target = local(*all.target);
  return own;
}

Pose GroupOracle::to_whole(PartId part, const Pose& pose) const {
  for (const Known& k : known_.at(part))
    if (k.first == pose) return k.second;
  return moved_[part] ? pose * group_[part].pose : pose;
}

Pose GroupOracle::to_local(PartId part, const Pose& pose) {
  if (!moved_[part]) return pose;
  for (const Known& k : known_.at(part))
    if (k.second == pose) return k.first;
  return pose * group_[part].pose.inverse();
}

Attempt GroupOracle::to_whole(const Attempt& attempt) const {
  Attempt out;
  for (const PlacedPart& p : attempt.moving) out.moving.push_back({group_.at(p.part).part, to_whole(p.part, p.pose)});
  for (const PlacedPart& p : attempt.fixed) out.fixed.push_back({group_.at(p.part).part, to_whole(p.part, p.pose)});
  out.max_depth = attempt.max_depth == 0 ? most_depth_ : std::min(attempt.max_depth, most_depth_);
  out.goal.placement = attempt.goal.placement;
  for (const PartId id : attempt.goal.any_of) out.goal.any_of.push_back(group_.at(id).part);
  out.resume = attempt.resume;
  return out;
}

const AttemptResult& GroupOracle::keep(const AttemptResult& answer) {
  if (const auto known = local_of_.find(&answer); known != local_of_.end()) return *known->second;
  AttemptResult& own = results_.emplace_back(answer);
  const auto place = [&](std::vector<PlacedPart>& parts) {
    for (PlacedPart& p : parts) {
      p.part = local(p.part).value();
      p.pose = to_local(p.part, p.pose);
    }
  };
  place(own.attempt.moving);
  place(own.attempt.fixed);
  own.attempt.goal.any_of = to_local(answer.attempt.goal.any_of);
  own.result.blocked_by = to_local(answer.result.blocked_by);
  for (std::size_t i = 0; i < own.result.best_pose.size() && i < own.attempt.moving.size(); ++i)
    own.result.best_pose[i] = to_local(own.attempt.moving[i].part, own.result.best_pose[i]);
  if (answer.out) own.out = local(*answer.out);
  if (const auto& path = answer.result.path()) {
    Path poses = path->poses();
    for (std::size_t i = 0; i < own.attempt.moving.size(); ++i) {
      const PartId part = own.attempt.moving[i].part;
      for (auto& instant : poses) instant[i] = to_local(part, instant[i]);
      if (moved_[part]) known_[part].emplace_back(poses.back()[i], path->poses().back()[i]);
    }
    std::optional<PartId> released;
    if (path->released()) released = local(*path->released());
    const VerifiedPath renamed = Renamed().rename(std::move(poses), *path, released);
    if (answer.result.outcome() == Outcome::start_is_goal)
      own.result.start_is_goal(renamed);
    else
      own.result.solve(renamed, answer.result.depth);
  }
  if (answer.certificate != nullptr) {
    Certificate& proof = certificates_.emplace_back(*answer.certificate);
    proof.parts = to_local(proof.parts);
    if (proof.parts.size() != answer.certificate->parts.size())
      throw std::logic_error("a proof about parts that are not in the question");
    own.certificate = &proof;
  }
  local_of_[&answer] = &own;
  whole_of_[&own] = &answer;
  return own;
}

Removal GroupOracle::in_whole(const Removal& removal) const {
  const auto known = whole_of_.find(removal.attempt);
  if (known == whole_of_.end()) throw std::logic_error("a removal that is not an answer of the oracle");
  Removal out{{}, known->second};
  for (const PartId id : removal.parts) {
    if (id >= group_.size()) throw std::logic_error("a removal of an unknown part");
    out.parts.push_back(group_[id].part);
  }
  return out;
}

const AttemptResult& GroupOracle::attempt(const Attempt& attempt, RunContext& context) {
  return keep(oracle_.attempt(to_whole(attempt), context));
}

void GroupOracle::prefetch(std::span<const Attempt> attempts, RunContext& context) {
  std::vector<Attempt> all;
  for (const Attempt& a : attempts) all.push_back(to_whole(a));
  oracle_.prefetch(all, context);
}

const AttemptResult& GroupOracle::propose(const Attempt& attempt, const Path& path, RunContext& context) {
  Path poses = path;
  for (auto& instant : poses) {
    if (instant.size() != attempt.moving.size())
      throw std::invalid_argument("a path has a column for each moving part");
    for (std::size_t i = 0; i < instant.size(); ++i) instant[i] = to_whole(attempt.moving[i].part, instant[i]);
  }
  return keep(oracle_.propose(to_whole(attempt), poses, context));
}

const Certificate* GroupOracle::prove(const SeparationQuestion& question, const RunContext& context) {
  SeparationQuestion asked = question;
  for (PartId& id : asked.parts) {
    if (id >= group_.size() || moved_[id]) return nullptr;
    id = group_[id].part;
  }
  const Certificate* found = oracle_.prove(asked, context);
  if (found == nullptr) return nullptr;
  const std::lock_guard lock(proof_mutex_);
  const Certificate*& own = proof_of_[found];
  if (own == nullptr) {
    Certificate& proof = proofs_.emplace_back(*found);
    proof.parts = to_local(proof.parts);
    own = &proof;
  }
  return own;
}

}  // namespace dismantle
