// Where no straight motion exists: slides that leave parts part-way, and the path planner.
#include <algorithm>
#include <cmath>
#include <string>

#include "blocking/taking_apart.h"

namespace dismantle::blocking {
namespace {

constexpr std::size_t kRefusals = 12;  // of the judge, before the slides are given up
// Pairs of edges that the first search for slides may look at (seconds), and how many times more each later one.
constexpr double kFirstWork = 5e8, kMoreWork = 4;
constexpr unsigned kDepthWithoutSlides = 4;
constexpr unsigned kDeepForPair = 4;  // levels searched in vain, after which a proof comes before a search without end
constexpr double kCostOctaves = 0.5;  // searches whose costs differ by less come in the order of use
constexpr std::size_t kTouchedMost = 3;  // parts, without one of which a search of depth 2 or more is made again

double sum_of(const std::map<std::string, double>& counts, const std::string& name) {
  double sum = 0;
  for (const auto& [counted, value] : counts)
    if (counted.ends_with(name)) sum += value;
  return sum;
}

bool translated_only(const Pose& p) { return p.q.vec().cwiseAbs().maxCoeff() == 0; }

}  // namespace

/// Moves `units` by a translation and leaves them there. `answer`: the judge's, kept or refused.
bool TakingApart::shift(Group& group, const std::vector<UnitId>& units, const Eigen::Vector3d& by,
                        const AttemptResult*& answer) {
  Attempt attempt = question(group, units);
  attempt.part_way = true;
  Path way(2);
  for (const auto& p : attempt.moving) {
    way[0].push_back(p.pose);
    way[1].push_back({p.pose.t + by, p.pose.q});
  }
  answer = &oracle_.propose(attempt, way, context_);
  if (!is_success(answer->result.outcome)) return false;
  const bool groups_done = group.groups_done;
  book(group, units, attempt, *answer);
  group.groups_done = groups_done;
  ++counts_["shifts"];
  return true;
}

/// Slides found by the search over places of all parts, as far as the judge lets them.
bool TakingApart::slide(Group& group) {
  if (std::any_of(group.units.begin(), group.units.end(),
                  [&](UnitId u) { return units_[u].size() > 1 || !translated_only(poses_[units_[u].front()]); }))
    return false;
  const std::vector<PartId> parts = parts_of(group.units);
  if (context_.threads > 1) seek_cages(group);
  for (std::size_t refusals = 0; refusals < kRefusals && !stop(); ++refusals) {
    Places places;
    for (const PartId id : parts) places[id] = poses_[id].t;
    const double work = kFirstWork * std::pow(kMoreWork, group.depth - 1);
    const SlideSearch::Answer found =
        slides_.search(places, static_cast<std::size_t>(params_.slide_states), work, context_);
    group.slides_cut = found.end == SlideSearch::End::too_long;
    group.no_slides = found.end == SlideSearch::End::exhausted;
    counts_["slide_states"] += static_cast<double>(found.states);
    if (found.end == SlideSearch::End::exhausted)
      group.slides_said =
          std::to_string(found.states) +
          " arrangements can be reached by straight slides between places where faces are flush, and in none "
          "of them a part or group is free";
    if (found.end == SlideSearch::End::limit || found.end == SlideSearch::End::too_long)
      group.slides_said =
          "slides that leave parts part-way were given up after " + std::to_string(found.states) + " arrangements";
    if (found.end != SlideSearch::End::found) return false;
    group.slides_said.clear();
    bool refused = false;
    for (const Slide& slide : found.slides) {
      // The rest may move just as well: for the user it is the smaller part that does.
      std::vector<UnitId> units;
      for (const PartId id : slide.parts) units.push_back(unit_of_[id]);
      Eigen::Vector3d direction = slide.direction;
      std::vector<UnitId> rest;
      for (const UnitId u : group.units)
        if (std::find(units.begin(), units.end(), u) == units.end()) rest.push_back(u);
      if (rest.size() < units.size() || (!may_leave(group, units) && may_leave(group, rest))) {
        std::swap(units, rest);
        direction = -direction;
      }
      const AttemptResult* answer = nullptr;
      if (std::isinf(slide.way)) {
        if (!may_leave(group, units)) return false;
        const auto same = [&](const Eigen::Vector3d& d) { return d.dot(direction) > 1 - 1e-9; };
        const auto known = std::find_if(directions_.all.begin(), directions_.all.end(), same);
        if (known == directions_.all.end()) return false;
        if (leave(group, units, static_cast<std::size_t>(known - directions_.all.begin()))) return true;
        refused = true;
      } else if (!shift(group, units, slide.way * direction, answer)) {
        refused = true;
      }
      if (!refused) continue;
      const std::vector<PartId> moving = parts_of(units);
      for (const PartId m : moving)
        for (const PartId s : parts)
          if (!std::binary_search(moving.begin(), moving.end(), s) &&
              (answer == nullptr || answer->result.blocked_by.empty() || answer->result.blocked_by.front() == s))
            slides_.forbid(m, s, poses_[m].t - poses_[s].t, direction);
      break;
    }
  }
  return false;
}

/// A search that failed is not repeated as deep as it was while those that it touched are all still there, or, where
/// it was dear, those that it touched most: it would most likely fail again. Most likely, not certainly (the hulls of
/// what stays count too), so before anything is given up all searches are made once more for the group as it is then.
bool TakingApart::worth_trying(const Group& group, UnitId unit, unsigned depth) const {
  const auto known = tried_.find(units_[unit].front());
  if (known == tried_.end()) return true;
  const Tried& last = known->second;
  const std::size_t count = last.blocked_by.size(), asked = last.depth > 1 ? std::min(count, kTouchedMost) : count;
  const bool room = std::any_of(last.blocked_by.begin(), last.blocked_by.begin() + static_cast<std::ptrdiff_t>(asked),
                                [&](PartId b) { return !in_group(group, unit_of_[b]); });
  if (room) return true;
  return wants_depth(unit) && last.depth < depth;
}

/// Did its last search end for want of depth? Or with a proof that it and another hold each other as assembled: that
/// one takes it into account when its turn comes.
bool TakingApart::wants_depth(UnitId unit) const {
  const auto known = tried_.find(units_[unit].front());
  if (known == tried_.end()) return false;
  const Certificate* proof = known->second.answer != nullptr ? known->second.answer->certificate : nullptr;
  return known->second.outcome == Outcome::depth_limit ||
         (known->second.outcome == Outcome::infeasible && proof != nullptr && proof->poses.empty());
}

void TakingApart::note_waiting(Group& group, const std::vector<UnitId>& units) const {
  group.waiting.clear();
  std::copy_if(units.begin(), units.end(), std::back_inserter(group.waiting), [&](UnitId u) { return wants_depth(u); });
}

/// Goes on from what the last search for a way of this part has reached, unless the part has been moved since, and with
/// it its group: whoever stands still now stood there then, and fewer parts are in the way of the same states.
Attempt TakingApart::search_question(const Group& group, UnitId unit, unsigned depth) const {
  Attempt attempt = question(group, {unit});
  attempt.max_depth = depth;
  attempt.keep_reached = true;
  const PartId part = units_[unit].front();
  const auto last = tried_.find(part);
  const auto same = [](const Pose& a, const Pose& b) { return a.t == b.t && a.q.coeffs() == b.q.coeffs(); };
  if (last == tried_.end() || !same(last->second.pose, poses_[part])) return attempt;
  const bool once_more = last->second.depth == depth && last->second.group_size == group.units.size();
  attempt.after = once_more ? last->second.after : last->second.answer;  // the same question has the same answer
  return attempt;
}

bool TakingApart::attempt(Group& group, UnitId unit, unsigned depth, const std::vector<UnitId>& next) {
  const Attempt question_now = search_question(group, unit, depth);
  const PartId part = units_[unit].front();
  context_.progress("sequence", out_, units_.size() - 1, assembly_.parts[part].name);
  if (context_.threads > 1) prefetch(group, question_now, next);
  const AttemptResult& answer = oracle_.attempt(question_now, context_);
  const PathResult& result = answer.result;
  const double known = sum_of(result.counts, "resumed_nodes"), spared = sum_of(result.counts, "spared");
  std::string line = "search for a way of '" + assembly_.parts[part].name + "' to depth " + std::to_string(depth) +
                     ": " + std::string(to_string(result.outcome)) + ", " + std::to_string(answer.seconds) + " s";
  if (known > 0)
    line += ", from " + std::to_string(std::llround(known)) + " states known, " + std::to_string(std::llround(spared)) +
            " steps and looks spared";
  context_.log(LogLevel::debug, line);
  if (known > 0) {
    ++counts_["resumed"];
    counts_["spared_steps"] += spared;
  }
  if (is_success(result.outcome)) {
    if (context_.threads > 1) drop_hints_if_in(group, question_now);
    const unsigned reached = group.depth;
    book(group, {unit}, question_now, answer);
    group.depth = reached;
    ++counts_["searched"];
    return true;
  }
  if (!stop() || !said_.contains(part))
    said_[part] =
        Unsolved{part, result.outcome, result.blocked_by, result.best_pose, result.message, answer.certificate};
  tried_[part] = {depth,   result.outcome, result.blocked_by, group.units.size(),
                  &answer, poses_[part],   question_now.after};
  cost_[part] = cost_of(part, result);
  return false;
}

/// The unit with the largest box.
TakingApart::UnitId TakingApart::housing_of(const Group& group) const {
  double largest = 0;
  UnitId housing = group.units.front();
  for (const UnitId u : group.units) {
    Aabb box;
    for (const PartId id : units_[u]) box.extend(assembly_.parts[id].mesh->box());
    if (box.empty() || box.size().prod() <= largest) continue;
    largest = box.size().prod();
    housing = u;
  }
  return housing;
}

/// Those whose leaving would open ways for others come first, the housing of it all last: searches are expensive, and a
/// success makes many of them needless. A unit's use is the sum of its shares in what holds others the least.
void TakingApart::sort_by_use(const Group& group, std::vector<UnitId>& units) {
  if (!relations_) return;
  std::map<UnitId, double> use;
  const UnitId housing = housing_of(group);
  for (const UnitId u : group.units) {
    std::vector<UnitId> fewest;
    bool found = false;
    for (const std::size_t d : directions_.common) {
      const std::vector<UnitId> in_way = in_way_of(group, u, d);
      if (stop()) return;
      if (!found || in_way.size() < fewest.size()) fewest = in_way;
      found = true;
    }
    for (const UnitId other : fewest) use[other] += 1.0 / static_cast<double>(fewest.size());
  }
  std::stable_sort(units.begin(), units.end(), [&](UnitId a, UnitId b) {
    if ((a == housing) != (b == housing)) return b == housing;
    return use[a] > use[b];
  });
}

/// Steps of simulation, and looks at poses, take the longer the more triangles there are to touch. Counts, not seconds:
/// these are the same everywhere.
int TakingApart::cost_of(PartId part, const PathResult& result) const {
  double work = 1;
  for (const auto& [name, count] : result.counts)
    if (name.ends_with("steps") || name.ends_with("looks")) work += count;
  work *= static_cast<double>(assembly_.parts[part].mesh->triangles.size());
  return static_cast<int>(std::log2(std::max(1.0, work)) / kCostOctaves);
}

/// What was cheap to search a little is mostly cheap to search a little more, and whoever leaves makes room for those
/// that are not. What was searched as deep before, in vain, comes last: more of what was in its way may be out by then.
void TakingApart::cheap_first(std::vector<UnitId>& units, unsigned depth) const {
  const auto cost = [&](UnitId u) {
    const auto known = cost_.find(units_[u].front());
    return known == cost_.end() ? 0 : known->second;
  };
  const auto again = [&](UnitId u) {
    const auto known = tried_.find(units_[u].front());
    return known != tried_.end() && known->second.depth >= depth;
  };
  std::stable_sort(units.begin(), units.end(),
                   [&](UnitId a, UnitId b) { return again(a) != again(b) ? again(b) : cost(a) < cost(b); });
}

/// Single parts that may leave, most useful first.
std::vector<TakingApart::UnitId> TakingApart::searchable(const Group& group) {
  std::vector<UnitId> single;
  for (const UnitId u : group.units)
    if (units_[u].size() == 1 && may_leave(group, {u})) single.push_back(u);
  sort_by_use(group, single);
  return single;
}

/// Where all arrangements were seen it takes more than slides, if it can be done at all: deep searches, which are for
/// ways of many slides, have nothing to find.
unsigned TakingApart::deepest(const Group& group) const {
  return group.no_slides ? std::min(kDepthWithoutSlides, params_.max_depth) : params_.max_depth;
}

/// Until one leaves, or turns out to be held.
bool TakingApart::attempt_all(Group& group, const std::vector<UnitId>& units, unsigned depth) {
  for (std::size_t k = 0; k < units.size() && !stop(); ++k)
    if (join_flat(group, units[k]) ||
        attempt(group, units[k], depth, {units.begin() + static_cast<std::ptrdiff_t>(k) + 1, units.end()}))
      return true;
  return false;
}

/// One round of Algorithm 2: every part a little; the next time a little more.
bool TakingApart::search(Group& group) {
  const std::vector<UnitId> single = searchable(group);
  std::vector<UnitId> list;
  for (const UnitId u : single) {
    if (worth_trying(group, u, group.depth))
      list.push_back(u);
    else
      ++counts_["postponed"];
  }
  cheap_first(list, group.depth);
  if (attempt_all(group, list, group.depth)) return true;
  note_waiting(group, single);
  const bool deeper = !group.waiting.empty();
  const unsigned most = deepest(group);
  const bool more_slides = group.slides_cut && group.units.size() > 2 && group.depth < params_.max_depth;
  const bool pair = group.units.size() == 2 && !close_to_proof(group);
  if (!more_slides && (!deeper || group.depth >= most || pair)) {
    group.searched_out = true;
  } else {
    ++group.depth;
    group.slides_done = group.slides_done && !group.slides_cut;
  }
  return false;
}

/// Of the deepest search for a way of one of its parts, as things are.
unsigned TakingApart::depth_tried(const Group& group) const {
  unsigned depth = 0;
  for (const UnitId u : group.units)
    if (const auto known = tried_.find(units_[u].front()); known != tried_.end())
      depth = std::max(depth, known->second.depth);
  return depth;
}

/// Twice that of the last search for the ways of two parts, or 0, no limit: where no others wait, or it is very deep.
unsigned TakingApart::next_depth_of_pair(const Group& group, bool others_wait) const {
  return others_wait && group.pair_depth < kDeepestPair ? 2 * group.pair_depth : 0;
}

/// The ways of two parts that are left. After deep searches in vain one without limit most likely takes all the time
/// that it may, and a proof that the two hold each other mostly seconds: that comes first.
bool TakingApart::search_pair(Group& group, bool others_wait) {
  const unsigned depth = next_depth_of_pair(group, others_wait);
  const bool without_end = depth == 0;
  if (without_end && depth_tried(group) >= kDeepForPair && relations_ && params_.cages && join_confined(group))
    return true;
  if (!without_end) group.pair_depth = depth;
  const std::vector<UnitId> list = searchable(group);
  std::vector<UnitId> open;
  std::copy_if(list.begin(), list.end(), std::back_inserter(open),
               [&](UnitId u) { return !tried_.contains(units_[u].front()) || wants_depth(u); });
  if (attempt_all(group, open, depth)) return true;
  if (stop()) return false;
  note_waiting(group, list);
  group.pair_done =
      without_end || std::none_of(group.units.begin(), group.units.end(), [&](UnitId u) { return wants_depth(u); });
  return false;
}

/// What was put off is made up for, with the group as it is now.
bool TakingApart::make_up_for(Group& group) {
  std::vector<UnitId> list;
  for (const UnitId u : searchable(group)) {
    const auto known = tried_.find(units_[u].front());
    if (known == tried_.end() || known->second.group_size != group.units.size()) list.push_back(u);
  }
  return attempt_all(group, list, group.depth);
}

}  // namespace dismantle::blocking
