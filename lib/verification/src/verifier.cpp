#include "dismantle/verification/verifier.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/hull.h"
#include "dismantle/geometry/motion_samples.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/overlap_region.h"
#include "dismantle/geometry/pair_check.h"
#include "dismantle/stop_if_asked.h"
#include "solid_motion.h"
#include "verifier_impl.h"

namespace dismantle {
namespace {

using Vec3 = Eigen::Vector3d;
using verify::Answer;
using verify::Finding;

/// Displacements of points of `box` below this length are rounding.
double rounding_of(const Aabb& box) {
  return geometry::kRounding * std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
}

std::uint64_t share_of(std::uint64_t count, double share) {
  return static_cast<std::uint64_t>(share * static_cast<double>(count));
}

}  // namespace

Violation Verifier::Impl::violation(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y,
                                    const Finding& found, double allowed, std::size_t segments) {
  Violation v;
  v.part = found.of_second ? b.part : a.part;
  v.other = found.of_second ? a.part : b.part;
  v.point = (found.of_second ? y.frame : x.frame) * found.point;
  v.depth = std::max(0.0, found.depth);
  v.allowed = allowed;
  v.segment = static_cast<std::size_t>(std::min(std::floor(found.time), static_cast<double>(segments) - 1));
  v.u = found.time - static_cast<double>(v.segment);
  v.uncertain = found.answer != Answer::violated;
  return v;
}

Verifier::Impl::Impl(const Assembly& a, VerifyOptions o, const RunContext& context)
    : assembly_overlaps(a.overlaps), options(o), bodies(a.parts.size()) {
  // From a hundredth of the tolerance, as for parts that slide on each other, in factors of about two. A tenth is worth
  // the whole budget: such a motion of parts that do not overlap is practically free of penetration.
  // The last is less than the tolerance by more than rounding: so much the poses of a reversed step may be off.
  for (const double divisor : {100., 50., 20., 10., 5., 2., 1 + 1e-7}) {
    if (divisor == 10) worthwhile = rungs.size();
    rungs.push_back(options.max_penetration / divisor);
  }
  for (const InitialOverlap& overlap : assembly_overlaps)
    if (const auto box = geometry::overlap_region(a, overlap, options.max_penetration))
      regions.push_back({overlap.a, overlap.b, *box});
  for (const auto& part : a.parts) meshes.push_back(part.mesh);
  const auto poll = [&] { stop_if_asked(context, "setting up the verifier"); };
  parallel_for(
      bodies.size(), context.executor.get(),
      [&](std::size_t i) {
        const Mesh& mesh = *meshes[i];
        Body body{verify::split_into_solids(mesh, poll), mesh.box(), hull_corners(mesh.vertices)};
        for (auto& solid : body.solids) solid.measure_thickness(4 * options.max_penetration, poll);
        bodies[i] = std::move(body);
      },
      [] { return false; });  // poll() throws
}

double Verifier::Impl::overlap(PartId a, PartId b) const {
  if (a > b) std::swap(a, b);
  for (const auto& o : assembly_overlaps)
    if (o.a == a && o.b == b) return o.allowed();
  return 0;
}

const Aabb* Verifier::Impl::region(PartId a, PartId b) const {
  if (a > b) std::swap(a, b);
  for (const Region& r : regions)
    if (r.a == a && r.b == b) return &r.box;
  return nullptr;
}

geometry::Budget Verifier::Impl::budget_for(std::size_t segments, bool decides, bool overlapping,
                                            const RunContext* context) const {
  const VerifyBudget& b = options.budget;
  // Deep overlaps need more patches: they are divided along the ridges of the buried surface.
  const std::uint64_t tests = b.tests + b.tests_per_segment * segments,
                      patches = (overlapping ? b.overlap_factor : 1) * b.patches;
  if (decides) return {tests, patches, 0, context, b.resolution};
  return {share_of(b.tests, b.trial_share), share_of(b.patches, b.trial_share), 0, context, b.resolution};
}

/// Checks pairs in order, each from the rung that the pairs before it have reached. Idle threads help within a pair,
/// since later pairs checked from too low a rung cost more time than they save. If all paths are straight, pairs are
/// first checked in parallel: they take little time, and mostly stay on the lowest rung.
void Verifier::Impl::check(const Pairs& pairs, const RunContext& context, MotionCheck& result) const {
  const auto straight = [](const Actor& actor) { return actor.poses.size() <= 2; };
  std::vector<PairResult> results(pairs.size());
  if (std::all_of(pairs.begin(), pairs.end(), [&](const auto& p) { return straight(*p.first) && straight(*p.second); }))
    results = check_pairs(pairs, context);
  std::size_t rung = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    PairResult& answer = results[k];
    if (!answer.done || answer.from != rung) answer = check_pair(pairs[k], rung, context);
    rung = answer.rung;
    result.tests += answer.found.tests;
    if (answer.passed) continue;
    result.violation = answer.found.violation;
    result.interrupted = answer.found.interrupted;
    return;
  }
  result.valid = true;
  result.max_penetration = rungs[rung];
}

auto Verifier::Impl::check_pair(const Pairs::value_type& pair, std::size_t rung, const RunContext& context) const
    -> PairResult {
  constexpr std::uint64_t kWorthKeeping = 4096;  // tests: some 10 ms
  const auto& [a, b] = pair;
  const PairMemory<PairResult>::Key key{a->part, b->part, rung, &a->poses, &b->poses};
  if (std::optional<PairResult> before = known.find(key)) return *std::move(before);
  PairResult answer{true, false, rung, rung, {}};
  answer.passed = check(*a, *b, context, answer.rung, answer.found);
  if (answer.found.tests >= kWorthKeeping && !answer.found.interrupted) known.add(key, answer);
  return answer;
}

/// Checks all pairs in parallel until one fails, each from the highest rung known when its check begins.
auto Verifier::Impl::check_pairs(const Pairs& pairs, const RunContext& context) const -> std::vector<PairResult> {
  std::vector<PairResult> results(pairs.size());
  std::atomic<std::size_t> highest{0};
  std::atomic<bool> failed{false};
  parallel_for(
      pairs.size(), context,
      [&](std::size_t k) {
        results[k] = check_pair(pairs[k], highest, context);
        if (!results[k].passed) failed = true;
        for (std::size_t r = highest; r < results[k].rung && !highest.compare_exchange_weak(r, results[k].rung);) {
        }
      },
      [&] { return failed.load(); });
  return results;
}

/// Checks one pair of parts. `rung` is the lowest rung to try; it is raised as needed.
bool Verifier::Impl::check(const Actor& a, const Actor& b, const RunContext& context, std::size_t& rung,
                           MotionCheck& result) const {
  const double allowed = overlap(a.part, b.part);
  if (verify::RelativeMotion(a.poses, b.poses, bodies[a.part].box).constant(rounding_of(bodies[a.part].box)))
    return true;
  for (const auto& x : bodies[a.part].solids)
    for (const auto& y : bodies[b.part].solids)
      if (!check(a, b, x, y, allowed, context, rung, result)) return false;
  if (const Aabb* where = region(a.part, b.part))
    for (const auto& x : bodies[a.part].solids)
      for (const auto& y : bodies[b.part].solids)
        if (!check_elsewhere(a, b, x, y, *where, context, result)) return false;
  return true;
}

/// Checks law 3, outside the region of the initial overlap.
bool Verifier::Impl::check_elsewhere(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y,
                                     const Aabb& region, const RunContext& context, MotionCheck& result) const {
  const verify::Limits limits{0, options.max_penetration, &region, options.max_penetration};
  const SolidMotion motion(a.poses, b.poses, x, y, limits.most());
  if (!motion.forward.swept_box().overlaps(y.box)) return true;
  verify::Budget budget = budget_for(motion.forward.segments(), true, true, &context);
  const Finding f = verify::check_pair(x, y, motion.forward, motion.backward(), limits, budget);
  result.tests += budget.tests_done;
  if (f.answer == Answer::certified) return true;
  result.interrupted = f.answer == Answer::exhausted && context.should_stop();
  if (result.interrupted) return false;
  result.violation = violation(a, b, x, y, f, 0, motion.forward.segments());
  result.violation->elsewhere = true;
  return false;
}

bool Verifier::Impl::check(const Actor& a, const Actor& b, const verify::Solid& x, const verify::Solid& y,
                           double allowed, const RunContext& context, std::size_t& rung, MotionCheck& result) const {
  const SolidMotion motion(a.poses, b.poses, x, y, allowed + options.max_penetration);
  const verify::RelativeMotion& forward = motion.forward;
  if (!forward.swept_box().overlaps(y.box)) return true;
  const verify::RelativeMotion backward = motion.backward();

  const std::size_t last = rungs.size() - 1;
  if (x.open || y.open) {  // no measured depth tells which rung may do
    Finding f;
    for (const std::size_t r : {std::size_t{0}, last}) {
      verify::Budget budget = budget_for(forward.segments(), true, allowed > options.max_penetration, &context);
      f = verify::check_pair(x, y, forward, backward, {allowed, rungs[r], nullptr, options.max_penetration}, budget);
      result.tests += budget.tests_done;
      if (f.answer == Answer::certified) {
        rung = std::max(rung, r);
        return true;
      }
      result.interrupted = f.answer == Answer::exhausted && context.should_stop();
      if (result.interrupted) return false;
    }
    result.violation = violation(a, b, x, y, f, allowed, forward.segments());
    return false;
  }
  // Paths of many segments are close fits, on which low rungs fail, so they are sampled first.
  bool sampled = forward.segments() >= 16 && geometry::box_under(x.box, forward.at(0)).overlaps(y.box);
  bool sample_tells = false;
  Finding seen;
  if (sampled) {
    seen = verify::deepest_sample(x, y, forward, backward);
    sample_tells = seen.depth > verify::Limits{allowed, rungs[rung]}.at(seen.thickness);
  }
  for (;;) {
    const bool overlapping = allowed > options.max_penetration;  // a low rung above a deep overlap is worth little
    const bool decides = rung == last || (rung == worthwhile && !overlapping);
    verify::Budget budget = budget_for(forward.segments(), decides, overlapping, &context);
    const verify::Limits limits{allowed, rungs[rung], nullptr, options.max_penetration};
    Finding f = sample_tells ? seen : verify::check_pair(x, y, forward, backward, limits, budget);
    sample_tells = false;
    result.tests += budget.tests_done;
    if (f.answer == Answer::certified) return true;
    if (f.answer == Answer::exhausted && context.should_stop()) {
      result.interrupted = true;
      return false;
    }
    if (!sampled) {  // a lower bound of the depth, before more effort
      seen = verify::deepest_sample(x, y, forward, backward);
      sampled = true;
      if (seen.depth > f.depth || f.answer != Answer::violated)
        if (seen.depth > limits.at(seen.thickness)) f = seen;
    }

    const bool beyond_all =
        f.answer == Answer::violated && f.depth > verify::Limits{allowed, options.max_penetration}.at(f.thickness);
    if (rung == last || beyond_all) {
      result.violation = violation(a, b, x, y, f, allowed, forward.segments());
      return false;
    }
    ++rung;
    if (f.answer == Answer::violated)  // a rung with little margin takes long to prove
      while (rung < last && f.depth > allowed + 0.8 * (verify::Limits{allowed, rungs[rung]}.at(f.thickness) - allowed))
        ++rung;
    if (f.answer == Answer::exhausted) rung = overlapping ? last : std::max(rung, worthwhile);
  }
}

VerifyBudget VerifyBudget::times(double factor) const {
  VerifyBudget more = *this;
  for (std::uint64_t* count : {&more.tests, &more.tests_per_segment, &more.patches}) *count = share_of(*count, factor);
  return more;
}

Verifier::Verifier(const Assembly& assembly, VerifyOptions options, const RunContext& context) {
  if (!(options.max_penetration > 0) || !std::isfinite(options.max_penetration))
    throw std::invalid_argument("Verifier: max_penetration must be finite and > 0");
  impl_ = std::make_unique<Impl>(assembly, options, context);
}

Verifier::~Verifier() = default;

const VerifyOptions& Verifier::options() const { return impl_->options; }

std::size_t Verifier::parts() const { return impl_->bodies.size(); }

std::optional<Aabb> Verifier::overlap_region(PartId a, PartId b) const {
  const Aabb* where = impl_->region(a, b);
  return where == nullptr ? std::nullopt : std::optional(*where);
}

const std::vector<Vec3>& Verifier::hull(PartId part) const { return impl_->bodies.at(part).corners; }

const std::vector<geometry::Solid>& Verifier::solids(PartId part) const { return impl_->bodies.at(part).solids; }

MotionCheck Verifier::check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                   const Path& path) const {
  return check_motion(moving, fixed, path, RunContext{});
}

MotionCheck Verifier::check_motion(const std::vector<PartId>& moving, const std::vector<PlacedPart>& fixed,
                                   const Path& path, const RunContext& context) const {
  if (path.size() < 2) throw std::invalid_argument("Verifier: a path needs two instants at least");
  for (const auto& row : path) {
    if (row.size() != moving.size()) throw std::invalid_argument("Verifier: path has the wrong number of columns");
    for (const auto& pose : row)
      if (!pose.t.allFinite() || !pose.q.coeffs().allFinite() || std::abs(pose.q.norm() - 1) > 1e-6)
        throw std::invalid_argument("Verifier: path has a pose that is not finite or not a unit quaternion");
  }
  std::vector<Impl::Actor> movers, others;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    std::vector<Pose> poses;
    for (const auto& row : path) poses.push_back({row[i].t, row[i].q.normalized()});
    movers.emplace_back(moving[i], std::move(poses), impl_->bodies.at(moving[i]).box);
  }
  std::vector<Aabb> reach;  // of the movers
  for (const Impl::Actor& mover : movers) {
    reach.push_back(mover.swept.whole());
    reach.back().inflate(rounding_of(mover.swept.whole()));
  }
  // Most parts are far from all of them, as the first box of near() below says; of these no actor is made.
  const auto is_far = [&](const PlacedPart& s) {
    if (!s.pose.q.vec().isZero(0)) return false;
    const Aabb& own = impl_->bodies.at(s.part).box;
    const Aabb there{own.lo + s.pose.t, own.hi + s.pose.t};
    return std::none_of(reach.begin(), reach.end(), [&](const Aabb& box) { return box.overlaps(there); });
  };
  for (const auto& s : fixed)
    if (!is_far(s))
      others.emplace_back(s.part, std::vector<Pose>{{s.pose.t, s.pose.q.normalized()}}, impl_->bodies.at(s.part).box);
  const auto near = [](const Impl::Actor& a, const Impl::Actor& b) {
    return a.swept.meets(b.swept, rounding_of(a.swept.whole()));
  };
  Impl::Pairs pairs;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    for (const auto& other : others)
      if (near(movers[i], other)) pairs.emplace_back(&movers[i], &other);
    for (std::size_t k = i + 1; k < movers.size(); ++k)
      if (near(movers[i], movers[k])) pairs.emplace_back(&movers[i], &movers[k]);
  }
  MotionCheck result;
  impl_->check(pairs, context, result);
  return result;
}

bool Verifier::passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const {
  const geometry::SweptBoxes a(path, impl_->bodies.at(moving).box), b({fixed_at}, impl_->bodies.at(fixed).box);
  if (!a.meets(b, 0)) return true;
  const verify::Limits limits{impl_->overlap(moving, fixed), impl_->options.max_penetration};
  const std::vector<verify::Solid>&x = impl_->bodies[moving].solids, &y = impl_->bodies[fixed].solids;
  const auto keeps_to = [&](const verify::Limits& to) {
    return verify::passes(x, path, y, fixed_at, to, impl_->budget_for(path.size() - 1, false, false, nullptr));
  };
  const Aabb* where = impl_->region(moving, fixed);
  if (where == nullptr) return keeps_to(limits);
  // An overlap as deep as half a wall allows all depths in the wall; outside the region a few samples tell.
  const verify::Limits elsewhere{0, impl_->options.max_penetration, where, impl_->options.max_penetration};
  return !verify::refuted_by_samples(x, path, y, fixed_at, elsewhere) && keeps_to(limits) && keeps_to(elsewhere);
}

verify::HullsApart Verifier::Impl::hulls_of(const std::vector<PlacedPart>& group,
                                            const std::vector<PlacedPart>& rest) const {
  const auto placed = [&](const std::vector<PlacedPart>& parts) {
    std::vector<verify::PlacedHull> hulls;
    hulls.reserve(parts.size());
    for (const auto& p : parts) {
      const Body& body = bodies.at(p.part);
      hulls.push_back({meshes[p.part].get(), &body.box, &body.corners, p.pose});
    }
    return hulls;
  };
  return {placed(group), placed(rest)};
}

bool Verifier::apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest) const {
  return impl_->hulls_of(group, rest).after(Vec3::Zero());
}

}  // namespace dismantle
