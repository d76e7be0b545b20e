#include "dismantle/statics/limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"
#include "weight_work.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kNear = 3e-4;  // of a value: that near is found
constexpr int kCuts = 50;

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

/// The least horizontal push at the centre of a body that some motion gives way to.
class PushSearch {
 public:
  PushSearch(const Pile& pile, std::uint32_t body, const Stop& stop, const Motions& near,
             const std::optional<LeastPush>& bound)
      : pile_(pile), pushed_(pile), body_(body), stop_(stop), u_(pile.down.unitOrthogonal()), v_(pile.down.cross(u_)) {
    for (const Body& b : pile.bodies) total_ += b.fixed ? 0 : b.weight;
    known_ = kMostPush * total_;
    if (bound && bound->force < known_) {
      least_ = bound;
      least_->exact = true;
      known_ = bound->force;
      add_cut(bound->motion);
    }
    near_ = near;
    if (!near_.empty()) return;
    if (Balance rest = balance(pile, FrictionLaw::associated, stop); rest.balanced)
      near_ = std::move(rest.displacement);
  }

  std::optional<LeastPush> run() {
    // Directions that are far from each other first: those between them follow.
    for (int stride = kDirections / 4, first = 0; stride > 0; first = stride /= 2)
      for (int k = first; k < kDirections; k += first == 0 ? stride : 2 * stride)
        look_along({std::cos(2 * M_PI * k / kDirections), std::sin(2 * M_PI * k / kDirections)});
    return std::move(least_);
  }

 private:
  using Vec2 = Eigen::Vector2d;
  static constexpr int kDirections = 16;
  static constexpr double kMostPush = 100;  // of all weights: no more is needed
  /// How much further than the least push: directions at right angles that take it show that all between them do.
  static constexpr double kFurther = M_SQRT2;
  struct Cut {  // a motion of falling: pushes with forward * push > resistance are not balanced
    Vec2 forward;
    double resistance;
    Motions motion;
    /// How far pushes along the direction are not excluded.
    double reach(const Vec2& direction) const {
      const double along = forward.dot(direction);
      return along > 0 ? resistance / along : std::numeric_limits<double>::infinity();
    }
  };

  void look_along(const Vec2& direction) {
    // A few weights move most bodies; what they do not move takes longer to judge.
    for (const double most : {std::min(total_, known_), known_}) {
      if (is_balanced(most * direction)) continue;
      const auto probe = [&](double x) { return probe_at(x, direction); };
      if (most == known_ && reach(direction) > kFurther * known_ && probe(kFurther * known_).balanced) continue;
      const double force = largest_balanced(std::min(most, reach(direction)), probe, stop_);
      if (!(force < (1 - kNear) * most)) continue;
      const Cut* nearest = nearest_cut(direction);
      least_ = {body_, force, direction.x() * u_ + direction.y() * v_, nearest != nullptr ? nearest->motion : motion_};
      known_ = force;
      return;
    }
  }

  Probe probe_at(double x, const Vec2& direction) {
    const Vec2 push = x * direction;
    pushed_.pushes = pile_.pushes;
    pushed_.pushes.push_back({body_, pile_.bodies[body_].center, push.x() * u_ + push.y() * v_});
    Balance found = balance(pushed_, FrictionLaw::associated, stop_, near_);
    if (found.balanced) {
      balanced_.push_back(push);
      return {true, {}};
    }
    motion_ = std::move(found.falling);
    if (!check_fall(pushed_, motion_).empty()) return {};
    add_cut(motion_);
    const double most = cuts_.back().reach(direction);
    return {false, std::isfinite(most) ? std::optional(most) : std::nullopt};
  }

  void add_cut(const Motions& motion) {
    // The weights resist the motion by -weights, the push drives it by its force times forward.
    double weights = weight_work(pile_, motion, pile_.down);
    for (const Push& p : pile_.pushes) weights += motion[p.body].at(p.at - pile_.bodies[p.body].center).dot(p.force);
    const Vec2 forward(motion[body_].v.dot(u_), motion[body_].v.dot(v_));
    cuts_.push_back({forward, std::max(0.0, -weights), motion});
  }

  const Cut* nearest_cut(const Vec2& direction) const {
    const Cut* nearest = nullptr;
    for (const Cut& c : cuts_)
      if (std::isfinite(c.reach(direction)) && (nearest == nullptr || c.reach(direction) < nearest->reach(direction)))
        nearest = &c;
    return nearest;
  }
  double reach(const Vec2& direction) const {
    const Cut* nearest = nearest_cut(direction);
    return nearest != nullptr ? nearest->reach(direction) : std::numeric_limits<double>::infinity();
  }

  /// Between pushes that are balanced: those are a convex set, with no push at all in it.
  bool is_balanced(const Vec2& push) const {
    for (const Vec2& a : balanced_) {
      if ((a - push).dot(push) >= 0 && (a.normalized() - push.normalized()).norm() < kRounding) return true;
      for (const Vec2& b : balanced_) {
        const double area = a.x() * b.y() - a.y() * b.x();
        if (!(area > kRounding * a.norm() * b.norm())) continue;
        const double by_a = (push.x() * b.y() - push.y() * b.x()) / area,
                     by_b = (a.x() * push.y() - a.y() * push.x()) / area;
        if (by_a >= -kRounding && by_b >= -kRounding && by_a + by_b <= 1 + kRounding) return true;
      }
    }
    return false;
  }
  static constexpr double kRounding = 1e-9;

  const Pile& pile_;
  Pile pushed_;
  std::uint32_t body_;
  const Stop& stop_;
  Vec3 u_, v_;  // horizontal
  double total_ = 0, known_ = 0;
  Motions near_;    // displacement without the push
  Motions motion_;  // of the last push that was not balanced
  std::vector<Vec2> balanced_;
  std::vector<Cut> cuts_;
  std::optional<LeastPush> least_;
};

}  // namespace

std::optional<LeastPush> least_push(const Pile& pile, std::uint32_t body, const Stop& stop, const Motions& near,
                                    const std::optional<LeastPush>& bound) {
  return PushSearch(pile, body, stop, near, bound).run();
}

std::optional<LeastPush> least_push_alone(const Pile& pile, std::uint32_t body, const Stop& stop) {
  constexpr std::uint32_t kFixed = 0, kOwn = 1;
  Pile alone{{{0, Vec3::Zero(), 1, true}, pile.bodies[body]}, {}, pile.down};
  for (const Contact& c : pile.contacts)
    if (c.a == body || c.b == body) {
      alone.contacts.push_back(c);
      alone.contacts.back().a = c.a == body ? kOwn : kFixed;
      alone.contacts.back().b = c.b == body ? kOwn : kFixed;
    }
  for (const Push& p : pile.pushes)
    if (p.body == body) alone.pushes.push_back({kOwn, p.at, p.force});
  std::optional<LeastPush> found = least_push(alone, kOwn, stop);
  if (!found) return std::nullopt;
  Motions motion(pile.bodies.size());
  motion[body] = found->motion[kOwn];
  found->body = body;
  found->motion = std::move(motion);
  found->exact = false;
  return found;
}

}  // namespace dismantle::statics
