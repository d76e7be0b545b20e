#include "dismantle/verification/motion_depth.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "dismantle/geometry/swept_boxes.h"
#include "dismantle/verification/interruptible_depth.h"

namespace dismantle {
namespace {

struct Sample {
  double u = 0;  // segment index plus position in the segment
  double depth = 0;
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
  /// The same for the points of either part in the frame of the other, as long as they are in each other.
  double travel_of_either(double from, double to) const {
    return screw_travel(at(from), at(to), box_.center(), radius_ + travel(from, to));
  }
  bool meets(double from, double to) const { return geometry::SweptBoxes({at(from), at(to)}, box_).meets(there_, 0); }
  std::size_t segments() const { return poses_.size() - 1; }

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

  const DepthBody& body(PartId part) {
    auto& made = bodies.at(part);
    if (!made) made = std::make_unique<DepthBody>(*assembly.parts.at(part).mesh);
    return *made;
  }

  static double resolution(const MotionDepthOptions& options, const std::optional<MotionDepth>& worst) {
    return std::max(options.absolute, options.relative * (worst ? worst->depth : 0));
  }
  static void raise(std::optional<MotionDepth>& worst, const MotionDepth& here) {
    if (!worst || here.excess() > worst->excess() || (here.excess() == worst->excess() && here.depth > worst->depth))
      worst = here;
  }

  /// Raises `worst`. Returns false when the result is not proved.
  bool pair(PartId part, const PairMotion& motion, const PlacedPart& other, const MotionDepthOptions& options,
            const RunContext& context, double allowed, std::optional<MotionDepth>& worst) {
    const auto measure = [&](double u) {
      // A measurement may be off by a quarter of the resolution. The rest is for the motion between measurements.
      const Penetration found = deepest_penetration(body(part), motion.at(u), body(other.part), other.pose,
                                                    0.25 * resolution(options, worst), context);
      raise(worst, {part, other.part, found.depth, allowed, found.point, false});
      return Sample{u, found.depth};
    };
    const auto interval = [&](const Sample& a, const Sample& b) {
      return Interval{a, b, std::min(0.5 * (a.depth + b.depth + motion.travel(a.u, b.u)), options.at_most) - allowed};
    };
    const auto is_settled = [&](double bound) { return bound <= worst->excess() + resolution(options, worst); };
    std::priority_queue<Interval> open;
    Sample before = measure(0);
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
    while (!open.empty()) {
      const Interval top = open.top();
      if (is_settled(top.bound)) return true;
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
  /// and leave the region, so that their depth at two instants says nothing about those between. What is outside at any
  /// instant of an interval is in its middle outside of a region that is smaller by half of the travel.
  bool elsewhere(PartId part, const PairMotion& motion, const PlacedPart& other, const Aabb& region,
                 const MotionDepthOptions& options, const RunContext& context, std::optional<MotionDepth>& worst) {
    std::uint64_t measured = 0;
    const auto known = [&] { return worst ? worst->excess() : 0; };
    const auto measure = [&](double u, const Aabb& without, double from) {
      ++measured;
      return deepest_elsewhere(body(part), motion.at(u), body(other.part), other.pose, without, std::max(0.0, from),
                               0.25 * resolution(options, worst), context);
    };
    std::priority_queue<Interval> open;
    const auto add = [&](double from, double to) {
      if (!motion.meets(from, to)) return;
      const double u = 0.5 * (from + to), half = 0.5 * motion.travel_of_either(from, to);
      const double settled = known() + resolution(options, worst), unsure = 0.25 * resolution(options, worst) + half;
      Aabb smaller = region;
      smaller.inflate(-half);
      const double bound = std::min(measure(u, smaller, settled - unsure).depth + unsure, options.at_most);
      if (bound <= settled) return;
      const Penetration found = measure(u, region, known());
      if (found.depth > known()) raise(worst, {part, other.part, found.depth, 0, found.point, false});
      open.push({{from, 0}, {to, 0}, bound});
    };
    const auto must_end = [&] {
      return context.should_stop() || measured > options.most_poses || (worst && worst->excess() > options.stop_above);
    };
    for (std::size_t k = 0; k < motion.segments() && !must_end(); ++k)
      add(static_cast<double>(k), static_cast<double>(k + 1));
    while (!open.empty()) {
      const Interval top = open.top();
      if (top.bound <= known() + resolution(options, worst)) return !must_end();
      if (must_end()) return false;
      open.pop();
      const double u = 0.5 * (top.a.u + top.b.u);
      add(top.a.u, u);
      add(u, top.b.u);
    }
    return !must_end();
  }
};

MotionDepthMeter::MotionDepthMeter(const Assembly& assembly, const Verifier& verifier)
    : impl_(std::make_unique<Impl>(Impl{assembly, verifier, {}})) {
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
      const auto region = valid_ones ? std::nullopt : impl_->verifier.overlap_region(moving[i], other.part);
      if (region && !(worst && worst->excess() > options.stop_above))
        proved = impl_->elsewhere(moving[i], motion, other, *region, options, context, worst) && proved;
      if (worst && worst->excess() > options.stop_above) return worst;
    }
  }
  if (worst) worst->proved = proved && !context.should_stop();  // a measurement may have been cut short
  return worst;
}

}  // namespace dismantle
