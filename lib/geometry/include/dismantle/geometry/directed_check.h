/// Certified continuous check of the surface of one solid against another solid that it moves past.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/patch.h"
#include "dismantle/geometry/relative_motion.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/geometry/unrolled_mesh.h"
#include "dismantle/geometry/walls.h"
#include "dismantle/geometry/winding.h"
#include "dismantle/run_context.h"

namespace dismantle::geometry {

/// Depth limits. The limit for a point of a triangle is overlap + min(penetration, thickness / 4).
struct Limits {
  double overlap = 0;            ///< >= 0, of the pair in assembled position
  double penetration = 0;        ///< > 0
  const Aabb* exempt = nullptr;  ///< box without a depth limit, may be null; see exempts()
  /// Largest penetration bound of the caller, >= penetration; 0: equal to it. Cells of unrolled meshes are a share of
  /// it.
  double tolerance = 0;
  /// True if the exempt box contains the point when `a` or `b`, with the point fixed to it, is in assembled position.
  /// `in_a`, `in_b`: the point in the frames of both solids.
  bool exempts(const Solid& a, const Eigen::Vector3d& in_a, const Solid& b, const Eigen::Vector3d& in_b) const {
    return exempt != nullptr && (exempt->contains(a.frame * in_a) || exempt->contains(b.frame * in_b));
  }
  double at(double thickness) const { return overlap + std::min(penetration, 0.25 * thickness); }
  double most() const { return overlap + penetration; }
  double cells_from() const { return tolerance > 0 ? tolerance : penetration; }
};

/// Result of the check of one direction.
enum class Answer {
  certified,
  violated,   ///< a point beyond its limit was found
  uncertain,  ///< undecided at the resolution limit
  exhausted,  ///< undecided within the budget
};

/// Result of the check of one direction, and the place where it failed.
struct Finding {
  Answer answer = Answer::certified;
  // Unless certified:
  Eigen::Vector3d point = Eigen::Vector3d::Zero();             ///< frame of its part
  bool of_second = false;                                      ///< `point` belongs to the second part of the pair
  double depth = 0;                                            ///< measured at `point`; negative outside
  double thickness = std::numeric_limits<double>::infinity();  ///< of the triangle that contains `point`
  double time = 0;
};

/// Work allowed and done, in elementary sweep tests and patches: counts make results independent of the machine.
struct Budget {
  std::uint64_t tests_left = 0;
  std::uint64_t patches_left = 0;
  std::uint64_t tests_done = 0;
  const RunContext* context = nullptr;  ///< may be null; a stop request sets tests_left to 0
  /// Share of the allowed penetration, > 0. An undecided patch whose radius and motion in the time interval are below
  /// it is not divided further: the check ends as uncertain.
  double resolution = 0.125;
  bool spend_test() {
    if (context != nullptr && tests_done % 256 == 0 && context->should_stop()) tests_left = 0;
    if (tests_left == 0) return false;
    --tests_left;
    ++tests_done;
    return true;
  }
  bool spend_tests(std::uint64_t count) {
    if (context != nullptr && context->should_stop()) tests_left = 0;
    const std::uint64_t spent = std::min(count, tests_left);
    tests_left -= spent;
    tests_done += spent;
    return spent == count;
  }
};

/// Checks the surface of `a` against `b`. One object per check. Idle threads of the executor in the budget's context
/// help; neither the finding nor the budget spent depends on them.
///
/// If one of them is open, the check needs no inside. It is certified if one displaced copy of all of `a` meets no
/// triangle of `b` at any time. Each vertex of the copy is displaced by no more than its limit: into the part if `a` is
/// closed, else each sheet to its side of `b` when the motion begins (find_sides()), which must be its side when the
/// motion ends, too: the next motion begins there.
class DirectedCheck {
 public:
  DirectedCheck(const Solid& a, const Solid& b, const RelativeMotion& motion, const Limits& limits, Budget& budget,
                Lean lean = Lean::back);
  Finding run();
  /// After a certified run: true if the vertex rule certified all of it. Then a single shrunken copy of A stayed clear
  /// of the surface of B at all times.
  bool by_shrunken_copy() const { return by_shrunken_copy_; }

 private:
  struct Interval {
    double s0, s1, margin;  // margin: of the whole box
    Placement at0, at1;
    RelativeMotion::Bend bend;
  };
  struct Piece {  // certified by the vertex rule, except for the side of B's surface
    std::uint32_t patch;
    double s0, s1;
  };
  using List = std::vector<std::uint32_t>;
  struct Stretch {  // of a winding: instants, and the patches that are not certified between them
    std::size_t from, to;
    List list;
  };

  Interval interval(double s0, double s1) const;
  double middle(const Interval& i) const;
  std::uint32_t add(const Patch& patch);
  Patch patch_of(std::uint32_t triangle, double side) const;
  void collect(const Interval& i, std::uint32_t node, List& list);
  bool descend(double s0, double s1);
  bool wind(const Winding& winding);
  bool wind(const UnrolledMesh& other, const Winding& winding, std::size_t from, std::size_t to, List list);
  bool clear_unrolled(const UnrolledMesh& other, const Winding& winding, std::size_t from, std::size_t to, List& list);
  bool wind_in_cells(const Winding& winding, double cell, Stretch stretch);
  bool halve(const UnrolledMesh& other, const Winding& winding, Stretch whole, std::size_t before,
             std::vector<Stretch>& rest);
  UnrolledMesh unrolled(const Winding& winding, const Stretch& stretch, double cell) const;
  bool process(const Interval& i, List list, bool vertex_rule);
  bool settle_all(const Interval& i, List list, bool vertex_rule, List& later);
  bool settle_in_turn(const Interval& i, List list, bool vertex_rule, List& later);
  // directed_share.cpp: work shared with idle threads
  struct Share;
  DirectedCheck(const DirectedCheck& whole, const List& list, Budget& budget);
  bool has_help() const;
  std::vector<List> cut(const List& list) const;
  bool settle_shared(const Interval& i, const List& list, bool vertex_rule, List& later);
  bool take_over(Share& share, List& later);
  struct QuickTest {
    bool done = false, clear = false;
    std::uint64_t cells = 0;
  };
  std::vector<QuickTest> quick_tests(const UnrolledMesh& other, const Winding& winding, std::size_t from,
                                     std::size_t to, const List& list) const;
  QuickTest quick_test(const UnrolledMesh& other, const Placement& start, std::size_t from, std::size_t to,
                       std::uint32_t patch) const;
  bool settle(const Interval& i, std::uint32_t id, bool vertex_rule, List& same, List& later);
  bool clear(const Interval& i, double margin, const Corners& moved, bool& far);
  bool worth_a_test(const Interval& i, double margin, std::uint32_t triangle) const;
  bool outside(const Placement& place, const Corners& moved) const;
  bool sides();
  // exempt_box.cpp: the box without a depth limit
  bool exempt(const Interval& i, double margin, const Patch& patch) const;
  bool meets_exempt_only(const Interval& i, double margin, const Patch& patch) const;
  std::optional<Ridge> exempt_border(const Patch& patch) const;
  // walls.cpp: if a part is open
  bool rests_at(double time);
  bool fail_at_wall(const Patch& patch, double time);
  bool settle_wall(const Interval& i, std::uint32_t id, List& later);
  bool fail(Answer answer, const Eigen::Vector3d& point, double depth, std::uint32_t triangle, double time);
  double allowed(const Patch& patch) const { return limits_.at(a_.thickness[patch.triangle]); }
  /// Displacement of the patch: slightly below the limit, so that rounding cannot exceed the limit.
  double displacement(const Patch& patch) const { return allowed(patch) * (1 - kRounding); }

  const Solid& a_;
  const Solid& b_;
  const RelativeMotion& motion_;
  Limits limits_;
  Budget& budget_;
  std::vector<Patch> patches_;
  std::vector<std::uint32_t> patch_of_;  // by triangle of A; kNoIndex until needed
  /// By triangle of A: recent tests with this margin or more proved nothing. Shares have no triangle in common.
  std::shared_ptr<std::vector<double>> unclear_;
  bool walls_ = false;  // a part is open
  Lean lean_ = Lean::back;
  Sides sides_;  // by sheet of A, if there are walls
  std::vector<Piece> pieces_;
  bool by_shrunken_copy_ = true;
  Finding finding_;
};

}  // namespace dismantle::geometry
