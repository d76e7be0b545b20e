#include "dismantle/verification/motion_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "dismantle/geometry/pair_check.h"
#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/verification/interruptible_depth.h"
#include "solid_motion.h"
#include "swept_depth.h"

namespace dismantle {
namespace {

/// Share of the resolution that a measurement may be off. The rest is for the motion between measurements.
constexpr double kMeasured = 0.25;

struct Sample {
  double u = 0;      // segment index plus position in the segment
  double depth = 0;  // upper bound
};

struct Interval {
  Sample a, b;
  double bound = 0;
  bool operator<(const Interval& other) const { return bound < other.bound; }
};

/// One moving part past one fixed part.
class PairMotion {
 public:
  PairMotion(const Aabb& box, const std::vector<Pose>& poses, const Aabb& fixed_box, const Pose& fixed)
      : box_(box), radius_(0.5 * box.size().norm()), poses_(poses), there_({fixed}, fixed_box) {}

  Pose at(double u) const {
    const double k = std::min(std::floor(u), static_cast<double>(poses_.size() - 2));
    const auto i = static_cast<std::size_t>(k);
    return screw_interpolate(poses_[i], poses_[i + 1], u - k);
  }
  /// How far a point of the moving part travels at most.
  double travel(double from, double to) const { return screw_travel(at(from), at(to), box_.center(), radius_); }
  bool meets(double from, double to) const { return geometry::SweptBoxes({at(from), at(to)}, box_).meets(there_, 0); }
  std::size_t segments() const { return poses_.size() - 1; }
  bool is_straight() const {
    return std::ranges::all_of(poses_, [&](const Pose& p) { return p.q.coeffs() == poses_.front().q.coeffs(); });
  }
  const std::vector<Pose>& poses() const { return poses_; }

 private:
  Aabb box_;
  double radius_;
  const std::vector<Pose>& poses_;
  geometry::SweptBoxes there_;
};

}  // namespace

struct MotionDepthMeter::Impl {
  const Assembly& assembly;
  const Verifier& verifier;
  std::vector<std::unique_ptr<DepthBody>> bodies;
  std::map<std::pair<PartId, std::size_t>, DepthField> fields;  // by part and solid

  const DepthBody& body(PartId part) {
    auto& made = bodies.at(part);
    if (!made) made = std::make_unique<DepthBody>(*assembly.parts.at(part).mesh);
    return *made;
  }

  DepthField& field(PartId part, std::size_t solid) {
    return fields.try_emplace({part, solid}, verifier.solids(part)[solid]).first->second;
  }

  static double resolution(const MotionDepthOptions& options, const std::optional<MotionDepth>& worst) {
    return std::max(options.absolute, options.relative * (worst ? worst->depth : 0));
  }
  /// Least depth that leaves nothing more to find, or more than the caller wants to know.
  static double enough(const MotionDepthOptions& options, double allowed) {
    const double resolved = std::min(options.at_most - options.absolute, options.at_most / (1 + options.relative));
    const double beyond = std::nextafter(allowed + options.stop_above, std::numeric_limits<double>::infinity());
    return std::min(std::max(allowed, resolved), beyond);
  }
  Eigen::Vector3d size_of(PartId part) const { return assembly.parts.at(part).mesh->box().size(); }
  static void raise(std::optional<MotionDepth>& worst, const MotionDepth& here) {
    if (!worst || here.excess() > worst->excess() || (here.excess() == worst->excess() && here.depth > worst->depth))
      worst = here;
  }

  /// Whether something may be deeper than a bound, and when, if that is known.
  struct Deeper {
    bool may_be = false;
    std::optional<double> time{};
  };

  /// Than `known` plus `resolution`, by the check of the verifier with a share of its budget.
  Deeper deeper_than(PartId part, const PairMotion& motion, const PlacedPart& other, double known, double resolution,
                     const RunContext& context) const {
    const VerifyBudget& counts = verifier.options().budget;
    const geometry::Limits limits{known + 0.5 * resolution, 0.5 * resolution, nullptr,
                                  verifier.options().max_penetration};
    for (const geometry::Solid& x : verifier.solids(part))
      for (const geometry::Solid& y : verifier.solids(other.part)) {
        if (x.open || y.open) return {true};  // the check proves another statement about them
        const SolidMotion solids(motion.poses(), {other.pose}, x, y, limits.most());
        if (!solids.forward.swept_box().overlaps(y.box)) continue;
        const auto share = [&](std::uint64_t count) {
          return static_cast<std::uint64_t>(counts.trial_share * static_cast<double>(count));
        };
        geometry::Budget budget{share(counts.tests), share(counts.patches), 0, &context, counts.resolution};
        const geometry::Finding found = geometry::check_pair(x, y, solids.forward, solids.backward(), limits, budget);
        if (found.answer == geometry::Answer::certified) continue;
        return {true, found.answer == geometry::Answer::violated ? std::optional(found.time) : std::nullopt};
      }
    return {};
  }

  /// Of a motion without turns past parts that have an inside; else empty. As pair(); with `left_out`, as elsewhere().
  std::optional<bool> straight(PartId part, const PairMotion& motion, const PlacedPart& other,
                               const MotionDepthOptions& options, const RunContext& context, double allowed,
                               std::optional<MotionDepth>& worst, const Aabb* left_out = nullptr) {
    constexpr std::uint64_t kPieces = 500;  // take as long as measuring a pose
    const auto closed = [](const geometry::Solid& solid) { return !solid.open; };
    const auto &moving = verifier.solids(part), &fixed = verifier.solids(other.part);
    if (!motion.is_straight() || !std::ranges::all_of(moving, closed) || !std::ranges::all_of(fixed, closed))
      return std::nullopt;
    bool settled = true;
    if (!worst) raise(worst, {part, other.part, 0, allowed, Eigen::Vector3d::Zero(), false});
    for (std::size_t k = 0; k < motion.segments(); ++k) {
      const auto u = static_cast<double>(k);
      if (!motion.meets(u, u + 1)) continue;
      const Pose from = motion.at(u);
      for (std::size_t m = 0; m < moving.size(); ++m)
        for (std::size_t f = 0; f < fixed.size(); ++f) {
          const PlacedSolid x{moving[m], from, field(part, m)}, y{fixed[f], other.pose, field(other.part, f)};
          const SweptSearch search{.from = allowed + worst->excess(),
                                   .resolution =
                                       [&, least = worst->depth](double depth) {
                                         return std::max(options.absolute, options.relative * std::max(least, depth));
                                       },
                                   .enough = enough(options, allowed),
                                   .most_pieces = kPieces * options.most_poses,
                                   .left_out = left_out};
          const SweptDepth found = swept_depth(x, motion.at(u + 1).t - from.t, y, search, context);
          if (found.deepest.depth > search.from)
            raise(worst, {part, other.part, found.deepest.depth, allowed, found.deepest.point, false});
          if (options.at_most - allowed <= worst->excess() + resolution(options, worst)) return true;
          if (worst->excess() > options.stop_above || context.should_stop()) return false;
          settled = settled && found.settled;
        }
    }
    return settled;
  }

  /// Raises `worst`. Returns false when the result is not proved.
  bool pair(PartId part, const PairMotion& motion, const PlacedPart& other, const MotionDepthOptions& options,
            const RunContext& context, double allowed, std::optional<MotionDepth>& worst) {
    if (const auto known = straight(part, motion, other, options, context, allowed, worst)) return *known;
    // Deeper than this would be a new worst.
    const auto known = [&] { return worst ? allowed + worst->excess() : 0; };
    // A lower bound of the depth there; with the tolerance it is an upper one.
    const auto measured_to = [&](double u, DepthSearch search) {
      search.enough = std::min(search.enough, enough(options, allowed));
      const Penetration found =
          deepest_penetration(body(part), motion.at(u), body(other.part), other.pose, search, context);
      if (found.depth > search.from) raise(worst, {part, other.part, found.depth, allowed, found.point, false});
      return found.depth;
    };
    const auto fine = [&](double u, double from) {
      const double error = kMeasured * resolution(options, worst);
      return Sample{u, measured_to(u, {.tolerance = error, .from = from}) + error};
    };
    // How fine to measure follows from the depth. It is not known at first: begin with the deepest there can be.
    const auto measure_first = [&](double u) {
      const double most = 0.5 * std::min(size_of(part).minCoeff(), size_of(other.part).minCoeff());
      double depth = 0, error = kMeasured * options.relative * most;
      for (;; error *= 0.25) {
        error = std::max(error, kMeasured * options.absolute);
        depth = measured_to(u, {.tolerance = error, .from = depth});
        if (error <= kMeasured * std::max(options.absolute, options.relative * depth) || context.should_stop() ||
            depth >= enough(options, allowed))
          break;
      }
      if (!worst) raise(worst, {part, other.part, depth, allowed, Eigen::Vector3d::Zero(), false});
      return Sample{u, depth + error};
    };
    // Exact depths are needed of what may be the worst only: most places are found in one coarse pass to be less deep
    // than half of it, or in one fine pass to be no deeper.
    const auto measure = [&](double u) {
      const double most = known();
      if (most <= 2 * resolution(options, worst)) return fine(u, 0);
      const double error = 0.25 * most;
      const double coarse = measured_to(u, {.tolerance = error, .from = 0.5 * most, .enough = 0.75 * most});
      return coarse < 0.75 * most ? Sample{u, coarse + error} : fine(u, std::max(most, coarse));
    };
    const auto interval = [&](const Sample& a, const Sample& b) {
      return Interval{a, b, std::min(0.5 * (a.depth + b.depth + motion.travel(a.u, b.u)), options.at_most) - allowed};
    };
    const auto is_settled = [&](double bound) { return bound <= worst->excess() + resolution(options, worst); };
    std::priority_queue<Interval> open;
    Sample before = worst ? measure(0) : measure_first(0);
    std::uint64_t measured = 1;
    if (is_settled(options.at_most - allowed)) return true;
    for (std::size_t k = 1; k <= motion.segments(); ++k) {
      const auto u = static_cast<double>(k);
      if (!motion.meets(u - 1, u)) {
        before = {u, 0};
        continue;
      }
      const Sample after = measure(u);
      open.push(interval(before, after));
      before = after;
      if (is_settled(options.at_most - allowed)) return true;
      if (context.should_stop() || ++measured > options.most_poses) return false;
      if (worst->excess() > options.stop_above) return false;
    }
    // Where a part cuts in alike for a while, many poses have to be measured; a proof takes as long as some of them.
    std::uint64_t proof_after = 8;
    while (!open.empty()) {
      const Interval top = open.top();
      if (is_settled(top.bound)) return true;
      if (measured >= proof_after && !context.should_stop()) {
        proof_after = 2 * measured;
        const double known_before = known();
        const Deeper deeper = deeper_than(part, motion, other, known_before, resolution(options, worst), context);
        if (!deeper.may_be) return true;
        if (deeper.time) measure(*deeper.time), ++measured;
        if (known() > known_before) proof_after = measured;
      }
      if (worst->excess() > options.stop_above || context.should_stop() || ++measured > options.most_poses)
        return false;
      open.pop();
      if (!motion.meets(top.a.u, top.b.u)) continue;
      const Sample middle = measure(0.5 * (top.a.u + top.b.u));
      open.push(interval(top.a, middle));
      open.push(interval(middle, top.b));
    }
    return true;
  }

  /// The same outside the region of the initial overlap, where nothing is allowed (law 3 of the verifier). Points enter
  /// and leave the region, so that their depth at two instants says nothing about those between. A straight way is
  /// searched whole, as by pair(). Of others the check of the verifier proves that nothing is deeper than the deepest
  /// point so far, or says when to measure again.
  bool elsewhere(PartId part, const PairMotion& motion, const PlacedPart& other, const Aabb& region,
                 const MotionDepthOptions& options, const RunContext& context, std::optional<MotionDepth>& worst) {
    if (const auto answer = straight(part, motion, other, options, context, 0, worst, &region)) return *answer;
    const auto known = [&] { return worst ? worst->excess() : 0; };
    const auto raise_to = [&](double depth, const Eigen::Vector3d& point) {
      if (depth <= known()) return false;
      raise(worst, {part, other.part, depth, 0, point, false});
      return true;
    };
    const auto depth_at = [&](double u, double tolerance) {
      return deepest_penetration(body(part), motion.at(u), body(other.part), other.pose,
                                 {.tolerance = tolerance, .from = known(), .left_out = &region}, context);
    };
    // The check may give up where nothing is deeper. Other places may show what is.
    const auto raised_at_samples = [&] {
      constexpr int kSamples = 32;
      bool raised = false;
      for (int k = 1; k < kSamples && !context.should_stop(); ++k) {
        const double u = static_cast<double>(motion.segments()) * k / kSamples;
        const Penetration then = depth_at(u, 0.5 * resolution(options, worst));
        raised = raise_to(then.depth, then.point) || raised;
      }
      return raised;
    };
    std::uint64_t measured = 0;
    for (const geometry::Solid& x : verifier.solids(part))
      for (const geometry::Solid& y : verifier.solids(other.part))
        for (;;) {
          const double sure = 0.5 * resolution(options, worst);
          if (known() + 2 * sure >= options.at_most) return true;
          const geometry::Limits limits{known() + sure, sure, &region, verifier.options().max_penetration};
          const SolidMotion solids(motion.poses(), {other.pose}, x, y, limits.most());
          if (!solids.forward.swept_box().overlaps(y.box)) break;
          const VerifyBudget& counts = verifier.options().budget;
          geometry::Budget budget{counts.tests + counts.tests_per_segment * motion.segments(), counts.patches, 0,
                                  &context, counts.resolution};
          const geometry::Finding found = geometry::check_pair(x, y, solids.forward, solids.backward(), limits, budget);
          if (found.answer == geometry::Answer::certified) break;
          if (context.should_stop() || known() > options.stop_above || ++measured > options.most_poses) return false;
          const Penetration then = depth_at(found.time, 0.5 * sure);
          bool higher = raise_to(then.depth, then.point);
          if (found.answer == geometry::Answer::violated) {
            const Pose place = found.of_second ? other.pose * y.frame : motion.at(found.time) * x.frame;
            higher = raise_to(found.depth, place * found.point) || higher;
          }
          if (!higher && !raised_at_samples()) return false;
        }
    return !context.should_stop() && known() <= options.stop_above;
  }
};

MotionDepthMeter::MotionDepthMeter(const Assembly& assembly, const Verifier& verifier)
    : impl_(std::make_unique<Impl>(Impl{assembly, verifier, {}, {}})) {
  impl_->bodies.resize(assembly.parts.size());
}

MotionDepthMeter::~MotionDepthMeter() = default;

std::optional<MotionDepth> MotionDepthMeter::deepest(const std::vector<PartId>& moving,
                                                     const std::vector<PlacedPart>& fixed, const Path& path,
                                                     const MotionDepthOptions& wanted, const RunContext& context,
                                                     bool valid_ones) {
  MotionDepthOptions options = wanted;
  if (options.absolute <= 0) options.absolute = impl_->verifier.options().max_penetration;
  std::optional<MotionDepth> worst;
  bool proved = true;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    std::vector<Pose> poses;
    for (const auto& instant : path) poses.push_back(instant[i]);
    const geometry::SweptBoxes swept(poses, impl_->assembly.parts.at(moving[i]).mesh->box());
    for (const PlacedPart& other : fixed) {
      if (!swept.meets(geometry::SweptBoxes({other.pose}, impl_->assembly.parts.at(other.part).mesh->box()), 0))
        continue;
      if (context.should_stop()) return worst ? worst : std::nullopt;
      if (!valid_ones && !options.known_invalid && impl_->verifier.passes(moving[i], other.part, other.pose, poses))
        continue;
      const PairMotion motion(impl_->assembly.parts.at(moving[i]).mesh->box(), poses,
                              impl_->assembly.parts.at(other.part).mesh->box(), other.pose);
      proved = impl_->pair(moving[i], motion, other, options, context,
                           valid_ones ? 0 : impl_->assembly.initial_overlap(moving[i], other.part), worst) &&
               proved;
      const bool coarse = options.absolute > impl_->verifier.options().max_penetration;
      const auto region = valid_ones || coarse ? std::nullopt : impl_->verifier.overlap_region(moving[i], other.part);
      if (region && !(worst && worst->excess() > options.stop_above))
        proved = impl_->elsewhere(moving[i], motion, other, *region, options, context, worst) && proved;
      if (worst && worst->excess() > options.stop_above) return worst;
    }
  }
  if (!worst) return worst;
  worst->depth = std::max(0.0, worst->depth);        // a point on the surface, but for rounding
  worst->proved = proved && !context.should_stop();  // a measurement may have been cut short
  return worst;
}

}  // namespace dismantle
