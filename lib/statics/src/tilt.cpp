#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"
#include "dismantle/statics/limits.h"
#include "weight_work.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;
using Stop = std::function<bool()>;

constexpr double kSteepest = 89 * M_PI / 180;
constexpr int kTilts = 8;  // steps to the angle at which something slides at the latest, and from there on
/// An angle is found to this share, or to this many rad: whichever is less; but no finer than the last.
constexpr double kFine = 5e-3, kFineAngle = 1e-3, kFinest = 1e-5;

/// Angle at which a motion of falling begins when gravity turns about `axis`; none: at no angle.
std::optional<double> begins_at(const Pile& pile, const Vec3& axis, const Motions& motion) {
  const auto work = [&](const Vec3& down) { return weight_work(pile, motion, down); };
  // Work at the angle t: always + along * cos(t) + across * sin(t).
  const Vec3 always = axis.dot(pile.down) * axis;
  const double along = work(pile.down - always), across = work(-axis.cross(pile.down));
  const double size = std::hypot(along, across);
  if (!(size > 0)) return std::nullopt;
  const double cosine = std::clamp(-work(always) / size, -1.0, 1.0);
  return std::max(0.0, std::atan2(across, along) - std::acos(cosine));
}

/// Follows the displacement of the pile as it tilts. Where that ends, no displacement may be near, or there is none, or
/// no forces balance the pile: this is then found out.
class TiltSearch {
 public:
  TiltSearch(const Pile& pile, const Vec3& axis, const Motions& displacement, const Stop& stop)
      : pile_(pile), axis_(axis), near_(displacement), stop_(stop) {}

  TiltLimit run() {
    double friction = 0;
    for (const Contact& c : pile_.contacts) friction = std::max(friction, c.friction);
    // Most piles slide first.
    const double slides = friction > 0 ? std::min(kSteepest, 1.1 * std::atan(friction)) : kSteepest;
    while (low_ < highest() && !ended()) {
      const double step = (low_ < slides ? slides : kSteepest - slides) / kTilts;
      const double angle = std::min({low_ + step, highest(), low_ < slides ? slides : kSteepest});
      if (follows(angle)) continue;
      double fails = angle;
      while (fails - low_ > fine() && !ended()) {
        const double middle = 0.5 * (low_ + fails);
        if (!follows(middle)) fails = middle;
      }
      const std::optional<double> fallen = step_on(angle, fails - low_);
      if (!fallen) continue;
      const double stood = low_;
      if (!stands_between(*fallen, angle) && !ended()) return limit(0.5 * (stood + *fallen));
    }
    if (ended()) return limit(low_, false);
    return limit(falls_ ? falls_ : std::nullopt);
  }

 private:
  bool ended() const { return stop_ && stop_(); }
  double fine() const { return std::max(kFinest, std::min(kFineAngle, kFine * low_)); }
  /// What has to be reached.
  double highest() const { return falls_ ? *falls_ - 2 * std::max(kFinest, kFine * *falls_) : kSteepest; }
  TiltLimit limit(std::optional<double> angle, bool found = true) const { return {angle, low_, falls_, found}; }

  /// Does it stand again somewhat further? Then the search for a displacement ended too soon.
  bool stands_between(double fallen, double angle) {
    for (; angle - fallen > fine() && !ended(); angle = 0.5 * (fallen + angle))
      if (!(falls_ && *falls_ <= angle) && stands(angle)) return true;
    return false;
  }

  /// Goes on by steps as fine as `fine`, which become longer: to find out that a pile does not stand takes longest.
  /// None: up to `end`, or to where no forces balance the pile; otherwise an angle at which it was not found to stand.
  std::optional<double> step_on(double end, double fine) {
    bool fallen = false;
    for (double step = fine; !ended() && low_ < end;) {
      const double angle = std::min(low_ + step, end);
      if (stands(angle)) {
        step += fine;
      } else {
        if (falls_ && *falls_ <= angle) return std::nullopt;
        fallen = true;
        end = angle;
      }
      if (!fallen) continue;
      if (end - low_ < 1.5 * fine) return end;
      step = std::max(fine, 0.5 * (end - low_));
    }
    return std::nullopt;
  }

  void reached(double angle, Motions displacement) {
    low_ = angle;
    near_ = std::move(displacement);
  }

  bool follows(double angle) {
    std::optional<Balance> found = balance_near(tilted(pile_, axis_, angle), near_, stop_);
    if (found) reached(angle, std::move(found->displacement));
    return found.has_value();
  }

  /// By all means.
  bool stands(double angle) {
    if (follows(angle)) return true;
    const Pile turned = tilted(pile_, axis_, angle);
    Balance any = balance(turned, FrictionLaw::associated, stop_, near_);
    if (!any.balanced && check_fall(turned, any.falling).empty()) {
      const std::optional<double> begin = begins_at(pile_, axis_, any.falling);
      falls_ = std::min(falls_.value_or(angle), begin.value_or(angle));
      return false;
    }
    for (const FrictionLaw law : {FrictionLaw::coulomb, FrictionLaw::associated})  // from nothing
      if (!is_certified(turned, any)) any = balance(turned, law, stop_);
    if (!is_certified(turned, any)) return false;
    reached(angle, std::move(any.displacement));
    return true;
  }

  const Pile& pile_;
  Vec3 axis_;
  Motions near_;  // displacement at `low_`
  const Stop& stop_;
  double low_ = 0;
  std::optional<double> falls_{};
};

}  // namespace

Pile tilted(Pile pile, const Vec3& axis, double angle) {
  pile.down = Eigen::AngleAxisd(-angle, axis) * pile.down;
  return pile;
}

TiltLimit tilt_limit(const Pile& pile, const Vec3& axis, const Motions& displacement, const Stop& stop) {
  return TiltSearch(pile, axis, displacement, stop).run();
}

std::optional<double> critical_tilt(const Pile& pile, const Vec3& axis, const Stop& stop) {
  const Judgement judged = judge(pile, stop);
  return judged.verdict == Verdict::stands ? tilt_limit(pile, axis, judged.displacement, stop).angle : 0;
}

}  // namespace dismantle::statics
