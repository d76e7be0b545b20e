#include "dismantle/tolerant_walk/walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/path/touched.h"

namespace dismantle::tolerant_walk {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kLongestFlight = 400;     // steps
constexpr double kFaster = 1.15;        // each step of a flight is so much longer than the last ...
constexpr double kFastest = 10;         // ... up to so many times the first
constexpr double kOutward = 0.7;        // share of the steps from what is furthest out that lead further
constexpr double kStraight = 0.15;      // ... and of those the ones that do nothing else
constexpr double kOctaves = 2;          // between the largest and the smallest steps
constexpr double kRecent = 0.2;         // share of the steps from the newest nodes
constexpr std::uint64_t kNewest = 200;  // nodes
constexpr double kAskEvery = 0.05;      // assembly units from the start: whether it is out
constexpr double kLookEvery = 0.02;     // assembly units, along a shortcut
constexpr double kTurn = 0.2;           // rad between the instants of a path
constexpr double kInstants = 0.25;      // assembly units, likewise
constexpr int kRepairs = 4;             // tries to shorten the same way, after it has been learned where it cuts

const std::array<Vec3, 26>& directions() {
  static const std::array<Vec3, 26> all = [] {
    std::array<Vec3, 26> list;
    std::size_t n = 0;
    for (int k = 0; k < 27; ++k)
      if (k != 13) list[n++] = Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized();
    return list;
  }();
  return all;
}

}  // namespace

Walk::Walk(const Parameters& parameters, const PathQuery& query, RunContext& context)
    : parameters_(parameters),
      query_(query),
      context_(context),
      deadline_(query.effort.timeout > 0 ? context.deadline.earlier(Deadline::after_seconds(query.effort.timeout))
                                         : context.deadline),
      rng_(context.rng.fork(0x5c9ee2e)),
      world_(query.simulator.world(query.assembly, query.prepared, query.cast, MotionSpace::rigid)),
      tolerance_(query.assembly, query.cast, parameters.max_penetration) {
  const std::size_t count = query.cast.moving.size();
  for (std::size_t i = 0; i < count; ++i) {
    bodies_.push_back({world_->center(i), world_->radius(i)});
    center_ += query.cast.moving[i].pose * bodies_[i].center / static_cast<double>(count);
  }
  for (std::size_t i = 0; i < count; ++i)
    radius_ = std::max(radius_, (query.cast.moving[i].pose * bodies_[i].center - center_).norm() + bodies_[i].radius);
  nodes_.push_back({Pose{}, center_});
}

bool Walk::halted() const { return context_.cancel.cancelled() || deadline_.passed(); }

std::vector<Pose> Walk::poses(const Pose& displacement) const {
  std::vector<Pose> list;
  for (const auto& m : query_.cast.moving) {
    Pose p = displacement * m.pose;
    p.q.normalize();
    list.push_back(p);
  }
  return list;
}

State Walk::state(const Pose& displacement) const {
  State s = world_->initial_state();
  const std::vector<Pose> list = poses(displacement);
  for (std::size_t i = 0; i < list.size(); ++i) s.bodies[i].pose = list[i];
  return s;
}

bool Walk::allowed(const Pose& displacement) {
  ++looks_;
  if (tolerance_.allows(displacement)) return true;
  ++touched_[*tolerance_.in_way()];
  return false;
}

/// Bound of the way of each point of the moving parts.
double Walk::distance(const Pose& a, const Pose& b) const {
  return (a * center_ - b * center_).norm() + radius_ * angle_between(a.q, b.q);
}

std::uint32_t Walk::add(const Pose& pose, std::uint32_t parent) {
  const auto id = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({pose, pose * center_, parent});
  for (std::size_t d = 0; d < furthest_.size(); ++d)
    if (directions()[d].dot(nodes_[id].center) > directions()[d].dot(nodes_[furthest_[d]].center)) furthest_[d] = id;
  return id;
}

/// Where to go on, and how.
std::uint32_t Walk::choose(Step& step) {
  const auto in_cube = [&] { return Vec3(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
  const double kind = rng_.uniform();
  const std::uint64_t count = nodes_.size();
  Vec3 outward = Vec3::Zero();
  std::uint64_t from = 0;
  if (kind < parameters_.outward) {
    const auto d = static_cast<std::size_t>(rng_.below(furthest_.size()));
    from = furthest_[d];
    if (rng_.uniform() < kOutward) outward = 1.5 * rng_.uniform() * directions()[d];
  } else if (kind < parameters_.outward + kRecent * (1 - parameters_.outward)) {
    from = count - 1 - rng_.below(std::min(count, kNewest));
  } else {
    from = rng_.below(count);
  }
  // Narrow places ask for small steps.
  const double size = parameters_.step * std::exp2(-kOctaves * rng_.uniform());
  const bool straight = !outward.isZero() && rng_.uniform() < kStraight;
  step.way = size * (straight ? outward : Vec3(outward + rng_.uniform() * in_cube()));
  step.turn = straight ? Vec3(Vec3::Zero()) : Vec3(size / radius_ * in_cube());
  return static_cast<std::uint32_t>(from);
}

/// The same step again and again, longer and longer, while nothing is in the way.
bool Walk::fly(PathResult& result) {
  Step step;
  std::uint32_t at = choose(step);
  if (nodes_[at].cut) return false;
  const double length = std::max(step.way.norm(), radius_ * step.turn.norm());
  const double fastest = kFastest * parameters_.step / std::max(length, 1e-12);
  double faster = 1;
  for (int k = 0; k < kLongestFlight && !halted(); ++k) {
    const Vec3 turn = faster * step.turn;
    const Eigen::Quaterniond q = turn.isZero() ? Eigen::Quaterniond::Identity()
                                               : Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    Pose next;
    next.q = (q * nodes_[at].pose.q).normalized();
    next.t = nodes_[at].center + faster * step.way - next.q * center_;
    if (!allowed(next)) {
      if (k == 0 || faster <= 1) break;
      faster = 1;  // perhaps it was only too fast
      continue;
    }
    at = add(next, at);
    if (out(at)) return judged(at, result);
    faster = std::min(fastest, kFaster * faster);
  }
  return false;
}

bool Walk::out(std::uint32_t node) {
  const double far = (nodes_[node].center - center_).norm();
  if (far < looked_at_ + kAskEvery) return false;
  looked_at_ = far;
  return world_->separated(state(nodes_[node].pose));
}

std::vector<std::uint32_t> Walk::chain_to(std::uint32_t node) const {
  std::vector<std::uint32_t> chain{node};
  while (chain.back() != 0) chain.push_back(nodes_[chain.back()].parent);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

/// Coarse looks first: most motions that are not allowed show it in the middle.
bool Walk::straight(const Pose& a, const Pose& b) {
  int pieces = 2;
  while (pieces * kLookEvery < distance(a, b)) pieces *= 2;
  for (int apart = pieces / 2; apart > 0; apart /= 2)
    for (int i = apart; i < pieces; i += 2 * apart)
      if (halted() || !allowed(screw_interpolate(a, b, static_cast<double>(i) / pieces))) return false;
  return true;
}

std::vector<Pose> Walk::shortened(std::vector<Pose> way) {
  for (std::int64_t k = 0; k < parameters_.shortcuts && way.size() > 2 && !halted(); ++k) {
    auto a = static_cast<std::size_t>(rng_.below(way.size())), b = static_cast<std::size_t>(rng_.below(way.size()));
    if (a > b) std::swap(a, b);
    if (b - a < 2 || !straight(way[a], way[b])) continue;
    way.erase(way.begin() + static_cast<std::ptrdiff_t>(a) + 1, way.begin() + static_cast<std::ptrdiff_t>(b));
  }
  return way;
}

Path Walk::path_of(const std::vector<Pose>& way) const {
  Path path{poses(way.front())};
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double pieces_of_turn = angle_between(way[k - 1].q, way[k].q) / kTurn,
                 pieces_of_way = distance(way[k - 1], way[k]) / kInstants;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::max(pieces_of_turn, pieces_of_way))));
    for (int i = 1; i <= pieces; ++i)
      path.push_back(poses(screw_interpolate(way[k - 1], way[k], static_cast<double>(i) / pieces)));
  }
  return path::thin(path, bodies_, parameters_.thinning);
}

/// True when the judge accepts a way to the node; then `result` holds it.
bool Walk::judged(std::uint32_t node, PathResult& result) {
  looked_at_ = 0;
  const std::vector<std::uint32_t> chain = chain_to(node);
  std::vector<Pose> way;
  for (const std::uint32_t n : chain) way.push_back(nodes_[n].pose);
  Pose at_fault = way.back();
  for (int round = 0; round <= kRepairs && !halted() && refused_ < static_cast<std::uint64_t>(parameters_.max_refusals);
       ++round) {
    const std::vector<Pose> shorter = shortened(way);
    Path path = path_of(shorter);
    const Verdict verdict = query_.judge(path);
    if (verdict.accepted) {
      result.outcome = Outcome::solved;
      result.depth = static_cast<unsigned>(shorter.size() - 1);
      result.path = std::move(path);
      result.message.clear();
      return true;
    }
    ++refused_;
    result.message = verdict.reason;
    if (!verdict.has_witness) break;
    tolerance_.learn(verdict.part, verdict.other, verdict.point);
    const auto& instant = path[std::min(verdict.instant, path.size() - 1)];
    at_fault = instant[0] * query_.cast.moving[0].pose.inverse();
    // What was learned may rule out some of the way itself.
    if (!std::all_of(way.begin() + 1, way.end(), [&](const Pose& p) { return halted() || allowed(p); })) break;
  }
  if (!halted()) cut(chain, at_fault);
  return false;
}

/// Gives up the first node of the way that is not allowed any more, or the one nearest to where the judge saw a fault,
/// and what grew from it.
void Walk::cut(const std::vector<std::uint32_t>& chain, const Pose& near) {
  std::uint32_t first = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < chain.size(); ++k) {
    if (!allowed(nodes_[chain[k]].pose)) {
      first = chain[k];
      break;
    }
    if (const double d = distance(nodes_[chain[k]].pose, near); d < least) least = d, first = chain[k];
  }
  if (first == kNone) return;
  nodes_[first].cut = true;
  furthest_.fill(0);
  for (std::uint32_t n = 1; n < nodes_.size(); ++n) {  // children come after their parents
    nodes_[n].cut = nodes_[n].cut || nodes_[nodes_[n].parent].cut;
    if (nodes_[n].cut) continue;
    for (std::size_t d = 0; d < furthest_.size(); ++d)
      if (directions()[d].dot(nodes_[n].center) > directions()[d].dot(nodes_[furthest_[d]].center)) furthest_[d] = n;
  }
}

PathResult Walk::run(std::uint64_t most_looks) {
  PathResult result;
  if (world_->separated(state(Pose{}))) {
    result.outcome = Outcome::start_is_goal;
    result.path = {poses(Pose{}), poses(Pose{})};
    return result;
  }
  if (query_.effort.max_steps > 0) most_looks = std::min(most_looks, query_.effort.max_steps);
  const auto given_up = [&] { return refused_ >= static_cast<std::uint64_t>(parameters_.max_refusals); };
  bool solved = false;
  while (!solved && looks_ < most_looks && !halted() && !given_up()) solved = fly(result);
  if (!solved) {
    result.outcome = context_.cancel.cancelled()                                        ? Outcome::cancelled
                     : deadline_.passed()                                               ? Outcome::timeout
                     : given_up()                                                       ? Outcome::exhausted
                     : query_.effort.max_steps > 0 && looks_ >= query_.effort.max_steps ? Outcome::timeout
                                                                                        : Outcome::depth_limit;
    std::uint32_t best = 0;
    for (const std::uint32_t n : furthest_)
      if ((nodes_[n].center - center_).norm() > (nodes_[best].center - center_).norm()) best = n;
    result.best_pose = poses(nodes_[best].pose);
  }
  finish(result);
  return result;
}

void Walk::finish(PathResult& result) const {
  result.counts = {{"nodes", static_cast<double>(nodes_.size())},
                   {"looks", static_cast<double>(looks_)},
                   {"refused", static_cast<double>(refused_)}};
  result.blocked_by = path::most_touched(touched_, query_.cast.moving);
}

}  // namespace dismantle::tolerant_walk
