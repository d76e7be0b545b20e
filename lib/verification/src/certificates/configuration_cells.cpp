/// configuration_cells: a region of relative poses that no motion leaves.
///
/// Six coordinates give the pose of one part relative to the other: a rotation vector about the centre of the part's
/// box, and a shift of that centre, all 0 when assembled. The certificate has a box of poses, and a tree that divides
/// the box again and again. Pieces also lose poses that no valid motion reaches (below). The remaining pieces are the
/// leaves. A valid motion within the box is always in a leaf. Leaves are closed, so the motion passes only between
/// leaves that touch. Hence, if no leaf that is linked to the assembled pose touches the border of the box, no motion
/// leaves the box. A motion that could take the parts apart could continue to anywhere.
///
/// Why poses are never reached: a point of one part that is deeper in it than the pair may penetrate never enters the
/// other part. Over a piece, its position is linear in the coordinates up to a bounded remainder, so it is in a box.
/// The free part of that box lies beyond a plane (FreeBound), which gives a linear inequality for the coordinates. A
/// sum of these with multipliers >= 0 bounds a coordinate, or has no solution within the piece.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "certificates/body.h"
#include "certificates/checker.h"
#include "certificates/free_bound.h"
#include "certificates/leaf_boxes.h"

namespace dismantle::certificates {
namespace {

using Mat3 = Eigen::Matrix3d;

/// For a rotation vector w, as power series in [w x]: exp(w), and J(w) with d exp(w) p = (J(w) dw) x exp(w) p.
struct Turn {
  Mat3 exp = Mat3::Identity(), left = Mat3::Identity();

  explicit Turn(const Vec3& w) {
    Mat3 k, power = Mat3::Identity();
    k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    for (int n = 1; n < 60; ++n) {  // |w|^60 / 60! is negligible for |w| < 6
      power = power * k / n;
      exp += power;
      left += power / (n + 1);
    }
  }
};

/// A point of one part, and the body of the other part that it never enters.
struct OutsidePoint {
  bool of_first = true;
  Vec3 at;  ///< assembled
  const FreeBound* obstacle = nullptr;
};

/// normal . (x - middle of the piece) <= most. `most` is minus infinity if the point has no free position.
struct PoseRow {
  Vec6 normal = Vec6::Zero();
  double most = 0;
};

class Decomposition {
 public:
  Decomposition(const Certificate& certificate, const SeparationQuery& query, const RunContext& context)
      : numbers_(certificate.numbers),
        first_(certificate.parts.front()),
        second_(certificate.parts.back()),
        query_(query),
        context_(context),
        tree_(certificate.numbers.at("tree")) {}

  std::string objection() {
    if (std::string wrong = read_points(); !wrong.empty()) return wrong;
    const auto& box = list("box");
    const PoseBox all{Eigen::Map<const Vec6>(box.data()), Eigen::Map<const Vec6>(box.data() + 6)};
    if (!((all.hi - all.lo).minCoeff() > 0)) return "its box is empty";
    if (!(all.lo.head<3>().cwiseAbs().cwiseMax(all.hi.head<3>().cwiseAbs()).norm() < 6))
      return "its box has turns of more than a whole one";
    if (const char* wrong = walk(all)) return fmt::format("at number {} of its tree: {}", at_, wrong);
    if (list("cells").front() != static_cast<double>(leaves_)) return "it has not as many cells as it says";
    const auto reached = linked_to_zero(boxes_, context_);
    if (context_.should_stop()) return "the check was stopped";
    if (!reached) return "the assembled pose is in none of its cells";
    if (!((reached->lo - all.lo).minCoeff() > 0 && (all.hi - reached->hi).minCoeff() > 0))
      return "its cells lead out of its box";
    return objection_to_claims(*reached);
  }

 private:
  const std::vector<double>& list(const char* name) const { return numbers_.at(name); }

  std::string read_points() {
    const auto &points = list("points"), &directions = list("directions");
    if (points.size() % 5 != 0 || directions.size() % 3 != 0) return "its lists have not the right length";
    Aabb box;
    for (const Body& b : bodies_of(query_, first_)) box.extend(b.box);
    center_ = box.center();
    std::map<const Body*, const FreeBound*> known;
    for (std::size_t k = 0; k < points.size(); k += 5) {
      if (context_.should_stop()) return "the check was stopped";
      OutsidePoint p;
      p.of_first = points[k] != 0;
      const auto& others = bodies_of(query_, p.of_first ? second_ : first_);
      if (!(points[k + 1] >= 0 && points[k + 1] < static_cast<double>(others.size())))
        return fmt::format("point {}: its obstacle is none", k / 5);
      const Body& obstacle = others[static_cast<std::size_t>(points[k + 1])];
      p.at = Vec3(points[k + 2], points[k + 3], points[k + 4]);
      if (const char* wrong = objection_to_outside_point(query_, p.of_first ? first_ : second_,
                                                         p.of_first ? second_ : first_, obstacle, p.at))
        return fmt::format("point {}: {}", k / 5, wrong);
      const FreeBound*& free = known[&obstacle];
      if (free == nullptr) free = free_.emplace_back(std::make_unique<FreeBound>(obstacle)).get();
      p.obstacle = free;
      points_.push_back(p);
    }
    for (std::size_t k = 0; k < directions.size(); k += 3) {
      directions_.push_back(Vec3(directions[k], directions[k + 1], directions[k + 2]).normalized());
      if (!directions_.back().allFinite()) return "a direction of it is none";
    }
    return {};
  }

  /// The next number of the tree; NaN at its end.
  double next() { return at_ < tree_.size() ? tree_[at_++] : std::numeric_limits<double>::quiet_NaN(); }
  /// Reads the next number as an index below `count`. False: it is not one.
  bool next_index(std::size_t count, std::size_t& index) {
    const double x = next();
    if (!(x >= 0 && x < static_cast<double>(count)) || x != std::floor(x)) return false;
    index = static_cast<std::size_t>(x);
    return true;
  }

  /// Goes through the tree. Returns nullptr if it holds; boxes_ are then its leaves.
  const char* walk(const PoseBox& all) {
    std::vector<PoseBox> pending{all};
    bool empty = false;  // the piece has no free pose
    begin_round(all);
    while (!pending.empty()) {
      if (context_.should_stop()) return "the check was stopped";
      std::size_t entry = 0, axis = 0;
      if (!next_index(4, entry)) return "it ends too early, or has an entry of no kind";
      PoseBox& piece = pending.back();
      if (entry == 0) {
        ++leaves_;
        if (!empty && ((piece.hi - piece.lo).array() >= 0).all()) boxes_.push_back(piece);
        pending.pop_back();
      } else if (entry == 1) {
        if (!next_index(6, axis)) return "it cuts across no coordinate";
        const auto d = static_cast<Eigen::Index>(axis);
        PoseBox below = piece;
        below.hi[d] = piece.lo[d] = next();
        if (empty || !(below.lo[d] <= below.hi[d] && piece.lo[d] <= piece.hi[d])) return "it cuts outside of a piece";
        pending.push_back(below);
      } else if (entry == 3) {
        if (const char* wrong = move(piece, empty)) return wrong;
        continue;
      }
      empty = empty && entry == 2;
      if (!pending.empty()) begin_round(pending.back());
    }
    return at_ == tree_.size() ? nullptr : "it goes on after its last piece";
  }

  void begin_round(const PoseBox& piece) {
    middle_ = 0.5 * (piece.lo + piece.hi);
    half_ = 0.5 * (piece.hi - piece.lo);
    turn_.emplace(middle_.head<3>());
    back_.emplace(Vec3(-middle_.head<3>()));
    rows_.clear();
  }

  /// Moves a face of the piece, or marks the piece as empty.
  const char* move(PoseBox& piece, bool& empty) {
    std::size_t face = 0, count = 0;
    if (!next_index(13, face)) return "it moves no face";
    const double to = face < 12 ? next() : 0, side = face % 2 == 1 ? 1 : -1;
    const auto d = static_cast<Eigen::Index>(face / 2);
    if (!std::isfinite(to) || !next_index(tree_.size(), count)) return "a sum of it is none";
    Vec6 left = face < 12 ? Vec6(side * Vec6::Unit(d)) : Vec6(Vec6::Zero());
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t point = 0, direction = 0;
      if (!next_index(points_.size(), point) || !next_index(directions_.size(), direction))
        return "a half space is none";
      const double y = next();
      if (!(y >= 0)) return "a multiplier is not positive";
      const PoseRow& row = row_of(point, direction);
      if (std::isinf(row.most) && y > 0 && face == 12) {
        empty = true;
        return nullptr;
      }
      left -= y * row.normal;
      sum += y * row.most;
    }
    // Coordinates relative to the middle.
    const Vec6 lo = piece.lo - middle_, hi = piece.hi - middle_;
    sum += left.cwiseProduct(lo).cwiseMax(left.cwiseProduct(hi)).sum();
    if (face == 12) {
      if (!(sum < 0)) return "a piece is not empty";
      empty = true;
      return nullptr;
    }
    if (!(sum + side * middle_[d] <= side * to)) return "poses that it leaves out may be reached";
    double& bound = (side > 0 ? piece.hi : piece.lo)[d];
    if (!(side * to <= side * bound)) return "a face moves outwards";
    bound = to;
    return nullptr;
  }

  const PoseRow& row_of(std::size_t point, std::size_t direction) {
    const auto [known, fresh] = rows_.try_emplace({point, direction});
    if (fresh) known->second = row(points_[point], directions_[direction]);
    return known->second;
  }

  /// Relative to the centre, points of the first part are at exp(w) p + s. In the frame of the first part, those of the
  /// second are at exp(-w) (p - s). The second derivative of exp(w) p by w is at most |p|, since rotations keep
  /// lengths.
  PoseRow row(const OutsidePoint& point, const Vec3& direction) const {
    const Vec3 shift = middle_.tail<3>(), from = point.at - center_;
    const double turns = half_.head<3>().norm(), shifts = half_.tail<3>().norm();
    Vec3 place;
    Eigen::Matrix<double, 3, 6> slope;
    double rest = 0.5 * turns * turns;
    if (point.of_first) {
      place = turn_->exp * from;
      for (Eigen::Index k = 0; k < 3; ++k) slope.col(k) = turn_->left.col(k).cross(place);
      slope.rightCols<3>() = Mat3::Identity();
      rest *= from.norm();
      place += shift;
    } else {
      place = back_->exp * (from - shift);
      for (Eigen::Index k = 0; k < 3; ++k) slope.col(k) = -back_->left.col(k).cross(place);
      slope.rightCols<3>() = -back_->exp;
      rest = rest * (from - shift).norm() + turns * shifts;
    }
    place += center_;
    const Eigen::Quaterniond to_local = point.obstacle->frame().conjugate();
    const Eigen::Matrix<double, 3, 6> local = to_local.toRotationMatrix() * slope;
    const Vec3 reach = local.cwiseAbs() * half_ + Vec3::Constant(rest);
    const double least = point.obstacle->least(to_local * place, reach, to_local * direction);
    if (!std::isfinite(least)) return {Vec6::Zero(), -std::numeric_limits<double>::infinity()};
    // direction . (place + slope x + rest) >= least
    return {-slope.transpose() * direction, direction.dot(place) + rest - least};
  }

  std::string objection_to_claims(const PoseBox& reached) const {
    const Vec6 lower = Eigen::Map<const Vec6>(list("lower").data()),
               upper = Eigen::Map<const Vec6>(list("upper").data());
    if (!((reached.lo - lower).minCoeff() >= 0 && (upper - reached.hi).minCoeff() >= 0))
      return "its parts move further than it says";
    const Vec6 most = lower.cwiseAbs().cwiseMax(upper.cwiseAbs());
    if (!(list("shift").front() >= most.tail<3>().norm() * (1 - 1e-9)) ||
        !(list("turn").front() >= most.head<3>().norm() * (1 - 1e-9)))
      return "its bounds are wider than it says";
    const double depth = allowed_depth(query_, first_, second_);
    if (!(std::abs(list("depth").front() - depth) <= 1e-9 * depth)) return "it is about another penetration";
    return {};
  }

  const std::map<std::string, std::vector<double>>& numbers_;
  PartId first_, second_;
  const SeparationQuery& query_;
  const RunContext& context_;
  const std::vector<double>& tree_;
  std::size_t at_ = 0;  // in the tree
  Vec3 center_ = Vec3::Zero();
  std::vector<std::unique_ptr<FreeBound>> free_;
  std::vector<OutsidePoint> points_;
  std::vector<Vec3> directions_;
  std::vector<PoseBox> boxes_;
  std::size_t leaves_ = 0;
  // For the current round.
  Vec6 middle_, half_;
  std::optional<Turn> turn_, back_;
  std::map<std::pair<std::size_t, std::size_t>, PoseRow> rows_;
};

}  // namespace

std::string objection_to_configuration_cells(const Certificate& certificate, const SeparationQuery& query,
                                             const RunContext& context) {
  return Decomposition(certificate, query, context).objection();
}

}  // namespace dismantle::certificates
