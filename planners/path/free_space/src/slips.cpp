#include "dismantle/free_space/slips.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace dismantle::free_space {
namespace {

using Vec3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kAcross = 0.01;  // mean square of the speed across the surface, of that of its points, at most

}  // namespace

std::vector<Twist> slips(const Mesh& mesh, const Vec3& center) {
  // Squares are of second degree: with the middles of the edges of triangles their means are exact.
  struct Sample {
    Vec3 at, normal;
    double weight;
  };
  std::vector<Sample> samples;
  double area = 0, squares = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.vertex(t, 0) - center, b = mesh.vertex(t, 1) - center, c = mesh.vertex(t, 2) - center;
    const Vec3 across = (b - a).cross(c - a);
    const double weight = across.norm() / 3;
    if (!(weight > 0)) continue;
    for (const Vec3& at : {Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)}) {
      samples.push_back({at, across.normalized(), weight});
      area += weight;
      squares += weight * at.squaredNorm();
    }
  }
  if (!(area > 0)) return {};
  // Turns are measured by how far they move points: all six coordinates are lengths.
  const double lever = std::sqrt(squares / area);
  Matrix6 across = Matrix6::Zero(), speed = Matrix6::Zero();
  for (const Sample& s : samples) {
    const Vec3 p = s.at / lever;
    Vector6 row;
    row << p.cross(s.normal), s.normal;
    across += s.weight / area * row * row.transpose();
    Eigen::Matrix<double, 3, 6> moves;
    for (int k = 0; k < 3; ++k) moves.col(k) = Vec3(Vec3::Unit(k)).cross(p);
    moves.rightCols<3>().setIdentity();
    speed += s.weight / area * moves.transpose() * moves;
  }
  // A straight line of points would not move under a turn about it.
  speed += 1e-9 * Matrix6::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(across, speed);
  std::vector<Twist> found;
  for (int k = 0; k < 6 && solver.eigenvalues()[k] < kAcross; ++k) {
    const Vector6 x = solver.eigenvectors().col(k);  // the mean square speed is 1
    found.push_back({x.tail<3>(), x.head<3>() / lever});
  }
  return found;
}

}  // namespace dismantle::free_space
