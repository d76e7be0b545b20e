#include "dismantle/geometry/slippage.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "dismantle/geometry/numerics.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Fewer contacts than a rigid body has degrees of freedom say nothing about a surface.
constexpr std::size_t kLeastContacts = 6;
/// Cosine between an axis and the normal of a face that counts as square to it: 11 degrees, for chamfers and facets.
constexpr double kEndFace = 0.98;

/// The speed across the surface at a sample is the product of this row with (linear, lever * angular): translations
/// and rotations are both lengths. `arm`: from the centre of the twists to the sample.
Vec6 speed_across(const Vec3& arm, const Vec3& normal, double lever) {
  Vec6 row;
  row << normal, arm.cross(normal) / lever;
  return row;
}

void add_square(Mat6& form, const Vec6& row, double weight) { form += weight * row * row.transpose(); }

/// (linear, angular) as (angular, linear), or back.
Mat6 halves_swapped(const Mat6& form) {
  Mat6 swapped;
  swapped << form.bottomRightCorner<3, 3>(), form.bottomLeftCorner<3, 3>(), form.topRightCorner<3, 3>(),
      form.topLeftCorner<3, 3>();
  return swapped;
}

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
  return std::min(apart(1), apart(-1)) < 5e-3;  // as a share of the size of a twist, which is 1
}

/// The last coordinate that is clearly not zero becomes positive: eigenvectors come with either sign.
Vec6 oriented(Vec6 t) {
  for (int k = 5; k >= 0; --k)
    if (std::abs(t[k]) > 0.1) return t[k] > 0 ? t : Vec6(-t);
  return t;
}

/// How many of the eigenvalues (ascending) belong to motions that slip.
int count_slipping(const Vec6& stiffness) {
  // Below 2 % of the largest: the facets of round fits, and clearance, make eigenvalues of slippable motions differ
  // from zero.
  int slips = 0;
  while (slips < 6 && stiffness[slips] < 0.02 * stiffness[5]) ++slips;
  return slips;
}

/// A basis of the columns' span: rotations first, each with the least translation, then pure translations.
std::vector<Twist> separated(const Eigen::MatrixXd& space, double radius) {
  const auto slips = static_cast<int>(space.cols());
  const Eigen::JacobiSVD<Eigen::MatrixXd> turns(space.bottomRows<3>(), Eigen::ComputeFullV);
  const Eigen::MatrixXd basis = space * turns.matrixV();
  const auto turn_size = [&](int i) { return i < turns.singularValues().size() ? turns.singularValues()[i] : 0.0; };
  int first_translation = 0;
  // A motion with a smaller singular value of its rotation is a translation.
  while (first_translation < slips && turn_size(first_translation) >= 0.1) ++first_translation;
  std::vector<Twist> twists;
  for (int i = 0; i < first_translation; ++i) {
    Vec6 t = basis.col(i);
    for (int k = first_translation; k < slips; ++k) {
      const Vec3 along = basis.col(k).head<3>();
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

/// What slips; where nothing does and `or_least_stiff`, the least stiff motion.
std::vector<Twist> motions_along(const std::vector<Vec6>& rows, double radius, bool or_least_stiff) {
  if (rows.size() < kLeastContacts) return {};
  Mat6 mean = Mat6::Zero();
  for (const Vec6& row : rows) add_square(mean, row, 1);
  mean /= static_cast<double>(rows.size());
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(mean);
  int slips = count_slipping(eigen.eigenvalues());
  if (slips > 4) return {};  // all but free: the contacts do not tell where to
  if (slips == 0 && !or_least_stiff) return {};
  if (slips == 0) slips = 1;  // a simulation will tell whether it is possible
  return separated(eigen.eigenvectors().leftCols(slips), radius);
}

/// The rows except those of a flat face square to the axis: it blocks the motion one way along the axis, and a screw
/// may lead the other way.
std::vector<Vec6> without_end_face(const std::vector<Vec6>& rows, const Vec3& axis) {
  std::vector<Vec6> others;
  for (const Vec6& j : rows) {
    const auto flat_with = [&](const Vec6& k) { return std::abs(k.head<3>().dot(j.head<3>())) > kSameDirection; };
    const bool faces_along = std::abs(j.head<3>().dot(axis)) > kEndFace;
    if (!faces_along || static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), flat_with)) < kLeastContacts)
      others.push_back(j);
  }
  return others;
}

/// Contacts face along the axis as well as against it.
bool blocked_both_ways(const std::vector<Vec6>& rows, const Vec3& axis) {
  const auto faces = [&](double sign) {
    return std::any_of(rows.begin(), rows.end(),
                       [&](const Vec6& j) { return sign * j.head<3>().dot(axis) > kEndFace; });
  };
  return faces(1) && faces(-1);
}

/// The places whose mean, with the weights, is exact for quadratic forms: the middles of the edges of all triangles.
struct WeightedSample {
  Vec3 arm, normal;  ///< from the centre of the twists
  double weight;     ///< a third of twice the area of its triangle
};

std::vector<WeightedSample> samples_of(const Mesh& mesh, const Vec3& center) {
  std::vector<WeightedSample> samples;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0) - center, b = mesh.vertex(t, 1) - center, c = mesh.vertex(t, 2) - center;
    const Vec3 across = (b - a).cross(c - a);
    const double weight = across.norm() / 3;
    if (!(weight > 0)) continue;
    for (const Vec3& arm : {Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)})
      samples.push_back({arm, across.normalized(), weight});
  }
  return samples;
}

}  // namespace

std::vector<Twist> slippable_motions(const Mesh& mesh, const Vec3& center) {
  const std::vector<WeightedSample> samples = samples_of(mesh, center);
  double area = 0, squares = 0;
  for (const WeightedSample& s : samples) {
    area += s.weight;
    squares += s.weight * s.arm.squaredNorm();
  }
  if (!(area > 0)) return {};
  // Rotations are measured by how far they move points: all six coordinates are lengths.
  const double lever = std::sqrt(squares / area);
  Mat6 across = Mat6::Zero(), speed = Mat6::Zero();
  for (const WeightedSample& s : samples) {
    const Vec3 arm = s.arm / lever;
    add_square(across, speed_across(arm, s.normal, 1), s.weight / area);
    Eigen::Matrix<double, 3, 6> moves;
    moves.leftCols<3>().setIdentity();
    for (int k = 0; k < 3; ++k) moves.col(3 + k) = Vec3(Vec3::Unit(k)).cross(arm);
    speed += s.weight / area * moves.transpose() * moves;
  }
  // A straight line of points would not move under a rotation about it.
  speed += 1e-9 * Mat6::Identity();
  // Angular coordinates first: which basis of a space of equal eigenvalues comes out depends on the order.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat6> solver(halves_swapped(across), halves_swapped(speed));
  std::vector<Twist> found;
  for (int k = 0; k < 6 && solver.eigenvalues()[k] < 0.01; ++k) {  // share of the mean square speed of the points
    const Vec6 x = solver.eigenvectors().col(k);                   // its mean square speed is 1
    found.push_back({x.tail<3>(), x.head<3>() / lever});
  }
  return found;
}

namespace {

/// Along all contacts, and along those that remain without a flat face square to the axis of one of these motions.
std::vector<Twist> motions_with_and_without_end_face(const std::vector<SurfaceSample>& contacts, const Vec3& center,
                                                     double radius, bool or_least_stiff) {
  std::vector<Vec6> rows;
  rows.reserve(contacts.size());
  for (const SurfaceSample& c : contacts) rows.push_back(speed_across(c.point - center, c.normal, radius));
  const std::vector<Twist> axes = motions_along(rows, radius, true);
  std::vector<Twist> twists = or_least_stiff ? axes : motions_along(rows, radius, false);
  for (const Twist& about : axes) {
    if (about.angular.norm() * radius < 0.5) continue;  // mostly a translation: it has no axis
    const Vec3 axis = about.angular.normalized();
    const std::vector<Vec6> others = without_end_face(rows, axis);
    if (others.size() == rows.size() || (!or_least_stiff && blocked_both_ways(rows, axis))) continue;
    for (const Twist& t : motions_along(others, radius, or_least_stiff)) {
      const bool known = std::any_of(twists.begin(), twists.end(), [&](const Twist& k) { return alike(k, t, radius); });
      if (!known) twists.push_back(t);
    }
  }
  return twists;
}

}  // namespace

std::vector<Twist> slippable_motions(const std::vector<SurfaceSample>& contacts, const Vec3& center, double radius) {
  return motions_with_and_without_end_face(contacts, center, radius, true);
}

std::vector<Twist> guided_motions(const std::vector<SurfaceSample>& contacts, const Vec3& center, double radius) {
  return motions_with_and_without_end_face(contacts, center, radius, false);
}

}  // namespace dismantle::geometry
