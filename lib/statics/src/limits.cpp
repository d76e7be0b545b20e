#include "dismantle/statics/limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "dismantle/statics/balance.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kSteepest = 89 * M_PI / 180;
constexpr int kCuts = 30, kHalvings = 14;

/// Work of the weights in a motion when gravity points to `down`.
double work(const Pile& pile, const Motions& motion, const Vec3& down) {
  double sum = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (!pile.bodies[i].fixed) sum += pile.bodies[i].weight * motion[i].v.dot(down);
  return sum;
}

/// Largest angle <= `angle` at which forces balance the pile: every motion of falling shows at which angle it begins.
double balanced_up_to(const Pile& pile, const Vec3& axis, double angle, const Stop& stop) {
  for (int k = 0; k < kCuts && !(stop && stop()); ++k) {
    const Balance found = balance(tilted(pile, axis, angle), FrictionLaw::associated, stop);
    if (found.balanced) break;
    // Work at the angle t: along * cos(t) + across * sin(t) for gravity turned about the axis.
    const Vec3 fixed_part = axis.dot(pile.down) * axis;
    const double along = work(pile, found.falling, pile.down - fixed_part);
    const double across = work(pile, found.falling, -axis.cross(pile.down));
    const double always = work(pile, found.falling, fixed_part);
    const double size = std::hypot(along, across);
    if (!(size > 0)) break;
    // along cos t + across sin t = -always, the largest solution below the present angle.
    const double middle = std::atan2(across, along), half = std::acos(std::clamp(-always / size, -1.0, 1.0));
    const double begins = middle - half;
    if (!(begins < angle * (1 - 1e-6))) break;
    angle = std::max(0.0, begins);
    if (angle == 0) break;
  }
  return angle;
}

}  // namespace

Pile tilted(Pile pile, const Vec3& axis, double angle) {
  pile.down = Eigen::AngleAxisd(-angle, axis) * pile.down;
  return pile;
}

std::optional<double> critical_tilt(const Pile& pile, const Vec3& axis, const Stop& stop) {
  if (judge(pile, stop).verdict != Verdict::stands) return 0.0;
  double high = balanced_up_to(pile, axis, kSteepest, stop), low = 0;
  const auto stands = [&](double angle) { return judge(tilted(pile, axis, angle), stop).verdict == Verdict::stands; };
  if (high == kSteepest && stands(high)) return std::nullopt;
  if (stands(0.995 * high)) return high;
  high *= 0.995;
  for (int k = 0; k < kHalvings && high - low > 1e-3 && !(stop && stop()); ++k)
    (stands(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

std::optional<LeastPush> least_push(const Pile& pile, std::uint32_t body, const Stop& stop) {
  const Vec3 u = pile.down.unitOrthogonal(), v = pile.down.cross(u);
  double total = 0;
  for (const Body& b : pile.bodies) total += b.fixed ? 0 : b.weight;
  std::optional<LeastPush> least;
  Pile pushed = pile;
  for (int k = 0; k < 16; ++k) {
    const Vec3 way = std::cos(k * M_PI / 8) * u + std::sin(k * M_PI / 8) * v;
    double force = least ? least->force : 100 * total;
    for (int round = 0; round < kCuts && !(stop && stop()); ++round) {
      pushed.pushes = pile.pushes;
      pushed.pushes.push_back({body, pile.bodies[body].center, force * way});
      const Balance found = balance(pushed, FrictionLaw::associated, stop);
      if (found.balanced) break;
      // The weights resist the motion by -weights, the push drives it by force * forward.
      double weights = work(pile, found.falling, pile.down);
      for (const Push& p : pile.pushes)
        weights += found.falling[p.body].at(p.at - pile.bodies[p.body].center).dot(p.force);
      const double forward = found.falling[body].v.dot(way);
      const double limit = forward > 0 ? std::max(0.0, -weights / forward) : force;
      if (!(limit < force * (1 - 1e-9))) break;
      force = limit;
      least = {body, force, way, found.falling};
      if (force == 0) return least;
    }
  }
  return least;
}

}  // namespace dismantle::statics
