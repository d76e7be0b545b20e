#include "contact/survey.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace dismantle::verify {
namespace {

using Vec3 = Eigen::Vector3d;

class Surveyor {
 public:
  Surveyor(const Field& a, const Field& b, double reach) : a_(a), b_(b), reach_(reach) {}

  std::vector<SurfaceCell> run(double finest) {
    for (std::size_t k = 0; k < a_.solids().size(); ++k) collect(k, 0);
    // Half of the divisions are for all near cells, half for those that may overlap: area shares are good to 1 %.
    divide(2000, finest, [](const SurfaceCell&) { return true; });
    divide(2000, finest, [](const SurfaceCell& c) { return c.seen.depth > -c.radius; });
    return std::move(cells_);
  }

 private:
  void collect(std::size_t solid, std::uint32_t id) {
    const Solid& x = a_.solids()[solid];
    if (x.bvh.nodes().empty()) return;
    const TriangleBvh::Node& node = x.bvh.nodes()[id];
    const Placement& place = a_.to_world()[solid];
    const Vec3 c = place * node.box.center(), h = place.r.cwiseAbs() * (0.5 * node.box.size());
    Aabb box{c - h, c + h};
    box.inflate(reach_);
    if (!box.overlaps(b_.box())) return;
    if (node.count == 0) {
      collect(solid, id + 1);
      collect(solid, node.first);
      return;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const std::uint32_t t = x.bvh.order()[k];
      const auto& p = x.bvh.corners(t);
      add({place * p[0], place * p[1], place * p[2]}, place.r * x.normals[t]);
    }
  }

  void add(const std::array<Vec3, 3>& p, const Vec3& normal) {
    SurfaceCell cell;
    cell.p = p;
    cell.normal = normal;
    const Vec3 middle = cell.middle();
    cell.radius = std::sqrt(
        std::max({(p[0] - middle).squaredNorm(), (p[1] - middle).squaredNorm(), (p[2] - middle).squaredNorm()}));
    cell.area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    const double limit = reach_ + cell.radius;
    cell.seen = b_.at(middle, limit);
    if (cell.seen.depth > -limit) cells_.push_back(cell);
  }

  /// Divides the largest cells first; equal ones in order of insertion.
  template <class Admit>
  void divide(std::size_t most, double finest, const Admit& admit) {
    using Entry = std::pair<double, std::size_t>;
    const auto later = [](const Entry& a, const Entry& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(later)> open(later);
    const auto enter = [&](std::size_t i) {
      if (cells_[i].radius > finest && admit(cells_[i])) open.emplace(cells_[i].radius, i);
    };
    for (std::size_t i = 0; i < cells_.size(); ++i) enter(i);
    std::vector<char> divided(cells_.size(), 0);
    for (; most > 0 && !open.empty(); --most) {
      const std::size_t i = open.top().second;
      open.pop();
      divided[i] = 1;
      std::size_t next = cells_.size();
      halve(i);
      divided.resize(cells_.size(), 0);
      for (; next < cells_.size(); ++next) enter(next);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (divided[i] == 0) {
        if (kept != i) cells_[kept] = cells_[i];
        ++kept;
      }
    cells_.resize(kept);
  }

  /// Divides a cell across its longest edge.
  void halve(std::size_t i) {
    const std::array<Vec3, 3> p = cells_[i].p;
    const Vec3 normal = cells_[i].normal;
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double l = (p[(k + 1) % 3] - p[k]).squaredNorm();
      if (l > length) length = l, longest = k;
    }
    const Vec3 &from = p[longest], &to = p[(longest + 1) % 3], &tip = p[(longest + 2) % 3];
    const Vec3 middle = 0.5 * (from + to);
    add({from, middle, tip}, normal);
    add({middle, to, tip}, normal);
  }

  const Field& a_;
  const Field& b_;
  double reach_;
  std::vector<SurfaceCell> cells_;
};

}  // namespace

Field::Field(const std::vector<Solid>& solids) : solids_(solids) {
  for (const Solid& s : solids) {
    to_world_.emplace_back(s.frame);
    to_local_.emplace_back(s.frame.inverse());
    for (const Vec3& v : s.mesh.vertices) box_.extend(to_world_.back() * v);
  }
}

Field::Seen Field::at(const Vec3& point, double limit) const {
  Seen best{-limit, Vec3::Zero()};
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    const Solid& s = solids_[k];
    const Vec3 x = to_local_[k] * point;
    const double to_box = s.box.squared_distance(x);
    if (to_box > limit * limit) continue;
    const bool inside = to_box <= 0 && s.bvh.inside(x);
    const ClosestPoint c = inside ? s.bvh.closest(x) : s.bvh.closest(x, limit);
    if (!inside && !(c.distance < limit)) continue;
    const double depth = inside ? c.distance : -c.distance;
    if (depth > best.depth) best = {depth, to_world_[k].r * s.normals[c.triangle]};
  }
  return best;
}

bool SurfaceCell::faces() const { return normal.dot(seen.normal) < -0.7; }  // within 45 degrees

std::vector<SurfaceCell> survey(const Field& a, const Field& b, double reach, double finest) {
  return Surveyor(a, b, reach).run(finest);
}

}  // namespace dismantle::verify
