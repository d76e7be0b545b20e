#include "dismantle/free_space/led_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/path/growing_turns.h"

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr std::size_t kPoints = 24;               // of all bodies together
constexpr std::size_t kCorners = 3;               // of these tell where a body is and how it is turned
constexpr double kPlace = 0.12;                   // assembly units: edge of a place, at least ...
constexpr double kPlaceOfBody = 0.15;             // ... and of the body's radius
constexpr std::size_t kKept = 8;                  // nodes of a place
constexpr double kVisit = 0.02;                   // assembly units: so much further off does each
                                                  // visit make a place look
constexpr unsigned kInTheWall = 2;                // cells: a point that is deeper in what is not free has no way
constexpr double kMostPoints = 0.5;               // share of the points that has to have a way
constexpr double kDetour = 2;                     // of the body's radius: how far ahead the way is
                                                  // closed where it got stuck ...
constexpr double kNear = 0.2;                     // ... and assembly units
constexpr double kWorthIt = 0.15;                 // share of the way, or ...
constexpr double kOfBody = 2;                     // ... so often the body's radius, without which nothing more is tried
constexpr double kDistances = 1000;               // of a look that counts as one ...
constexpr double kLeast = 0.25;                   // ... and what one counts at least
constexpr double kMostOfPatience = 12;            // what a walk that gets on may take, by what it may without progress
constexpr std::uint64_t kFirst = 100;             // looks, after which ...
constexpr double kHeld = 0.02;                    // ... what has not come so far (of the body's
                                                  // radius) is held where it is, ...
constexpr double kMoves = 0.05;                   // ... unless it is thin and so far away, in any direction
constexpr double kThrough = 0.5;                  // of a thin body's radius: an overlap that lets it pass through walls
constexpr double kAskEvery = 0.03;                // assembly units of the way: whether it is out
constexpr double kProgress = 0.05;                // likewise: less is none
constexpr int kLongestFlight = 200;               // steps
constexpr double kFaster = 1.25, kFastest = 10;   // as in tolerant_walk::Walk
constexpr double kOctaves = 3;                    // between the largest and the smallest first steps
constexpr double kSlip = 0.2, kBesideSlip = 0.1;  // share of flights along the
                                                  // body; how far these go aside
constexpr double kDownhill = 0.7;                 // share of the others that are led
constexpr double kTogether = 0.4;                 // ... in which all points lead alike, not those near one ...
constexpr double kNearest = 0.2;                  // ... (so near at least, of the body's radius) ...
constexpr double kOthers = 0.02;                  // ... and the others by so much
constexpr int kLongestAside = 20;                 // steps of a flight that is not led
constexpr std::array kShares{0.01, 0.25, 0.5, 1.0};  // of the points: the foremost ones, by rank
constexpr double kBest = 0.6;                        // share that begins where the place is least far

double ball_of(const std::vector<BodyPoint>& points) {
  std::vector<double> radii;
  for (const auto& p : points) radii.push_back(p.radius);
  if (radii.empty()) return 0;
  const auto quarter = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 4);
  std::nth_element(radii.begin(), quarter, radii.end());
  return *quarter;
}

std::vector<BodyPoint> points_of(const PathQuery& query) {
  std::vector<BodyPoint> all;
  const std::size_t each = std::max<std::size_t>(4, kPoints / query.scene.moving.size());
  for (const auto& m : query.scene.moving)
    for (BodyPoint p : body_points(*query.assembly.parts[m.part].mesh, each)) {
      p.center = m.pose * p.center;
      all.push_back(p);
    }
  return all;
}

}  // namespace

bool overlaps_through(const PathQuery& query) {
  double overlap = 0;
  for (const auto& m : query.scene.moving)
    for (const auto& s : query.scene.fixed) overlap = std::max(overlap, query.assembly.initial_overlap(m.part, s.part));
  return overlap > 0 && overlap > kThrough * ball_of(points_of(query));
}

LedWalk::LedWalk(const tolerant_walk::Parameters& parameters, const PathQuery& query, RunContext& context,
                 const Effort& effort, tolerant_walk::Overlap overlap, tolerant_walk::GeometryCache& cache)
    : parameters_(parameters),
      query_(query),
      rng_(context.rng.fork(0x1ed0a1c)),
      tree_(parameters_, query, context, rng_, overlap, cache),
      body_(points_of(query)),
      ways_(query.assembly, query.scene.fixed, ball_of(body_), effort.cells),
      leads_out_(have_ways()),
      thin_(overlap == tolerant_walk::Overlap::near_start),
      effort_(effort) {
  if (query.scene.moving.size() == 1) {
    const PlacedPart& m = query.scene.moving.front();
    for (const Twist& slip : slips(*query.assembly.parts[m.part].mesh, m.pose.inverse() * tree_.center()))
      slips_.push_back({m.pose.q * slip.way, m.pose.q * slip.turn});
  }
  place_size_ = std::max(kPlace, kPlaceOfBody * tree_.radius());
  if (const auto* reached = dynamic_cast<const PoseTree::Reached*>(query.resume_from);
      reached != nullptr && reached->has_room_now(query.scene)) {
    tree_.resume(*reached);
    resumed_ = true;
    for (std::uint32_t n = 0; n < tree_.size(); ++n) moves_ = moves_ || (!tree_[n].cut && clearly_off(n));
  }
  begin_again();
}

bool LedWalk::have_ways() const {
  const auto have = std::count_if(body_.begin(), body_.end(),
                                  [&](const BodyPoint& p) { return ways_.depth(p.center) <= kInTheWall; });
  return have > 0 && static_cast<double>(have) >= kMostPoints * static_cast<double>(body_.size());
}

/// With the nodes that there are, and the ways as they are now.
void LedWalk::begin_again() {
  place_of_.clear();
  places_.clear();
  for (auto& scores : by_score_) scores.clear();
  least_ = left(Pose{});
  best_left_ = asked_at_ = least_.back();
  best_ = 0;
  for (std::uint32_t n = 0; n < tree_.size(); ++n) {
    if (tree_[n].cut) continue;
    const Left to_go = left(tree_[n].pose);
    put(n, to_go);
    for (std::size_t r = 0; r < kRanks; ++r) least_[r] = std::min(least_[r], to_go[r]);
    if (to_go.back() < best_left_) best_left_ = to_go.back(), best_ = n;
  }
  progress_at_ = work();
}

/// A ball may pass where the body does not: the narrowest place ahead of where it has come is taken for closed.
bool LedWalk::detour() {
  if (!ways_.close_narrowest(tree_[best_].pose * tree_.center(), kDetour * tree_.radius() + kNear)) return false;
  leads_out_ = have_ways();
  if (leads_out_) begin_again();
  return leads_out_;
}

LedWalk::Left LedWalk::left(const Pose& pose) const {
  std::vector<double> lengths;
  for (const BodyPoint& p : body_) lengths.push_back(ways_.length(pose * p.center));
  std::sort(lengths.begin(), lengths.end());
  Left means{};
  double sum = 0;
  std::size_t rank = 0;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    sum += lengths[k];
    while (rank < kRanks && static_cast<double>(k + 1) >= kShares[rank] * static_cast<double>(lengths.size()))
      means[rank++] = sum / static_cast<double>(k + 1);
  }
  return means;
}

/// A look at a large body among many walls costs a hundred times what one at a small body in a room does.
double LedWalk::work() const {
  return std::max(kLeast * static_cast<double>(tree_.looks()), static_cast<double>(tree_.distances()) / kDistances);
}

double LedWalk::score(const Place& place, std::size_t rank) const {
  return place.left[rank] + kVisit * static_cast<double>(place.visits[rank]);
}

/// Among the poses of its place.
void LedWalk::put(std::uint32_t node, const Left& left) {
  Key key;
  for (std::size_t c = 0; c < std::min(kCorners, body_.size()); ++c) {  // the first are far from each other
    const Vec3 p = tree_[node].pose * body_[c].center / place_size_;
    for (int k = 0; k < 3; ++k) key.push_back(static_cast<std::int32_t>(std::floor(p[k])));
  }
  const auto [entry, is_new] = place_of_.try_emplace(key, static_cast<std::uint32_t>(places_.size()));
  const std::uint32_t id = entry->second;
  if (is_new) {
    Place place;
    place.left = left;
    place.first.fill(node);
    places_.push_back(std::move(place));
    for (std::size_t r = 0; r < kRanks; ++r) by_score_[r].insert({score(places_[id], r), id});
  }
  Place& place = places_[id];
  ++place.seen;
  for (std::size_t r = 0; r < kRanks; ++r) {
    if (!(left[r] < place.left[r])) continue;
    by_score_[r].erase({score(place, r), id});
    place.left[r] = left[r];
    place.first[r] = node;
    by_score_[r].insert({score(place, r), id});
  }
  if (place.nodes.size() < kKept)
    place.nodes.push_back(node);
  else if (const std::uint64_t at = rng_.below(place.seen); at < kKept)
    place.nodes[at] = node;
}

std::uint32_t LedWalk::choose() {
  const std::size_t rank = rng_.below(kRanks);
  const std::uint32_t id = by_score_[rank].begin()->second;
  by_score_[rank].erase(by_score_[rank].begin());
  Place& place = places_[id];
  ++place.visits[rank];
  by_score_[rank].insert({score(place, rank), id});
  return rng_.uniform() < kBest ? place.first[rank] : place.nodes[rng_.below(place.nodes.size())];
}

/// Who leads: all alike, or those near one of them.
std::vector<double> LedWalk::leaders() {
  std::vector<double> weights(body_.size(), 1);
  if (rng_.uniform() < kTogether) return weights;
  const Vec3 leader = body_[rng_.below(body_.size())].center;
  const double reach = tree_.radius() * rng_.uniform(kNearest, 1);
  for (std::size_t k = 0; k < body_.size(); ++k)
    weights[k] = kOthers + std::exp(-(body_[k].center - leader).squaredNorm() / (reach * reach));
  return weights;
}

/// Each point wants to go its way; the body goes as it can. Points move by about 1.
LedWalk::PoseTree::Step LedWalk::downhill(std::uint32_t node, const std::vector<double>& weights) const {
  std::vector<Vec3> at, wishes;
  for (const BodyPoint& p : body_) {
    at.push_back(tree_[node].pose * p.center);
    wishes.push_back((ways_.ahead(at.back()) - at.back()).normalized());
  }
  const Twist twist = closest_twist(at, wishes, weights, tree_[node].center);
  const double size = std::max(twist.way.norm() + tree_.radius() * twist.turn.norm(), 1e-12);
  return {twist.way / size, twist.turn / size};
}

/// Thin, and no more where it starts.
bool LedWalk::clearly_off(std::uint32_t node) const {
  return thin_ && (tree_[node].center - tree_.center()).norm() > kMoves * tree_.radius();
}

bool LedWalk::arrived(std::uint32_t node, const Left& left) {
  moves_ = moves_ || clearly_off(node);
  if (left.back() < best_left_) best_ = node, best_left_ = left.back();
  for (std::size_t r = 0; r < kRanks; ++r)
    if (left[r] < least_[r] - kProgress) {
      progress_at_ = work();
      least_[r] = left[r];
      tree_.note_progress();
    }
  if (left.back() > asked_at_ - kAskEvery) return false;
  asked_at_ = left.back();
  return tree_.separated(tree_[node].pose);
}

/// A motion of the body along itself, from a node. Points move by about 1.
LedWalk::PoseTree::Step LedWalk::along(std::uint32_t node, const Twist& slip) const {
  const Eigen::Quaterniond& q = tree_[node].pose.q;
  return {q * slip.way, q * slip.turn};
}

/// Steps downhill and a little aside, always the same; or only aside; or along
/// the body itself. Longer and longer while nothing is in the way.
bool LedWalk::fly() {
  std::uint32_t at = choose();
  if (tree_[at].cut) return false;
  const auto in_cube = [&] { return Vec3(rng_.uniform(-1, 1), rng_.uniform(-1, 1), rng_.uniform(-1, 1)); };
  // What is wound leaves a hole as a corkscrew does a cork.
  const Twist* slip = !slips_.empty() && rng_.uniform() < kSlip ? &slips_[rng_.below(slips_.size())] : nullptr;
  const double forward = slip != nullptr && rng_.uniform() < 0.5 ? -1 : 1;
  const bool led = slip == nullptr && rng_.uniform() < kDownhill;
  const std::vector<double> weights = leaders();
  const double size = parameters_.step * std::exp2(1 - kOctaves * rng_.uniform());
  const double beside = led ? rng_.uniform() * rng_.uniform() : slip != nullptr ? kBesideSlip * rng_.uniform() : 1;
  const double turning = rng_.uniform();
  const Vec3 way = beside * (1 - turning) * in_cube(), turn = beside * turning / tree_.radius() * in_cube();
  const int longest = led || slip != nullptr ? kLongestFlight : 1 + static_cast<int>(rng_.below(kLongestAside));
  const double fastest = kFastest * parameters_.step / size;
  double faster = 1;
  for (int k = 0; k < longest && !tree_.halted(); ++k) {
    PoseTree::Step step{way, turn};
    if (led) {
      const PoseTree::Step down = downhill(at, weights);
      step.way += down.way;
      step.turn += down.turn;
    }
    if (slip != nullptr) {
      const PoseTree::Step on = along(at, *slip);
      step.way += forward * on.way;
      step.turn += forward * on.turn;
    }
    const Pose next = tree_.after(at, step, faster * size);
    if (!tree_.allowed(next)) {
      if (k == 0 || faster <= 1) break;
      faster = 1;
      continue;
    }
    at = tree_.add(next, at);
    const Left to_go = left(next);
    put(at, to_go);
    if (arrived(at, to_go)) {
      if (tree_.verified(at, result_)) return true;
      begin_again();
      // Where the checker left nothing of the tree, there is everything to be
      // tried again.
      first_look_ = looks();
      first_work_ = work();
      return false;
    }
    faster = std::min(fastest, kFaster * faster);
  }
  return false;
}

/// Is more of the same not worth it? Takes a detour where that helps.
bool LedWalk::gives_up() {
  // What is held where it is has some play, too: it takes a good piece of the
  // way to be worth more checks.
  const bool play = !moves_ && at_first_.back() - best_left_ < kHeld * tree_.radius();
  held_ = held_ && play;
  if (looks() >= first_look_ + kFirst && play) return true;
  bool worth_it = moves_;  // what is threaded through somewhere has long come no further
  for (std::size_t r = 0; r < kRanks; ++r)
    worth_it = worth_it || at_first_[r] - least_[r] > std::min(kWorthIt * at_first_[r], kOfBody * tree_.radius());
  const bool stuck = work() >= progress_at_ + effort_.patience;
  if (!worth_it && (stuck || work() >= first_work_ + 2 * effort_.patience)) return true;
  return stuck && (++detours_ > effort_.detours || !detour());
}

SearchStatus LedWalk::run(const Budget& portion) {
  if (is_success(result_.outcome())) return SearchStatus::solved;
  const std::uint64_t most = query_.budget.max_steps > 0 ? query_.budget.max_steps : ~std::uint64_t{0};
  const std::uint64_t until = path::end_of_portion(looks(), portion.max_steps, most);
  const Deadline end = portion.timeout > 0 ? Deadline::after_seconds(portion.timeout) : Deadline();
  bool solved = false;
  if (!std::exchange(begun_, true)) {
    progress_at_ = work();
    at_first_ = left(Pose{});
    // What was in the way where an earlier walk had come may have left.
    if (resumed_ && leads_out_ && best_ != 0 && tree_.separated(tree_[best_].pose)) {
      solved = tree_.verified(best_, result_);
      if (!solved) begin_again();
    }
  }
  const auto over = [&] {
    return over_ || !leads_out_ || looks() >= most || work() >= kMostOfPatience * effort_.patience || tree_.halted() ||
           tree_.given_up();
  };
  while (!solved && looks() < until && !over() && !end.passed()) {
    solved = fly();
    over_ = !solved && gives_up();
  }
  if (!solved) tree_.explain(result_);
  if (!solved && !over()) return SearchStatus::paused;
  return status_of(result_.outcome());
}

PathResult LedWalk::result() {
  PathResult result = result_;
  tree_.finish(best_, result);
  result.stats.extra["detours"] = detours_;
  result.stats.extra["left"] = best_left_;
  return result;
}

}  // namespace dismantle::free_space
