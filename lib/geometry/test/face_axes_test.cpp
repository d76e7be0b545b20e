// Face axes: every face counts once, for the nearest axis, at any orientation of the mesh.
#include "dismantle/geometry/face_axes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"

namespace dismantle::geometry {
namespace {

using Eigen::Vector3d;

Mesh turned_box(Rng& rng, Vector3d& size, Eigen::Quaterniond& q) {
  size = {rng.uniform(0.5, 3), rng.uniform(0.5, 3), rng.uniform(0.5, 3)};
  q = Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized();
  Mesh mesh = shapes::refine(shapes::box(Vector3d::Zero(), size), 1);
  for (Vector3d& v : mesh.vertices) v = q * v;
  return mesh;
}

TEST(FaceAxes, OfABoxAreItsEdgesWithTheAreasOfItsFaces) {
  Rng rng(1);
  for (int round = 0; round < 50; ++round) {
    Vector3d size;
    Eigen::Quaterniond q;
    const Mesh mesh = turned_box(rng, size, q);
    std::vector<FaceAxis> axes;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vector3d n = area_vector(mesh, t);
      add_face(axes, {n.normalized(), 0.5 * n.norm()}, 0.9999);
    }
    ASSERT_EQ(axes.size(), 3U);
    sort_by_area(axes);
    double last = std::numeric_limits<double>::infinity();
    for (const FaceAxis& a : axes) {
      EXPECT_LE(a.area, last);
      last = a.area;
      Eigen::Index k = 0;
      EXPECT_NEAR((q.conjugate() * a.axis).cwiseAbs().maxCoeff(&k), 1, 1e-9);
      EXPECT_NEAR(a.area, 2 * size.prod() / size[k], 1e-9);
    }
    sort_by_area(axes, 2);
    EXPECT_EQ(axes.size(), 2U);
  }
}

TEST(FaceAxes, KeepTheWholeSurfaceUnlessThereAreTooMany) {
  Rng rng(2);
  for (int round = 0; round < 50; ++round) {
    std::vector<FaceAxis> all, few;
    double area = 0;
    for (int k = 0; k < 200; ++k) {
      const FaceAxis face{Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized(), rng.uniform()};
      area += face.area;
      add_face(all, face, 0.95);
      add_face(few, face, 0.95, 5);
    }
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      sum += all[i].area;
      for (std::size_t k = 0; k < i; ++k) EXPECT_LT(std::abs(all[i].axis.dot(all[k].axis)), 0.95);
    }
    EXPECT_NEAR(sum, area, 1e-9);
    ASSERT_EQ(few.size(), 5U);
    for (std::size_t k = 0; k < few.size(); ++k) {
      EXPECT_EQ(few[k].axis, all[k].axis);
      EXPECT_EQ(few[k].area, all[k].area);
    }
  }
}

TEST(FaceAxes, RoundedOnesDependNeitherOnTheSideNorOnTheOrderOfFaces) {
  Rng rng(3);
  for (int round = 0; round < 50; ++round) {
    Vector3d size;
    Eigen::Quaterniond q;
    const Mesh mesh = turned_box(rng, size, q);
    std::vector<FaceAxis> faces;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vector3d n = area_vector(mesh, t);
      faces.push_back({n.normalized(), 0.5 * n.norm()});
    }
    const auto axes = rounded_axes(faces);
    double sum = 0;
    for (const FaceAxis& a : axes) sum += a.area;
    EXPECT_NEAR(sum, surface_area(mesh), 1e-9);
    std::reverse(faces.begin(), faces.end());
    for (FaceAxis& f : faces) f.axis = -f.axis;
    const auto again = rounded_axes(faces);
    ASSERT_EQ(again.size(), axes.size());
    for (std::size_t k = 0; k < axes.size(); ++k) {
      EXPECT_NEAR(again[k].area, axes[k].area, 1e-9);
      EXPECT_NEAR(std::abs(again[k].axis.dot(axes[k].axis)), 1, 2e-6);
    }
  }
}

TEST(FaceAxes, TheLargestOfABoxAreAcrossItsLargestFaces) {
  Rng rng(2);
  for (int round = 0; round < 50; ++round) {
    Vector3d size;
    Eigen::Quaterniond q;
    const Mesh mesh = turned_box(rng, size, q);
    Eigen::Index thin = 0;
    size.minCoeff(&thin);
    const std::vector<FaceAxis> axes = largest_face_axes(mesh, 2);
    ASSERT_EQ(axes.size(), 2U);
    EXPECT_NEAR(std::abs(axes[0].axis.dot(q * Vector3d::Unit(thin))), 1, 1e-6);
    EXPECT_NEAR(axes[0].area, 4 * size.prod() / size[thin], 1e-9 * axes[0].area);
  }
}

}  // namespace
}  // namespace dismantle::geometry
