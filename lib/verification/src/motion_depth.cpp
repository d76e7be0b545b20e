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
  double travel = 0, bound = 0;
  bool operator<(const Interval& other) const { return bound < other.bound; }
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

  /// Measures one moving part past one fixed part. Raises `worst`. Returns false when the result is not proved.
  bool pair(PartId part, const std::vector<Pose>& poses, const PlacedPart& other, const MotionDepthOptions& options,
            const RunContext& context, double allowed, std::optional<MotionDepth>& worst) {
    const Aabb& box = assembly.parts.at(part).mesh->box();
    const Eigen::Vector3d center = box.center();
    const double radius = 0.5 * box.size().norm();
    const auto resolution = [&] {
      const double depth = worst ? worst->depth : 0;
      return std::max(options.absolute, options.relative * depth);
    };
    const auto pose_at = [&](double u) {
      const double k = std::min(std::floor(u), static_cast<double>(poses.size() - 2));
      const auto i = static_cast<std::size_t>(k);
      return screw_interpolate(poses[i], poses[i + 1], u - k);
    };
    const Aabb fixed_box = assembly.parts.at(other.part).mesh->box();
    const geometry::SweptBoxes there({other.pose}, fixed_box);
    const auto measure = [&](double u) {
      const Pose pose = pose_at(u);
      // A measurement may be off by a quarter of the resolution. The rest is for the motion between measurements.
      const Penetration found =
          deepest_penetration(body(part), pose, body(other.part), other.pose, 0.25 * resolution(), context);
      const MotionDepth here{part, other.part, found.depth, allowed, found.point, false};
      if (!worst || here.excess() > worst->excess() || (here.excess() == worst->excess() && here.depth > worst->depth))
        worst = here;
      return Sample{u, found.depth};
    };
    const auto interval = [&](const Sample& a, const Sample& b) {
      Interval made{a, b, screw_travel(pose_at(a.u), pose_at(b.u), center, radius), 0};
      made.bound = std::min(0.5 * (a.depth + b.depth + made.travel), options.at_most) - allowed;
      return made;
    };
    const auto meets = [&](const Interval& i) {
      return geometry::SweptBoxes({pose_at(i.a.u), pose_at(i.b.u)}, box).meets(there, 0);
    };
    const auto is_settled = [&](double bound) { return bound <= worst->excess() + resolution(); };
    std::priority_queue<Interval> open;
    Sample before = measure(0);
    std::uint64_t measured = 1;
    if (is_settled(options.at_most - allowed)) return true;
    for (std::size_t k = 1; k < poses.size(); ++k) {
      const Interval whole{{static_cast<double>(k - 1), 0}, {static_cast<double>(k), 0}, 0, 0};
      if (!meets(whole)) {
        before = {static_cast<double>(k), 0};
        continue;
      }
      const Sample after = measure(static_cast<double>(k));
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
      if (!meets(top)) continue;
      const Sample middle = measure(0.5 * (top.a.u + top.b.u));
      open.push(interval(top.a, middle));
      open.push(interval(middle, top.b));
    }
    return true;
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
      proved = impl_->pair(moving[i], poses, other, options, context,
                           valid_ones ? 0 : impl_->assembly.initial_overlap(moving[i], other.part), worst) &&
               proved;
      if (worst && worst->excess() > options.stop_above) return worst;
    }
  }
  if (worst) worst->proved = proved && !context.should_stop();  // a measurement may have been cut short
  return worst;
}

}  // namespace dismantle
