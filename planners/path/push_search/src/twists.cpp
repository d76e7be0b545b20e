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
/// Singular values below this: no turn in it.
constexpr double kNoTurn = 0.1;

Twist normalized(const Vec6& t, double radius) {
  Twist twist{t.head<3>(), t.tail<3>() / radius};
  const double size = twist.linear.norm() + radius * twist.angular.norm();
  twist.linear /= size;
  twist.angular /= size;
  return twist;
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

std::vector<Twist> slipping(const std::vector<Contact>& contacts, const std::vector<PlacedPart>& moving,
                            const Eigen::Vector3d& center, double radius) {
  Mat6 mean = Mat6::Zero();
  std::size_t count = 0;
  for (const Contact& c : contacts) {
    if (c.depth < -kTouching || c.on_edge) continue;
    if (std::any_of(moving.begin(), moving.end(), [&](const PlacedPart& m) { return m.part == c.other; })) continue;
    Vec6 j;
    j.head<3>() = c.normal;
    j.tail<3>() = (c.point - center).cross(c.normal) / radius;
    mean += j * j.transpose();
    ++count;
  }
  std::vector<Twist> twists;
  if (count < kLeastContacts) return twists;
  mean /= static_cast<double>(count);
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(mean);
  int slips = 0;
  while (slips < 6 && eigen.eigenvalues()[slips] < kSlips * eigen.eigenvalues()[5]) ++slips;
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

}  // namespace dismantle::push
