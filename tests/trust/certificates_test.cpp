// Independent checkers of certificates: they accept what provers prove, refuse numbers that are not true, and accept no
// numbers whatever of parts that can leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/part_memo.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/testing/voxels.h"
#include "dismantle/verification/check_certificate.h"

namespace dismantle::trust {
namespace {

using shapes::Vec3;
using Numbers = std::vector<double>;

/// Makes a number of a certificate say more than is true.
struct Forgery {
  std::string name;
  std::function<void(Numbers&, Rng&)> forge;
};

/// Parts that a prover of one kind proves held, and the same with a way out.
struct Kind {
  std::string id;
  std::function<Assembly(Rng&, bool held)> assembly;
  std::vector<Forgery> forgeries;
  double margin = 0.01;
  int share = 1;  ///< one of this many trials is made: proofs take seconds
  double of_tolerance = 1;  ///< share of the margin that is asked for
  int trials(int daily, int nightly) const { return std::max(1, testing_support::trials(daily, nightly) / share); }
};

Assembly placed(std::vector<Mesh> meshes, Rng& rng) {
  const Pose at = shapes::random_pose(rng, 2);
  for (Mesh& m : meshes) m = shapes::moved(m, at);
  return shapes::assembly_of(meshes);
}

Forgery scaled(const std::string& name, double least, double most) {
  return {name, [=](Numbers& n, Rng& rng) {
            const double by = rng.uniform(least, most);
            for (double& x : n) x *= by;
          }};
}
Forgery shifted(const std::string& name, double by) {
  return {name, [=](Numbers& n, Rng& rng) {
            const Vec3 d = by * (shapes::random_pose(rng, 1).q * Vec3::UnitX());
            for (std::size_t k = 0; k < 3; ++k) n[k] += d[static_cast<Eigen::Index>(k)];
          }};
}

/// A pin through a plate without a hole; or pressed into it as deep as it is allowed to be, and free above.
Assembly pinned(Rng& rng, bool held) {
  const double overlap = rng.uniform(0.02, 0.2), foot = held ? -1 : 0.5 - overlap;
  Assembly a = placed({shapes::box({-2, -2, -0.5}, {2, 2, 0.5}), shapes::box({-0.6, -0.6, foot}, {0.6, 0.6, 1})}, rng);
  a.overlaps = {{0, 1, overlap}};
  return a;
}

/// A cube in a case whose opening is narrower than its ball, or wide enough for all of it.
Assembly cased(Rng& rng, bool held) {
  const double half = rng.uniform(0.4, 0.6), play = rng.uniform(0.005, 0.05);
  const shapes::Cased c{Vec3::Constant(half), play, held ? rng.uniform(0.2, 0.5) * half : -rng.uniform(0, 1) * play,
                        0.15};
  return placed({c.block(), c.around()}, rng);
}

/// A block in a case, whose opening is narrower than the block, or wide enough for it.
Assembly rimmed(Rng& rng, bool held) {
  const shapes::Cased c{{rng.uniform(0.4, 0.7), rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5)},
                        rng.uniform(0.005, 0.02),
                        held ? rng.uniform(0.08, 0.15) : -rng.uniform(0, 0.01),
                        0.15};
  return placed({c.block(), c.around()}, rng);
}

/// A ring in a can, one of whose openings may let it out.
Assembly canned(Rng& rng, bool held) {
  const double radius = rng.uniform(0.6, 0.9), below = radius * rng.uniform(0.1, 0.75);
  const double narrow = radius * rng.uniform(0.1, 0.75), wide = radius + rng.uniform(0.02, 0.08);
  return placed({shapes::tube(0.5 * radius, radius, -0.1, 0.1, 48), shapes::can(1, 0.6, below, held ? narrow : wide)},
                rng);
}

/// A round plate in a can; one of the openings may let it out.
Assembly plated(Rng& rng, bool held) {
  const double below = rng.uniform(0.2, 0.5), narrow = rng.uniform(0.4, 0.75), wide = 0.9 + rng.uniform(0.02, 0.08);
  return placed({shapes::tube(0, 0.9, -0.05, 0.05, 48), shapes::can(1, 0.6, below, held ? narrow : wide)}, rng);
}

/// A spool in a plate; one of its rims may be narrower than the hole.
Assembly spooled(Rng& rng, bool held) {
  const double hole = rng.uniform(0.3, 0.6), neck = hole * rng.uniform(0.5, 0.95),
               below = hole + rng.uniform(0.05, 0.3);
  const double wide = hole + rng.uniform(0.05, 0.3), narrow = hole - rng.uniform(0, 0.4) * (hole - neck);
  const double above = held ? wide : narrow;
  const Mesh spool = shapes::lathe(
      {{0.05, -0.4}, {below, -0.4}, {below, -0.2}, {neck, -0.2}, {neck, 0.2}, {above, 0.2}, {above, 0.4}, {0.05, 0.4}},
      40);
  return placed({spool, shapes::plate(hole, 0.3)}, rng);
}

/// A slab, a tray and a block that hold each other; without the roof over the slab it leaves upwards.
Assembly keyed(Rng& rng, bool held) {
  shapes::Keyed k;
  k.length = rng.uniform(0.5, 0.7);
  k.play = rng.uniform(0.001, 0.004);
  k.roofed = held ? rng.uniform(0.3, 0.45) : 0;
  return placed({k.slab(), k.tray(), k.block()}, rng);
}

/// A bar through a hole, bent on both sides; or on one side only.
Assembly hooked(Rng& rng, bool held) {
  const double half = rng.uniform(0.08, 0.12), thick = rng.uniform(3, 6) * half, reach = 0.5 * thick + 2 * half;
  const double bend = rng.uniform(1.45, 1.7);  // rad
  const Mesh bar = shapes::bent_bar(shapes::crank(-reach, held ? reach : 1, bend, held ? bend : 0, 1.5), half);
  return placed({bar, shapes::plate(half * rng.uniform(1.5, 1.7), thick)}, rng);
}

/// A cube in a closed shell, with some room; without one cell of the shell it leaves.
Assembly caged(Rng& rng, bool held) {
  const Vec3 pitch(rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0.5, 2));
  const int room = 2 + static_cast<int>(rng.below(3));
  voxels::Piece shell;
  for (int x = 0; x < room + 2; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z)
        if ((y != 1 || z != 1 || x == 0 || x == room + 1) && (held || x != 2 || y != 1 || z != 2))
          shell.push_back({x, y, z});
  std::vector<Mesh> meshes{voxels::surface(shell), voxels::surface({{1, 1, 1}})};
  for (Mesh& mesh : meshes)
    for (Vec3& v : mesh.vertices) v = v.cwiseProduct(pitch);
  return placed(std::move(meshes), rng);
}

Forgery elsewhere(const std::string& name) {
  return {name, [](Numbers& n, Rng& rng) { n.front() += rng.uniform(3, 5); }};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"overlap_lock",
       pinned,
       {scaled("depth", 1.0001, 2), scaled("depth", 0, 0.049), scaled("allowed", 0, 0.9999), scaled("allowed", 25, 50),
        shifted("point", 3)}},
      {"enclosed_ball", cased, {scaled("radius", 1.0001, 2), shifted("center", 2), scaled("cell", 20, 40)}},
      {"ring",
       canned,
       {scaled("diameter", 1.2, 2), scaled("diameter", 0.2, 0.4), scaled("opening", 0, 0.999),
        scaled("opening", 20, 30), shifted("center", 3), scaled("axis", 1.01, 2), elsewhere("planes")}},
      {"disc",
       plated,
       {scaled("diameter", 1.1, 2), scaled("diameter", 0.1, 0.3), scaled("half_thickness", 1.1, 2),
        scaled("half_thickness", 0, 0.1), shifted("center", 3), scaled("axis", 1.01, 2), scaled("frame", 1.01, 2),
        scaled("region", 0.2, 0.8), scaled("normals", 0, 0)},
       0.01,
       4},
      {"spool",
       spooled,
       {scaled("circle", 2.5, 4), scaled("circle", 0.2, 0.5), scaled("rim", 1.0001, 2), scaled("rim", 0, 0.1),
        shifted("center", 3), scaled("axis", 1.01, 2), elsewhere("planes")}},
      {"hook",
       hooked,
       {scaled("width", 0, 0.999), shifted("hole", 3), shifted("first_bend", 3), shifted("second_bend", 3),
        scaled("path", 1.2, 2), scaled("steps", 10, 20), scaled("points", 10, 20)},
       0.01,
       4},
      {"configuration_cells",
       rimmed,
       {scaled("depth", 0, 0.99), scaled("shift", 0, 0.99), scaled("turn", 0, 0.99), scaled("lower", 0, 0.9),
        scaled("upper", 0, 0.9), scaled("cells", 2, 3), scaled("points", 1.5, 2), scaled("directions", -2, -1),
        scaled("box", 0.1, 0.5), scaled("tree", 1.1, 1.9)},
       0.005,
       4},
      {"interlock_lp",
       keyed,
       {scaled("depth", 0, 0.99), scaled("shift", 0, 0.99), scaled("turn", 0, 0.99), scaled("half_spaces", 2, 3),
        scaled("axes", 1.01, 2), scaled("order", 2, 3), scaled("bounds", 0, 0.5), scaled("pairs", 0, 0.5),
        scaled("rows", 1.5, 2), scaled("multipliers", 1.5, 2)},
       0.002},
      {"translations",
       caged,
       {scaled("axes", 1.01, 2), scaled("pitch", 1.3, 2), shifted("origin", 3), scaled("inset", 1.1, 2),
        scaled("inset", 0, 0.02), scaled("counts", 1.1, 2), scaled("cells", 1.1, 1.9),
        scaled("arrangements", 1.1, 1.9)},
       0.01,
       1,
       0.5},
  };
  return all;
}

std::string objection(const Kind& kind, const Assembly& assembly, const Certificate& c) {
  PartMemo memo;
  SeparationQuery query{assembly, {}, {}, kind.margin, kind.of_tolerance, memo};
  for (std::size_t i = 0; i < c.parts.size(); ++i)
    (i == 0 ? query.moving : query.fixed).push_back({c.parts[i], c.poses.empty() ? Pose{} : c.poses[i]});
  const auto found = independent_objection(c, query, {});
  return found ? *found : "no checker";
}

Certificate certificate_of(const Kind& kind, const Assembly& assembly) {
  PartMemo memo;
  SeparationQuery query{assembly, {{0, Pose{}}}, {}, kind.margin, kind.of_tolerance, memo};
  for (PartId id = 1; id < assembly.parts.size(); ++id) query.fixed.push_back({id, Pose{}});
  auto found = fake::prover_of_kind(kind.id)->prove(query, {});
  if (!found) return {};
  found->kind = kind.id;
  return *found;
}

/// Parts that are held, the proof, and the same parts but for a way out.
struct Example {
  Assembly held, free;
  Certificate proof;
};

/// Provers are not complete, so some parts are tried.
Example example(const Kind& kind, Rng& rng) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    Rng same = rng;
    Example e{kind.assembly(same, true), kind.assembly(rng, false), {}};
    e.proof = certificate_of(kind, e.held);
    if (!e.proof.parts.empty()) return e;
  }
  ADD_FAILURE() << kind.id << " proves nothing";
  return {};
}

TEST(Certificates, AreAcceptedWhenTheirNumbersAreTrue) {
  for (const Kind& kind : kinds()) {
    Rng rng(5);
    for (int i = 0; i < kind.trials(4, 100); ++i) {
      const Example e = example(kind, rng);
      EXPECT_EQ(objection(kind, e.held, e.proof), "") << kind.id << " " << i;
    }
  }
}

TEST(Certificates, AreRefusedWhenANumberSaysMoreThanIsTrue) {
  for (const Kind& kind : kinds()) {
    Rng rng(6);
    for (int i = 0; i < kind.trials(2, 50); ++i) {
      const Example e = example(kind, rng);
      for (const Forgery& f : kind.forgeries) {
        Certificate forged = e.proof;
        f.forge(forged.numbers.at(f.name), rng);
        EXPECT_NE(objection(kind, e.held, forged), "") << kind.id << ": " << f.name;
      }
      for (const auto& [name, numbers] : e.proof.numbers) {
        Certificate forged = e.proof;
        forged.numbers.erase(name);
        EXPECT_NE(objection(kind, e.held, forged), "") << kind.id << ": without " << name;
        forged = e.proof;
        forged.numbers[name].push_back(1e3);
        EXPECT_NE(objection(kind, e.held, forged), "") << kind.id << ": one number more in " << name;
      }
    }
  }
}

TEST(Certificates, AreRefusedWhateverTheyAreMadeOfWhenPartsCanLeave) {
  int tried = 0;
  for (const Kind& kind : kinds()) {
    Rng rng(7);
    for (int i = 0; i < kind.trials(4, 200); ++i) {
      const Example e = example(kind, rng);
      for (int k = 0; k < 25; ++k, ++tried) {
        // The honest numbers, one list of them changed, or all: most changes of axes or indices are refused at sight.
        Certificate c = e.proof;
        const double by = k == 0 ? 0 : rng.uniform(0, 0.5);
        const std::size_t which = rng.below(k % 5 == 0 ? 1 : c.numbers.size());
        std::size_t at = 0;
        for (auto& [name, numbers] : c.numbers) {
          if (k % 5 != 0 && at++ != which) continue;
          for (double& x : numbers) x = x * (1 + by * rng.uniform(-1, 1)) + 0.1 * by * rng.uniform(-1, 1);
        }
        EXPECT_NE(objection(kind, e.free, c), "") << kind.id << " " << i << " " << k;
      }
    }
  }
  std::cout << tried << " certificates of parts that can leave, all refused\n";
}

}  // namespace
}  // namespace dismantle::trust
