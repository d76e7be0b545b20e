#include "verify/pair_check.h"

#include "verify/starts_off.h"

namespace dismantle::verify {
namespace {

Finding second_of_pair(Finding f) {
  f.of_second = true;
  return f;
}

}  // namespace

Finding check_pair(const Solid& a, const Solid& b, const RelativeMotion& forward, const RelativeMotion& backward,
                   const Limits& limits, Budget& budget) {
  const bool swap = b.mesh.triangles.size() < a.mesh.triangles.size();
  const Solid &first = swap ? b : a, &second = swap ? a : b;
  const RelativeMotion &there = swap ? backward : forward, &back = swap ? forward : backward;

  DirectedCheck check(first, second, there, limits, budget);
  const Finding one = check.run();
  if (one.answer != Answer::certified) return swap ? second_of_pair(one) : one;
  // If one shrunken copy of `first` never touched the surface of `second`, and `second` is not within it, then the
  // points of `second` in `first` are all in the layer that was taken off: no deeper than the limit either.
  if (check.by_shrunken_copy() && starts_off(second, first, Placement(back.at(0)), limits.most())) return one;
  const Finding two = DirectedCheck(second, first, back, limits, budget).run();
  return swap ? two : second_of_pair(two);
}

}  // namespace dismantle::verify
