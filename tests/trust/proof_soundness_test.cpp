// Random puzzles of known truth: no prover may say of parts that can be separated that they cannot.
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <map>
#include <optional>
#include <queue>
#include <set>

#include "dismantle/part_memo.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/testing/shapes.h"
#include "dismantle/testing/trials.h"
#include "dismantle/verification/check_certificate.h"

namespace dismantle::trust {
namespace {

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;
using shapes::Vec3;

constexpr double kPlay = 2e-4;  // between the two parts, of a cell's edge; where corners of several cells meet, the
                                // parts may overlap by as much, which is far below what every proof has to allow
constexpr double kProofTolerance = 0.01;  // assembly units

Cell plus(const Cell& a, const Cell& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
const std::array<Cell, 6> kWays = {Cell{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

bool connected(const Cells& cells) {
  if (cells.empty()) return false;
  Cells seen{*cells.begin()};
  std::vector<Cell> pending{*cells.begin()};
  while (!pending.empty()) {
    const Cell at = pending.back();
    pending.pop_back();
    for (const Cell& displacement : kWays)
      if (const Cell next = plus(at, displacement); cells.contains(next) && seen.insert(next).second)
        pending.push_back(next);
  }
  return seen.size() == cells.size();
}

/// Can the one leave the other by moves of one cell? Whatever turns could do comes on top.
bool leaves(const Cells& part, const Cells& other, int size) {
  const auto free_at = [&](const Cell& by) {
    return std::none_of(part.begin(), part.end(), [&](const Cell& c) { return other.contains(plus(c, by)); });
  };
  Cells seen{{0, 0, 0}};
  std::queue<Cell> pending;
  pending.push({0, 0, 0});
  while (!pending.empty()) {
    const Cell at = pending.front();
    pending.pop();
    if (std::any_of(at.begin(), at.end(), [&](int x) { return std::abs(x) >= size; })) return true;
    for (const Cell& displacement : kWays)
      if (const Cell next = plus(at, displacement); !seen.contains(next) && free_at(next)) {
        seen.insert(next);
        pending.push(next);
      }
  }
  return false;
}

/// The surface of the cells, moved inwards by `inset`: closed, its corners on no other surface. Corners where the
/// surface would touch itself are told apart by the cells around them.
Mesh surface(const Cells& cells, double inset) {
  Mesh m;
  for (const Cell& c : cells)
    for (std::size_t d = 0; d < 3; ++d)
      for (const int side : {-1, 1}) {
        Cell beyond = c;
        beyond[d] += side;
        if (cells.contains(beyond)) continue;
        const std::size_t u = (d + (side > 0 ? 1 : 2)) % 3, v = (d + (side > 0 ? 2 : 1)) % 3;
        std::array<std::uint32_t, 4> corner{};
        const std::array<std::array<int, 2>, 4> around = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
        for (std::size_t k = 0; k < 4; ++k) {
          Vec3 p(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
          p[static_cast<Eigen::Index>(d)] += 0.5 * side;
          p[static_cast<Eigen::Index>(u)] += 0.5 * around[k][0];
          p[static_cast<Eigen::Index>(v)] += 0.5 * around[k][1];
          corner[k] = static_cast<std::uint32_t>(m.vertices.size());
          m.vertices.push_back(p);
        }
        m.triangles.push_back({corner[0], corner[1], corner[2]});
        m.triangles.push_back({corner[0], corner[2], corner[3]});
      }
  // Equal corners become one, and each is moved towards the cells that it belongs to.
  std::map<std::array<long, 3>, std::uint32_t> known;
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> to(m.vertices.size());
  for (std::size_t i = 0; i < m.vertices.size(); ++i) {
    const Vec3& p = m.vertices[i];
    const auto [found, fresh] = known.try_emplace({std::lround(p.x()), std::lround(p.y()), std::lround(p.z())},
                                                  static_cast<std::uint32_t>(vertices.size()));
    to[i] = found->second;
    if (!fresh) continue;
    Vec3 inward = Vec3::Zero();
    for (int k = 0; k < 8; ++k) {
      const Cell around{static_cast<int>(std::lround(p.x())) - (k & 1),
                        static_cast<int>(std::lround(p.y())) - (k >> 1 & 1),
                        static_cast<int>(std::lround(p.z())) - (k >> 2 & 1)};
      if (cells.contains(around)) inward += Vec3(k & 1 ? -1 : 1, k >> 1 & 1 ? -1 : 1, k >> 2 & 1 ? -1 : 1);
    }
    vertices.push_back(p + inset * inward.cwiseSign());
  }
  m.vertices = std::move(vertices);
  for (auto& t : m.triangles)
    for (auto& v : t) v = to[v];
  return m;
}

/// No two cells meet in an edge or a corner alone: then moving corners inwards keeps the surface free of crossings.
bool is_manifold(const Cells& cells, int size) {
  for (int x = -1; x <= size; ++x)
    for (int y = -1; y <= size; ++y)
      for (int z = -1; z <= size; ++z) {
        Cells block;
        for (int k = 0; k < 8; ++k)
          if (const Cell c{x + (k & 1), y + (k >> 1 & 1), z + (k >> 2 & 1)}; cells.contains(c)) block.insert(c);
        if (!block.empty() && !connected(block)) return false;
        // An edge of four cells, two of them across.
        for (std::size_t d = 0; d < 3; ++d)
          for (const int layer : {0, 1}) {
            Cells ring;
            for (const Cell& c : block)
              if (c[d] == Cell{x, y, z}[d] + layer) ring.insert(c);
            if (!ring.empty() && !connected(ring)) return false;
          }
      }
  return true;
}

struct Puzzle {
  Cells a, b;
  bool separable = false;
};

/// A block of cells, some of them left out, cut in two at random: the first part grows from a cell of its own.
std::optional<Puzzle> random_puzzle(Rng& rng, int size) {
  Puzzle p;
  Cells all;
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z)
        if (rng.uniform() > 0.12) all.insert({x, y, z});
  std::vector<Cell> cells(all.begin(), all.end());
  const Cell seed = cells[rng.below(cells.size())];
  p.a = {seed};
  const std::size_t many = 3 + rng.below(cells.size() / 2);
  std::vector<Cell> grown{seed};
  for (int k = 0; k < 400 && p.a.size() < many; ++k) {
    const Cell next = plus(grown[rng.below(grown.size())], kWays[rng.below(6)]);
    if (all.contains(next) && p.a.insert(next).second) grown.push_back(next);
  }
  for (const Cell& c : all)
    if (!p.a.contains(c)) p.b.insert(c);
  if (!connected(p.a) || !connected(p.b) || !is_manifold(p.a, size) || !is_manifold(p.b, size)) return std::nullopt;
  p.separable = leaves(p.a, p.b, 2 * size);
  return p;
}

struct Asked {
  int proofs = 0, checked = 0;
};

/// Every prover about the two, either moving. `unsound` gets what was proved of parts that can be separated.
Asked ask(const Assembly& assembly, bool separable, bool all, std::string& unsound) {
  Asked asked;
  PartMemo memo;
  for (const NamedProver& named : fake::built_in_provers()) {
    if (!all && named.prover->traits().effort >= ProofEffort::medium) continue;
    for (const double share : {0.5, 1.0}) {
      const SeparationQuery query{assembly, {{0, Pose{}}}, {{1, Pose{}}}, kProofTolerance, share, memo};
      auto found = named.prover->prove(query, {});
      if (!found) continue;
      ++asked.proofs;
      if (separable) unsound += named.id + ": " + found->text + "\n";
      PartMemo fresh;
      SeparationQuery again{assembly, {}, {}, kProofTolerance, share, fresh};
      for (std::size_t i = 0; i < found->parts.size(); ++i)
        (i == 0 ? again.moving : again.fixed)
            .push_back({found->parts[i], found->poses.empty() ? Pose{} : found->poses[i]});
      found->kind = named.id;
      const auto independent = independent_objection(*found, again, {});
      const std::string objection = independent ? *independent : named.prover->objection(*found, again, {});
      if (objection.empty())
        ++asked.checked;
      else
        unsound += named.id + ": objection to its certificate: " + objection + "\n";
    }
  }
  return asked;
}

/// Those of medium and high effort take seconds each: in the short form, a few puzzles only.
TEST(ProofSoundness, NoProofOfPartsThatCanBeSeparated) {
  Rng rng(17);
  const int trials = testing_support::trials(60, 10'000);
  int separable = 0, held = 0, proved = 0, certificates = 0;
  while (separable < trials) {
    const int size = 3 + static_cast<int>(rng.below(2));
    const auto puzzle = random_puzzle(rng, size);
    if (!puzzle) continue;
    if (!puzzle->separable && held >= trials / 10) continue;  // what is held shows that the provers do prove
    Mesh a = surface(puzzle->a, 0.5 * kPlay), b = surface(puzzle->b, 0.5 * kPlay);
    const double scale = 10.0 / size;
    for (Mesh* mesh : {&a, &b})
      for (auto& v : mesh->vertices) v *= scale;
    ASSERT_GT(shapes::volume(a), 0);
    const Pose turned = shapes::random_pose(rng, 2);
    const Assembly assembly = shapes::assembly_of({shapes::moved(a, turned), shapes::moved(b, turned)});
    std::string unsound;
    (puzzle->separable ? separable : held) += 1;
    const bool all = testing_support::nightly() ? separable % 50 == 1 : separable % 30 == 1;
    const Asked asked = ask(assembly, puzzle->separable, all, unsound);
    EXPECT_EQ(unsound, "") << "after " << separable << " separable puzzles";
    proved += !puzzle->separable && asked.proofs > 0 ? 1 : 0;
    certificates += asked.checked;
    if (testing_support::nightly() && (separable + held) % 100 == 0)
      std::cout << separable << " separable puzzles, none proved held; " << held << " held ones, " << proved
                << " proved; " << certificates << " certificates checked" << std::endl;
  }
  std::cout << separable << " separable puzzles, none proved held; " << held << " held ones, " << proved << " proved; "
            << certificates << " certificates checked\n";
}

}  // namespace
}  // namespace dismantle::trust
