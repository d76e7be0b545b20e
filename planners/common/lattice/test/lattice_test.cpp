#include "dismantle/lattice/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dismantle/lattice/arrangements.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/voxels.h"

namespace dismantle::lattice {
namespace {

using Vec3 = Eigen::Vector3d;
using Sets = std::vector<std::vector<Cell>>;

/// The cells with every coordinate moved so that the lowest is 0, and axes and signs in one order of many.
Sets canonical(Sets parts) {
  Sets best;
  int order[3] = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Sets turned = parts;
      Cell lo{1000, 1000, 1000};
      for (auto& part : turned)
        for (Cell& c : part) {
          const Cell from = c;
          for (std::size_t k = 0; k < 3; ++k) {
            c[k] = (signs >> k & 1 ? -1 : 1) * from[static_cast<std::size_t>(order[k])];
            lo[k] = std::min(lo[k], c[k]);
          }
        }
      for (auto& part : turned) {
        for (Cell& c : part)
          for (std::size_t k = 0; k < 3; ++k) c[k] -= lo[k];
        std::sort(part.begin(), part.end());
      }
      if (best.empty() || turned < best) best = turned;
    }
  } while (std::next_permutation(order, order + 3));
  return best;
}

TEST(Lattice, IsFoundAtAnyOrientationSizeAndPlay) {
  Rng rng(11);
  for (int trial = 0; trial < 40; ++trial) {
    const auto pieces = voxels::random_pieces(rng, {4, 5, 3}, 3);
    const Pose pose = shapes::random_pose(rng, 5);
    const Vec3 pitch(rng.uniform(0.3, 3), rng.uniform(0.3, 3), rng.uniform(0.3, 3));
    std::vector<Mesh> meshes;
    for (const auto& piece : pieces) {
      Mesh m = voxels::surface(piece);
      for (Vec3& v : m.vertices) {
        v = pose * v.cwiseProduct(pitch);
        // As a file with seven digits has them.
        for (int k = 0; k < 3; ++k) v[k] = std::round(v[k] * 1e6) / 1e6;
      }
      meshes.push_back(std::move(m));
    }
    std::vector<const Mesh*> list;
    for (const Mesh& m : meshes) list.push_back(&m);
    const auto lattice = lattice_of(list, 0.01);
    ASSERT_TRUE(lattice) << trial;
    std::vector<double> found(lattice->pitch.begin(), lattice->pitch.end()), real(pitch.begin(), pitch.end());
    std::sort(found.begin(), found.end());
    std::sort(real.begin(), real.end());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], real[k], 1e-4) << trial;
    Sets touched, full;
    for (const Mesh& m : meshes) {
      touched.push_back(cells_of(m, *lattice, Vec3::Constant(0.1), true));
      full.push_back(full_cells_of(m, *lattice, Vec3::Constant(0.1)));
    }
    EXPECT_EQ(canonical(touched), canonical(Sets(pieces.begin(), pieces.end())));
    EXPECT_EQ(touched, full);
  }
}

TEST(Lattice, HasTheCellsOfPartsWithPlay) {
  // Two rails and a slider with a gap of 0.05 all around.
  const Mesh rail = shapes::box({0.05, 0.05, 0.05}, {3.95, 0.95, 1.95}), slider = shapes::box({1.05, 1.05, 0.05},
                                                                                                {2.95, 1.95, 0.95});
  const auto lattice = lattice_of({&rail, &slider}, 0.01);
  ASSERT_TRUE(lattice);
  // The coarsest grid along x: faces at 0, 4 and 1, 3.
  EXPECT_EQ(cells_of(slider, *lattice, Vec3::Constant(0.1), true).size() % 2, 0u);
  for (const Mesh* mesh : {&rail, &slider}) {
    double volume = 0;
    for (const Cell& c : cells_of(*mesh, *lattice, Vec3::Constant(0.1), true)) volume += c.empty() ? 0 : 1;
    const Vec3 size = mesh->box().size() + Vec3::Constant(0.1);
    EXPECT_NEAR(volume * lattice->pitch.prod(), size.prod(), 1e-6);
  }
}

TEST(Lattice, IsNotFoundWhereNothingIsOnAGrid) {
  Rng rng(12);
  for (int trial = 0; trial < 20; ++trial) {
    Mesh odd;
    for (int k = 0; k < 6; ++k) {
      const Vec3 lo = shapes::random_vector(rng, 0, 5);
      shapes::append(odd, shapes::box(lo, lo + shapes::random_vector(rng, 0.5, 2)));
    }
    EXPECT_FALSE(lattice_of({&odd}, 1e-3));
  }
}

}  // namespace
}  // namespace dismantle::lattice
