/// translations: the arrangements of parts on a grid of cells, from which no slide leads to another one.
///
/// Each listed cell of a part has a core, the cell less an inset on each side, that is deeper in the part than motions
/// may penetrate. When assembled, it is outside the other parts. So no surface of another part enters a core, and the
/// cores of two parts are disjoint during all valid translations. Along an axis, take the positions of the n parts
/// modulo the pitch h. They leave a gap of at least h / n on the circle, more than 2 insets. Round down from there:
/// - Two parts move by less than h - 2 insets relative to each other. If two of their cells were equal afterwards, the
///   cores of these would have overlapped before.
/// - While the parts move, the gap can be kept, except where another one becomes the larger. Then the rounded positions
///   of the parts between both gaps change by one cell, and others do not: one step of a group.
/// So each motion by translations leads through arrangements without common cells, one step of a group from each to the
/// next. The listed arrangements hold the assembled one, and all that such a step reaches from them. There are finitely
/// many, so the parts stay near each other. (A group that steps back is the rest stepping forward.)
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "certificates/body.h"
#include "certificates/checker.h"

namespace dismantle::certificates {
namespace {

using Int3 = std::array<std::int64_t, 3>;
constexpr std::int64_t kLargest = 100'000;  // of a whole number in the lists

/// Three whole numbers as one.
std::uint64_t packed(const Int3& c) {
  std::uint64_t key = 0;
  for (const std::int64_t x : c) key = key << 21 | static_cast<std::uint64_t>(x + 4 * kLargest) % (1u << 21);
  return key;
}

/// Does a triangle meet a box? The part of it between each pair of opposite sides in turn.
bool meets(const Corners& triangle, const Vec3& lo, const Vec3& hi) {
  std::vector<Vec3> rest(triangle.begin(), triangle.end());
  for (int axis = 0; axis < 3 && !rest.empty(); ++axis)
    for (const double sign : {1.0, -1.0}) {
      const double limit = sign > 0 ? hi[axis] : -lo[axis];
      std::vector<Vec3> next;
      for (std::size_t k = 0; k < rest.size(); ++k) {
        const Vec3 &p = rest[k], &q = rest[(k + 1) % rest.size()];
        const double over_p = sign * p[axis] - limit, over_q = sign * q[axis] - limit;
        if (over_p <= 0) next.push_back(p);
        if (over_p * over_q < 0) next.push_back(p + (q - p) * (over_p / (over_p - over_q)));
      }
      rest = std::move(next);
    }
  return !rest.empty();
}

class Grid {
 public:
  Grid(const Certificate& certificate, const SeparationQuery& query, const RunContext& context)
      : numbers_(certificate.numbers), parts_(certificate.parts), query_(query), context_(context) {}

  std::string objection() {
    if (std::string wrong = read(); !wrong.empty()) return wrong;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (std::string wrong = objection_to_cores(i); !wrong.empty()) return wrong;
    return objection_to_arrangements();
  }

 private:
  const std::vector<double>& list(const char* name) const { return numbers_.at(name); }

  bool read_triples(const char* name, std::vector<Int3>& to) const {
    const auto& from = list(name);
    if (from.size() % 3 != 0) return false;
    to.resize(from.size() / 3);
    for (std::size_t k = 0; k < from.size(); ++k) {
      if (from[k] != std::round(from[k]) || std::abs(from[k]) > static_cast<double>(kLargest)) return false;
      to[k / 3][k % 3] = static_cast<std::int64_t>(from[k]);
    }
    return true;
  }

  std::string read() {
    const auto& q = list("axes");
    const Eigen::Quaterniond axes(q[0], q[1], q[2], q[3]);
    if (!(std::abs(axes.norm() - 1) < 1e-9)) return "its axes are no rotation";
    to_grid_ = axes.normalized().toRotationMatrix().transpose();
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      pitch_[k] = list("pitch")[i];
      origin_[k] = list("origin")[i];
      inset_[k] = list("inset")[i];
      if (!(inset_[k] > 0) || !(2 * static_cast<double>(parts_.size()) * inset_[k] < pitch_[k] * (1 - 1e-9)))
        return "its insets are not so small that there is a gap between the parts";
    }
    std::vector<Int3> cells;
    if (!read_triples("cells", cells) || !read_triples("arrangements", shifts_) || list("counts").size() != parts_.size())
      return "its lists are not lists of cells";
    std::size_t begin = 0;
    for (const double count : list("counts")) {
      if (!(count >= 1) || count != std::round(count) || !(count <= static_cast<double>(cells.size() - begin)))
        return "its lists are not lists of cells";
      const auto first = cells.begin() + static_cast<std::ptrdiff_t>(begin);
      cells_.emplace_back(first, first + static_cast<std::ptrdiff_t>(count));
      begin += static_cast<std::size_t>(count);
    }
    if (begin != cells.size() || shifts_.size() % (parts_.size() - 1) != 0) return "its lists are not lists of cells";
    return {};
  }

  struct Turned {
    std::vector<Corners> triangles;  // in the frame of the grid
    const Body* body = nullptr;
  };

  std::vector<Turned> turned(PartId part) const {
    std::vector<Turned> all;
    for (const Body& body : bodies_of(query_, part)) {
      Turned own{{}, &body};
      for (std::size_t t = 0; t < body.triangles.size(); ++t) {
        Corners c = body.corners(t);
        for (Vec3& p : c) p = to_grid_ * p;
        own.triangles.push_back(c);
      }
      all.push_back(std::move(own));
    }
    return all;
  }

  std::string objection_to_cores(std::size_t own) const {
    const PartId part = parts_[own];
    double allowed = 0;
    for (const PartId other : parts_)
      if (other != part) allowed = std::max(allowed, allowed_depth(query_, part, other));
    const double rounding = rounding_of(query_, part);
    const std::vector<Turned> mine = turned(part);
    std::vector<std::vector<Turned>> others;
    for (const PartId other : parts_)
      if (other != part) others.push_back(turned(other));
    for (const Int3& c : cells_[own]) {
      if (context_.should_stop()) return "the check was stopped";
      Vec3 lo, hi;
      for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<double>(c[static_cast<std::size_t>(k)]);
        lo[k] = origin_[k] + at * pitch_[k] + inset_[k];
        hi[k] = origin_[k] + (at + 1) * pitch_[k] - inset_[k];
      }
      const Vec3 middle = to_grid_.transpose() * (0.5 * (lo + hi));
      const auto clear = [&](const Turned& body, double by) {
        const Vec3 more = Vec3::Constant(by);
        return std::none_of(body.triangles.begin(), body.triangles.end(),
                            [&](const Corners& t) { return meets(t, lo - more, hi + more); });
      };
      if (std::none_of(mine.begin(), mine.end(), [&](const Turned& body) {
            return body.body->closed && clear(body, allowed + rounding) && inside(middle, *body.body);
          }))
        return fmt::format("the core of cell ({}, {}, {}) of part {} is not deep in it", c[0], c[1], c[2], own);
      for (const auto& other : others)
        for (const Turned& body : other)
          if (!body.body->closed || !clear(body, rounding) || inside(middle, *body.body))
            return fmt::format("the core of cell ({}, {}, {}) of part {} is not outside the others", c[0], c[1], c[2],
                               own);
    }
    return {};
  }

  std::string objection_to_arrangements() const {
    const std::size_t n = parts_.size(), count = shifts_.size() / (n - 1);
    // By ordered pair: the shifts of the first relative to the second at which they have a cell in common.
    std::vector<std::unordered_set<std::uint64_t>> common(n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (const Int3& a : cells_[i])
          for (const Int3& b : cells_[j])
            if (i != j) common[i * n + j].insert(packed({b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
    const auto key = [&](const std::vector<Int3>& at) {
      std::string text;
      for (std::size_t i = 1; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) text += std::to_string(at[i][k] - at[0][k]) + " ";
      return text;
    };
    const auto arrangement = [&](std::size_t which) {
      std::vector<Int3> at(1, Int3{});
      for (std::size_t i = 0; i + 1 < n; ++i) at.push_back(shifts_[which * (n - 1) + i]);
      return at;
    };
    std::unordered_set<std::string> listed;
    for (std::size_t k = 0; k < count; ++k) listed.insert(key(arrangement(k)));
    if (!listed.contains(key(std::vector<Int3>(n, Int3{})))) return "its arrangements lack the assembled one";
    for (std::size_t which = 0; which < count; ++which) {
      if (context_.should_stop()) return "the check was stopped";
      const std::vector<Int3> at = arrangement(which);
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t first = 0; first < n; ++first) {
          // The fewest parts that can step together with this one.
          std::vector<bool> steps(n, false);
          std::vector<std::size_t> open{first};
          steps[first] = true;
          std::size_t moving = 1;
          while (!open.empty()) {
            const std::size_t i = open.back();
            open.pop_back();
            for (std::size_t j = 0; j < n; ++j) {
              if (steps[j]) continue;
              Int3 shift{at[i][0] - at[j][0], at[i][1] - at[j][1], at[i][2] - at[j][2]};
              ++shift[axis];
              if (!common[i * n + j].contains(packed(shift))) continue;
              steps[j] = true;
              open.push_back(j);
              ++moving;
            }
          }
          if (moving == n) continue;
          std::vector<Int3> next = at;
          for (std::size_t i = 0; i < n; ++i)
            if (steps[i]) ++next[i][axis];
          if (!listed.contains(key(next))) return fmt::format("a step leads out of arrangement {}", which);
        }
    }
    return {};
  }

  const std::map<std::string, std::vector<double>>& numbers_;
  const std::vector<PartId>& parts_;
  const SeparationQuery& query_;
  const RunContext& context_;
  Eigen::Matrix3d to_grid_ = Eigen::Matrix3d::Identity();
  Vec3 pitch_ = Vec3::Ones(), origin_ = Vec3::Zero(), inset_ = Vec3::Zero();
  std::vector<std::vector<Int3>> cells_;  // by part
  std::vector<Int3> shifts_;              // of all parts but the first, arrangement by arrangement
};

}  // namespace

std::string objection_to_translations(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& context) {
  if (certificate.full_tolerance) return "it does not cover rotations, so it cannot hold for the full tolerance";
  return Grid(certificate, query, context).objection();
}

}  // namespace dismantle::certificates
