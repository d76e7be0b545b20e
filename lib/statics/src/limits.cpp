#include "dismantle/statics/limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kSteepest = 89 * M_PI / 180;
constexpr double kNear = 3e-4;  // of a value: that near is found
constexpr int kCuts = 50, kHalvings = 14, kTilts = 8;

/// Work of the weights in a motion when gravity points to `down`.
double work(const Pile& pile, const Motions& motion, const Vec3& down) {
  double sum = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (!pile.bodies[i].fixed) sum += pile.bodies[i].weight * motion[i].v.dot(down);
  return sum;
}

/// Answer about one value of a load: forces balance it, or a motion shows that none do from a smaller value on.
struct Probe {
  bool balanced = false;
  std::optional<double> bound{};
};

/// The largest value in [0, high] that is balanced. A motion of falling gives the value at which it begins, which is
/// then tried; where that is neither balanced nor shown not to be, somewhat less, by growing steps; then the interval
/// is halved.
double largest_balanced(double high, const std::function<Probe(double)>& probe, const Stop& stop) {
  double low = 0, x = high, back = std::numeric_limits<double>::infinity();
  bool bounded = true;  // nothing above x is balanced
  for (int k = 0; k < kCuts && !(stop && stop()); ++k) {
    const Probe found = probe(x);
    if (found.balanced) {
      low = x;
      if (bounded) return x;
      back = std::numeric_limits<double>::infinity();
    } else {
      back = bounded && k > 0 ? kNear * x : 4 * back;
      high = x;
    }
    if (high - low <= kNear * high) break;
    bounded = !found.balanced && found.bound && *found.bound < high;
    if (bounded && *found.bound <= low) return low;
    x = bounded ? *found.bound : std::max(0.5 * (low + high), high - back);
  }
  return low > 0 ? low : high;
}

/// Largest angle at which forces balance the pile, at most kSteepest. `near`: a displacement as it is.
double balanced_up_to(const Pile& pile, const Vec3& axis, const Motions& near, const Stop& stop) {
  // Most piles slide first, and from a tilt nearby less has to be found out than from the steepest.
  double friction = 0;
  for (const Contact& c : pile.contacts) friction = std::max(friction, c.friction);
  const auto largest_up_to = [&](double steepest) {
    return largest_balanced(
        steepest,
        [&](double x) -> Probe {
          const Pile turned = tilted(pile, axis, x);
          const Balance found = balance(turned, FrictionLaw::associated, stop, near);
          if (found.balanced) return {true, {}};
          if (!check_fall(turned, found.falling).empty()) return {};
          // Work at the angle t: always + along * cos(t) + across * sin(t), for gravity turned about the axis.
          const Vec3 fixed_part = axis.dot(pile.down) * axis;
          const double along = work(pile, found.falling, pile.down - fixed_part);
          const double across = work(pile, found.falling, -axis.cross(pile.down));
          const double size = std::hypot(along, across);
          if (!(size > 0)) return {};
          const double cosine = std::clamp(-work(pile, found.falling, fixed_part) / size, -1.0, 1.0);
          return {false, std::max(0.0, std::atan2(across, along) - std::acos(cosine))};
        },
        stop);
  };
  const double slides = std::min(kSteepest, 1.1 * std::atan(friction)), found = largest_up_to(slides);
  return found < slides || slides == kSteepest ? found : largest_up_to(kSteepest);
}

}  // namespace

Pile tilted(Pile pile, const Vec3& axis, double angle) {
  pile.down = Eigen::AngleAxisd(-angle, axis) * pile.down;
  return pile;
}

std::optional<double> critical_tilt(const Pile& pile, const Vec3& axis, const Stop& stop) {
  Motions near;  // displacement of the last angle at which it stands
  const auto stands = [&](double angle) {
    Judgement judged = judge(tilted(pile, axis, angle), stop, near);
    if (judged.verdict == Verdict::stands) near = std::move(judged.displacement);
    return judged.verdict == Verdict::stands;
  };
  if (!stands(0)) return 0.0;
  double high = balanced_up_to(pile, axis, near, stop), low = 0;
  // What is pressed in at one angle may stand at a larger one: the first angle counts.
  const double steepest = high;
  for (int k = 1; k <= kTilts; ++k) {
    const double share = k < kTilts ? static_cast<double>(k) / kTilts : steepest == kSteepest ? 1 : 0.995;
    const double angle = share * steepest;
    if (!stands(angle)) {
      high = angle;
      break;
    }
    low = angle;
  }
  if (low > 0.99 * steepest) return steepest == kSteepest ? std::nullopt : std::optional(steepest);
  for (int k = 0; k < kHalvings && high - low > 1e-3 && !(stop && stop()); ++k)
    (stands(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

std::optional<LeastPush> least_push(const Pile& pile, std::uint32_t body, const Stop& stop) {
  const Vec3 u = pile.down.unitOrthogonal(), v = pile.down.cross(u);
  double total = 0;
  for (const Body& b : pile.bodies) total += b.fixed ? 0 : b.weight;
  double known = 100 * total;  // no more is needed
  std::optional<LeastPush> least;
  Pile pushed = pile;
  for (int k = 0; k < 16; ++k) {
    const Vec3 direction = std::cos(k * M_PI / 8) * u + std::sin(k * M_PI / 8) * v;
    Motions motion;
    const auto probe = [&](double x) -> Probe {
      pushed.pushes = pile.pushes;
      pushed.pushes.push_back({body, pile.bodies[body].center, x * direction});
      Balance found = balance(pushed, FrictionLaw::associated, stop);
      if (found.balanced) return {true, {}};
      motion = std::move(found.falling);
      if (!check_fall(pushed, motion).empty()) return {};
      // The weights resist the motion by -weights, the push drives it by its force times forward.
      double weights = work(pile, motion, pile.down);
      for (const Push& p : pile.pushes) weights += motion[p.body].at(p.at - pile.bodies[p.body].center).dot(p.force);
      const double forward = motion[body].v.dot(direction);
      return {false, forward > 0 ? std::optional(std::max(0.0, -weights / forward)) : std::nullopt};
    };
    // A few weights move most bodies; what they do not move takes longer to judge.
    for (const double most : {std::min(total, known), known}) {
      const double force = largest_balanced(most, probe, stop);
      if (force < most) {
        least = {body, force, direction, std::move(motion)};
        known = force;
      }
      if (force < most || most == known) break;
    }
  }
  return least;
}

}  // namespace dismantle::statics
