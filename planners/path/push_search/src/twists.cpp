#include "dismantle/push/twists.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>

namespace dismantle::push {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Contacts further away than this (assembly units) do not constrain.
constexpr double kTouching = 0.05;
/// Fewer contacts say nothing about a surface.
constexpr std::size_t kLeastContacts = 6;
/// Eigenvalues below this share of the largest belong to motions that slip: facets of round fits and what a clearance
/// lets stand askew make them differ from zero.
constexpr double kSlips = 0.02;
/// With much play nothing slips exactly: those below this share count, too, if they are not so many times stiffer than
/// the last that slips, and the next one is by so much stiffer than they.
constexpr double kNearlySlips = 0.06, kAsStiff = 20, kSlipGap = 3;
/// Normals nearer than this (cosine) are of one flat face; it is square to an axis nearer than that.
constexpr double kFlat = 0.99999, kEndFace = 0.98;
/// Share of turning from which on a twist has an axis; twists that differ by less are one.
constexpr double kMostlyTurns = 0.5, kAlike = 5e-3;
/// Singular values below this: no turn in it.
constexpr double kNoTurn = 0.1;

Twist normalized(const Vec6& t, double radius) {
  Twist twist{t.head<3>(), t.tail<3>() / radius};
  const double size = twist.linear.norm() + radius * twist.angular.norm();
  twist.linear /= size;
  twist.angular /= size;
  return twist;
}

bool alike(const Twist& a, const Twist& b, double radius) {
  const auto apart = [&](double sign) {
    return (a.linear - sign * b.linear).norm() + radius * (a.angular - sign * b.angular).norm();
  };
  return std::min(apart(1), apart(-1)) < kAlike;
}

/// The first coordinate that is clearly not zero is positive: eigenvectors come with either sign.
Vec6 oriented(Vec6 t) {
  for (int k = 5; k >= 0; --k)
    if (std::abs(t[k]) > 0.1) return t[k] > 0 ? t : Vec6(-t);
  return t;
}

}  // namespace

Pose moved(const Pose& pose, const Twist& twist, const Eigen::Vector3d& center, double way) {
  const double rate = twist.angular.norm();
  if (rate * way < 1e-12) return {way * twist.linear + pose.t, pose.q};
  const Eigen::Vector3d axis = twist.angular / rate;
  const Eigen::Vector3d on_axis = center + axis.cross(twist.linear) / rate;
  const Eigen::Quaterniond turn = rotation_from_vector(way * twist.angular);
  const Eigen::Vector3d t = turn * (pose.t - on_axis) + on_axis + way * axis.dot(twist.linear) * axis;
  return {t, (turn * pose.q).normalized()};
}

namespace {

/// Slippage of the rows that are kept.
std::vector<Twist> slippage(const std::vector<Vec6>& rows, double radius) {
  std::vector<Twist> twists;
  if (rows.size() < kLeastContacts) return twists;
  Mat6 mean = Mat6::Zero();
  for (const Vec6& j : rows) mean += j * j.transpose();
  mean /= static_cast<double>(rows.size());
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(mean);
  int slips = 0;
  const auto& stiff = eigen.eigenvalues();
  while (slips < 6 && stiff[slips] < kSlips * stiff[5]) ++slips;
  int nearly = slips;
  const double like = slips > 0 ? std::min(kNearlySlips * stiff[5], kAsStiff * stiff[slips - 1]) : 0;
  while (nearly < 6 && stiff[nearly] < like) ++nearly;
  if (nearly < 6 && nearly > slips && stiff[nearly] > kSlipGap * stiff[nearly - 1]) slips = nearly;
  if (slips > 4) return twists;  // all but free: the contacts do not tell where to
  if (slips == 0) slips = 1;     // the least stiff one, then; the simulator will tell
  const Eigen::MatrixXd space = eigen.eigenvectors().leftCols(slips);

  // Rotate the basis so that turns come first, pure translations last.
  const Eigen::JacobiSVD<Eigen::MatrixXd> turns(space.bottomRows<3>(), Eigen::ComputeFullV);
  const Eigen::MatrixXd basis = space * turns.matrixV();
  const auto turn_size = [&](int i) { return i < turns.singularValues().size() ? turns.singularValues()[i] : 0.0; };
  int first_translation = 0;
  while (first_translation < slips && turn_size(first_translation) >= kNoTurn) ++first_translation;
  for (int i = 0; i < first_translation; ++i) {
    Vec6 t = basis.col(i);
    for (int k = first_translation; k < slips; ++k) {
      const Eigen::Vector3d along = basis.col(k).head<3>();
      t.head<3>() -= along * (along.dot(t.head<3>()) / along.squaredNorm());
    }
    twists.push_back(normalized(oriented(t), radius));
  }
  for (int k = first_translation; k < slips; ++k) {
    Vec6 t = Vec6::Zero();
    t.head<3>() = basis.col(k).head<3>();
    twists.push_back(normalized(oriented(t), radius));
  }
  return twists;
}

/// The rows but those of a flat face square to the axis: it blocks one way along it, and a screw may lead the other.
std::vector<Vec6> without_end_face(const std::vector<Vec6>& rows, const Eigen::Vector3d& axis) {
  std::vector<Vec6> others;
  for (const Vec6& j : rows) {
    const auto flat_with = [&](const Vec6& k) { return std::abs(k.head<3>().dot(j.head<3>())) > kFlat; };
    const bool faces_along = std::abs(j.head<3>().dot(axis)) > kEndFace;
    if (!faces_along || static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), flat_with)) < kLeastContacts)
      others.push_back(j);
  }
  return others;
}

}  // namespace

std::vector<Twist> slipping(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving,
                            const Eigen::Vector3d& center, double radius) {
  std::vector<Vec6> rows;
  for (const Contact& c : contacts) {
    if (c.depth < -kTouching || c.on_edge) continue;
    if (std::any_of(moving.begin(), moving.end(), [&](const PlacedPart& m) { return m.part == c.other; })) continue;
    Vec6 j;
    j.head<3>() = c.normal;
    j.tail<3>() = (c.point - center).cross(c.normal) / radius;
    rows.push_back(j);
  }
  std::vector<Twist> twists = slippage(rows, radius);
  const std::size_t of_all = twists.size();
  for (std::size_t i = 0; i < of_all; ++i) {
    if (twists[i].angular.norm() * radius < kMostlyTurns) continue;
    const std::vector<Vec6> others = without_end_face(rows, twists[i].angular.normalized());
    if (others.size() == rows.size()) continue;
    for (const Twist& t : slippage(others, radius)) {
      const bool known = std::any_of(twists.begin(), twists.end(), [&](const Twist& k) { return alike(k, t, radius); });
      if (!known) twists.push_back(t);
    }
  }
  return twists;
}

}  // namespace dismantle::push
