// Displacements under contact: laws on random contacts, with convex edges and overlap.
#include "contact_projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/run_context.h"

namespace dismantle::sdf_velocity {
namespace {

using Rows = std::vector<sdf::ContactRow>;
using Vector = ContactProjection::Vector;

constexpr double kMostLift = 0.01;

/// Contacts of `bodies` bodies with each other and with fixed parts; `below`: some are below the surface.
Rows random_rows(Rng& rng, int bodies, int per_body, double below) {
  Rows rows;
  const auto contacts = rng.below(40);
  for (std::uint64_t c = 0; c < contacts; ++c) {
    const int first = per_body * static_cast<int>(rng.below(static_cast<std::uint64_t>(bodies)));
    const int other = per_body * static_cast<int>(rng.below(static_cast<std::uint64_t>(bodies)));
    const int faces = rng.below(3) == 0 ? 1 + static_cast<int>(rng.below(4)) : 1;
    for (int k = 0; k < faces; ++k) {
      sdf::ContactRow row;
      row.alternatives = k == 0 ? faces - 1 : 0;
      row.first = first;
      for (int j = 0; j < 6; ++j) row.j_first[j] = rng.normal();
      row.j_first.head<3>().normalize();
      if (other != first) {
        row.second = other;
        row.j_second = -row.j_first;
        for (int j = 3; j < 6; ++j) row.j_second[j] = rng.normal();
      }
      row.gap = rng.below(3) == 0 ? 0.0 : rng.uniform(-below, 0.03);
      rows.push_back(row);
    }
  }
  return rows;
}

/// gap(x) of each contact: the largest of its faces.
std::vector<double> gaps(const Rows& rows, int per_body, const Vector& x) {
  std::vector<double> result;
  for (std::size_t i = 0; i < rows.size(); i += 1 + static_cast<std::size_t>(rows[i].alternatives)) {
    double gap = rows[i].gap_at(x, per_body);
    for (std::size_t k = 1; k <= static_cast<std::size_t>(rows[i].alternatives); ++k)
      gap = std::max(gap, rows[i + k].gap_at(x, per_body));
    result.push_back(gap);
  }
  return result;
}

Vector random_wanted(Rng& rng, int size) {
  Vector wanted(size);
  for (int k = 0; k < size; ++k) wanted[k] = 0.05 * rng.normal();
  return wanted;
}

TEST(ContactProjection, NothingGetsDeeperAndWhatIsFreeIsLeftAlone) {
  Rng rng(41);
  ContactProjection projection(2e-4, kMostLift);
  int moved = 0, unchanged = 0;
  for (int round = 0; round < 3000; ++round) {
    const int bodies = 1 + static_cast<int>(rng.below(3)), per_body = rng.below(2) == 0 ? 3 : 6;
    const Rows rows = random_rows(rng, bodies, per_body, round % 2 == 0 ? 0.0 : 0.01);
    const std::vector<double> radii(static_cast<std::size_t>(bodies), rng.uniform(0.2, 3));
    const Vector wanted = random_wanted(rng, bodies * per_body), nothing = Vector::Zero(wanted.size());
    Vector x;
    projection.project(rows, per_body, radii, wanted, x);
    const auto before = gaps(rows, per_body, nothing), after = gaps(rows, per_body, x),
               free = gaps(rows, per_body, wanted);
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_GE(after[i], std::min(before[i], 0.0) - 1e-8) << round;
    if (std::all_of(before.begin(), before.end(), [](double g) { return g >= 0; })) {
      const auto cost = [&](const Vector& at) {
        double sum = 0;
        for (Eigen::Index k = 0; k < at.size(); ++k) {
          const double weight = k % per_body < 3 ? 1.0 : radii[static_cast<std::size_t>(k / per_body)];
          sum += std::pow(weight * (at[k] - wanted[k]), 2);
        }
        return sum;
      };
      ASSERT_LE(cost(x), cost(nothing) + 1e-12) << "standing still is possible";
    }
    moved += x.norm() > 1e-6 ? 1 : 0;
    const bool edges = std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.alternatives > 0; });
    if (!edges && std::all_of(free.begin(), free.end(), [](double g) { return g >= 0; }) &&
        std::all_of(before.begin(), before.end(), [](double g) { return g >= 0; })) {
      ASSERT_LT((x - wanted).norm(), 1e-12);
      ++unchanged;
    }
  }
  EXPECT_GT(moved, 500);
  EXPECT_GT(unchanged, 50);
}

sdf::ContactRow face(const Eigen::Vector3d& normal, double gap, int alternatives = 0) {
  sdf::ContactRow row;
  row.first = 0;
  row.j_first.setZero();
  row.j_second.setZero();
  row.j_first.head<3>() = normal;
  row.gap = gap;
  row.alternatives = alternatives;
  return row;
}

TEST(ContactProjection, AtAnEdgeOneFaceIsEnough) {
  // The point is on an edge between a floor and a wall that drops from it: it may move outside either face, but not
  // inside both.
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), out = Eigen::Vector3d::UnitX();
  const Rows rows{face((up + out).normalized(), 0, 2), face(up, 0), face(out, 0)};
  ContactProjection projection(2e-4, kMostLift);
  Vector x;
  for (const Eigen::Vector3d& free : {Eigen::Vector3d(0.02, 0, -0.05), Eigen::Vector3d(-0.05, 0, 0.01)}) {
    projection.project(rows, 3, {1.0}, free, x);
    EXPECT_LT((x - free).norm(), 1e-12);
  }
  projection.project(rows, 3, {1.0}, Eigen::Vector3d(-0.05, 0, -0.01), x);
  EXPECT_LT((x - Eigen::Vector3d(-0.05, 0, 0)).norm(), 1e-12) << "over the floor";
  projection.project(rows, 3, {1.0}, Eigen::Vector3d(-0.01, 0, -0.05), x);
  EXPECT_LT((x - Eigen::Vector3d(0, 0, -0.05)).norm(), 1e-12) << "down the wall";
}

TEST(ContactProjection, AnExchangeOfFacesGetsPastAnEdge) {
  // A second contact blocks motion over the floor, so only motion down the wall remains.
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), out = Eigen::Vector3d::UnitX();
  const Rows rows{face((up + out).normalized(), 0, 2), face(up, 0), face(out, 0), face(out, 0)};
  ContactProjection projection(2e-4, kMostLift);
  Vector x;
  projection.project(rows, 3, {1.0}, Eigen::Vector3d(-0.05, 0, -0.01), x);
  EXPECT_LT((x - Eigen::Vector3d(0, 0, -0.01)).norm(), 1e-12);
}

TEST(ContactProjection, LiftsWhatIsBelowAndHoldsWhatIsSqueezed) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  ContactProjection projection(2e-4, kMostLift);
  Vector x;
  projection.project({face(up, -0.001)}, 3, {1.0}, Eigen::Vector3d(0.02, 0, -0.02), x);
  EXPECT_LT((x - Eigen::Vector3d(0.02, 0, 0.001)).norm(), 1e-12);
  projection.project({face(up, -0.5)}, 3, {1.0}, Eigen::Vector3d(0.02, 0, 0), x);
  EXPECT_NEAR(x[2], kMostLift, 1e-12) << "no jump";
  projection.project({face(up, -0.001), face(-up, -0.001)}, 3, {1.0}, Eigen::Vector3d(0.02, 0, -0.02), x);
  EXPECT_LT((x - Eigen::Vector3d(0.02, 0, 0)).norm(), 1e-12) << "between two jaws";
}

}  // namespace
}  // namespace dismantle::sdf_velocity
