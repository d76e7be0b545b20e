#include "verify/pocket/pin_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace dismantle::verify {
namespace {

constexpr double kStride = 0.006;  // assembly units, the largest first step
constexpr int kSteps = 60;         // in one direction, ever faster
constexpr double kFaster = 1.15, kFastest = 5;

class Walker {
 public:
  Walker(const Pinned& pinned, double far) : pinned_(pinned), far_(far) {
    for (std::uint32_t i = 0; i < pinned.pins().size(); ++i) order_.push_back(i);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t x, std::uint32_t y) { return pinned.pins()[x].room < pinned.pins()[y].room; });
    poses_.push_back(Vector6::Zero());
  }

  PinWalk run(std::size_t looks, const RunContext& context) {
    while (looks_ < looks && !walk_.away && !context.should_stop()) fly();
    walk_.met.assign(met_.begin(), met_.end());
    return walk_;
  }

 private:
  bool open(const Vector6& x) {
    ++looks_;
    const Stance stance(pinned_, x);
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const Pin& pin = pinned_.pins()[order_[k]];
      if (pin.room > stance.moved() || !stance.inside(pin)) continue;
      met_.insert(order_[k]);
      // What was in the way last is asked first.
      std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(k),
                  order_.begin() + static_cast<std::ptrdiff_t>(k) + 1);
      return false;
    }
    return true;
  }

  /// Straight on from one of the poses, often from one of the outermost.
  void fly() {
    std::size_t from = rng_.uniform() < 0.6 ? furthest_[rng_.below(12)] : rng_.below(poses_.size());
    const double size = kStride * std::exp2(-2 * rng_.uniform());
    Vector6 step;
    for (int d = 0; d < 6; ++d) step[d] = rng_.uniform(-1, 1) * size / (d < 3 ? pinned_.radius() : 1.0);
    double faster = 1;
    for (int k = 0; k < kSteps; ++k) {
      const Vector6 next = poses_[from] + faster * step;
      if (!open(next)) {
        if (k == 0 || faster <= 1) return;
        faster = 1;
        continue;
      }
      from = poses_.size();
      poses_.push_back(next);
      for (int d = 0; d < 6; ++d) {
        const auto at = static_cast<std::size_t>(2 * d);
        if (next[d] < walk_.lo[d]) walk_.lo[d] = next[d], furthest_[at] = from;
        if (next[d] > walk_.hi[d]) walk_.hi[d] = next[d], furthest_[at + 1] = from;
      }
      if (next.tail<3>().norm() > far_) {
        walk_.away = true;
        return;
      }
      faster = std::min(kFastest, kFaster * faster);
    }
  }

  const Pinned& pinned_;
  double far_;
  Rng rng_{7};
  PinWalk walk_;
  std::vector<std::uint32_t> order_;
  std::vector<Vector6> poses_;
  std::array<std::size_t, 12> furthest_{};
  std::set<std::uint32_t> met_;
  std::size_t looks_ = 0;
};

}  // namespace

PinWalk walk_with_pins(const Pinned& pinned, std::size_t looks, double far, const RunContext& context) {
  return Walker(pinned, far).run(looks, context);
}

}  // namespace dismantle::verify
