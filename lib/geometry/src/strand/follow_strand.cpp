#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dismantle/geometry/face_axes.h"
#include "dismantle/geometry/inner_ball.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/ray.h"
#include "dismantle/geometry/strand.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "strand/section.h"

namespace dismantle::geometry {
namespace {

using Vec3 = Eigen::Vector3d;
using std::numbers::pi;

// Lengths are in units of 4 volume / surface: the thickness of a round strand.
constexpr double kSlender = 8;     // least length / thickness: shorter bodies are rods
constexpr double kStep = 0.5;      // distance of cuts / thickness: coils of springs turn by a few degrees in one step
constexpr int kStarts = 16;        // start points, evenly over the surface; one on the strand suffices
constexpr double kFlattest = 0.6;  // 4 pi area / outline^2: flatter than a 3:1 rectangle
constexpr double kLargest = 2.2 * pi / 4;  // area of a section: flat ones and ends of strands change it
const double kOutline = std::sqrt(4 * pi * kLargest / kFlattest);  // of a section at most

struct Station {
  Section cut;
  Vec3 along;  // unit
};

class Follower {
 public:
  Follower(const Mesh& mesh, double most_stations) : mesh_(mesh), bvh_(mesh), most_(most_stations) {}

  std::optional<Strand> from(const Vec3& surface, const Vec3& inward) {
    const double radius = inner_ball_radius(bvh_, surface, inward, 1);
    auto first = first_cut(surface + radius * inward, inward);
    if (!first) return std::nullopt;
    area_ = first->cut.area;
    thickness_ = std::sqrt(4 * area_ / pi);
    std::vector<Station> line = follow(*first);
    const bool closed = closed_;
    if (!closed) {
      std::vector<Station> back = follow({first->cut, -first->along});
      std::reverse(back.begin(), back.end());
      for (Station& s : back) {
        s.along = -s.along;
        std::reverse(s.cut.rim.begin(), s.cut.rim.end());
      }
      back.pop_back();  // the first station is also in `line`
      back.insert(back.end(), line.begin(), line.end());
      line = std::move(back);
    }
    return measured(line, closed);
  }

 private:
  std::optional<Section> cut(const Vec3& point, const Vec3& along) const {
    // Rejects outlines that extend beyond 2.5 thicknesses or are flatter than a 3:1 rectangle.
    auto found = section_around(mesh_, bvh_, point, along, 2.5 * std::max(1.0, thickness_));
    if (found && 4 * pi * found->area < kFlattest * found->outline * found->outline) found.reset();
    return found;
  }

  /// False: no section that a strand may have holds the nearest points of the surface on a line through `point`, on
  /// both sides of it. The outline passes both, so it is at least twice as long as their distance.
  bool may_be_across(const Vec3& point, const Vec3& direction) const {
    double across = 0;
    for (const Vec3& side : {direction, Vec3(-direction)}) {
      across += first_hit(bvh_, point, side, kOutline / 2, [](std::uint32_t) { return true; });
      if (across > (0.5 + 1e-6) * kOutline) return false;
    }
    return true;
  }

  /// The smallest cut through a point among planes that contain the normal there; then a cut perpendicular to the
  /// strand.
  std::optional<Station> first_cut(const Vec3& point, const Vec3& normal) const {
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    std::optional<Station> best;
    if (!may_be_across(point, normal)) return std::nullopt;  // the normal is in all these planes
    for (int k = 0; k < 24; ++k) {
      const double angle = pi * k / 24;
      const Vec3 along = std::cos(angle) * u + std::sin(angle) * v;
      if (!may_be_across(point, along.cross(normal))) continue;
      auto found = cut(point, along);
      if (found && (!best || found->area < best->cut.area)) best = Station{std::move(*found), along};
    }
    // A round strand has the area of a circle of diameter 1.
    if (!best || best->cut.area < 0.6 * pi / 4 || best->cut.area > kLargest) return std::nullopt;
    const double step = kStep * std::sqrt(4 * best->cut.area / pi);
    const auto on = cut(best->cut.center + step * best->along, best->along);
    const auto back = cut(best->cut.center - step * best->along, best->along);
    if (!on || !back) return std::nullopt;
    const Vec3 along = (on->center - back->center).normalized();
    auto again = cut(best->cut.center, along);
    if (!again) return std::nullopt;
    return Station{std::move(*again), along};
  }

  /// The first station and its successors. Sets closed_ if the last is next to the first.
  std::vector<Station> follow(const Station& first) {
    closed_ = false;
    std::vector<Station> line{first};
    Vec3 chord_before = Vec3::Zero();
    const double step = kStep * thickness_;
    while (static_cast<double>(line.size()) < most_) {
      const Station& last = line.back();
      const Vec3 ahead = last.cut.center + step * last.along;
      const auto rough = cut(ahead, last.along);
      if (!rough) break;
      const Vec3 along = leads(last.along, rough->center - last.cut.center, chord_before);
      auto found = cut(rough->center, along);
      if (!found || std::abs(found->area - area_) > 0.25 * area_) break;  // the section changes
      if ((found->center - ahead).norm() > 0.25 * thickness_) break;      // it bends more than a strand
      const Vec3 chord = found->center - last.cut.center;
      const Vec3 next = leads(last.along, chord, chord_before);
      chord_before = chord.normalized();
      if (line.size() > 3 && (found->center - first.cut.center).norm() < 0.75 * step && next.dot(first.along) > 0.5) {
        closed_ = true;
        break;
      }
      line.push_back({std::move(*found), next});
    }
    return line;
  }

  /// Tangent at the end of a chord: extrapolates the turn between chords, or assumes a circle at the first chord.
  static Vec3 leads(const Vec3& along, const Vec3& chord, const Vec3& chord_before) {
    const Vec3 c = chord.normalized();
    if (chord_before.isZero()) return (2 * along.dot(c) * c - along).normalized();
    return (1.5 * c - 0.5 * chord_before).normalized();
  }

  static double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  std::optional<Strand> measured(std::vector<Station>& line, bool closed) const {
    const std::size_t n = line.size();
    if (n < 4) return std::nullopt;
    Strand out;
    out.closed = closed;
    std::vector<double> areas, round;
    for (const Station& s : line) {
      areas.push_back(s.cut.area);
      round.push_back(4 * pi * s.cut.area / (s.cut.outline * s.cut.outline));
    }
    out.thickness = std::sqrt(4 * median(areas) / pi);
    out.roundness = median(round);
    std::vector<Vec3> chords;
    for (std::size_t k = 0; k + 1 < n; ++k) chords.push_back(line[k + 1].cut.center - line[k].cut.center);
    if (closed) chords.push_back(line.front().cut.center - line.back().cut.center);
    double volume = 0;
    for (std::size_t k = 0; k < chords.size(); ++k) {
      out.length += chords[k].norm();
      volume += 0.5 * (areas[k] + areas[(k + 1) % n]) * chords[k].norm();
    }
    if (!closed) {  // on average half a step remains at each end
      out.length += kStep * thickness_;
      volume += 0.5 * kStep * thickness_ * (areas.front() + areas.back());
    }
    out.share = volume / signed_volume(mesh_);
    out.turns.assign(n, 0);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = closed ? 0 : 1; k < n && k < chords.size(); ++k) {
      const Vec3 a = chords[(k + chords.size() - 1) % chords.size()].normalized(), b = chords[k].normalized();
      const Vec3 across = a.cross(b);
      out.turns[k] = std::atan2(across.norm(), a.dot(b));
      if (across.norm() > 0) sum += out.turns[k] * across.normalized();
    }
    out.coils = sum.norm() / (2 * pi);
    if (out.length < kSlender * out.thickness) return std::nullopt;
    for (Station& s : line) out.stations.push_back({s.cut.center, std::move(s.cut.rim)});
    return out;
  }

  const Mesh& mesh_;
  const TriangleBvh bvh_;
  double most_;
  double area_ = 0, thickness_ = 0;  // of the first cut
  bool closed_ = false;
};

}  // namespace

std::optional<Strand> follow_strand(const Mesh& mesh) {
  const double volume = signed_volume(mesh), area = surface_area(mesh);
  if (!(volume > 0) || !(area > 0)) return std::nullopt;
  const double unit = 4 * volume / area;
  const double slender = volume / (pi / 4 * unit * unit * unit);  // largest length / thickness: that of a round one
  if (slender < 0.75 * kSlender) return std::nullopt;             // allows a quarter of the volume beside the strand
  const Vec3 origin = mesh.box().center();
  Mesh scaled = mesh;
  for (Vec3& v : scaled.vertices) v = (v - origin) / unit;

  Follower follower(scaled, 16 + 4 * slender / kStep);
  std::optional<Strand> best;
  double passed = 0;
  int starts = 0;
  for (std::size_t t = 0; t < scaled.triangles.size() && starts < kStarts; ++t) {
    const Vec3 across = area_vector(scaled, t);
    passed += 0.5 * across.norm();
    if (passed < (starts + 0.5) / kStarts * area / (unit * unit)) continue;
    while (starts < kStarts && passed >= (starts + 0.5) / kStarts * area / (unit * unit)) ++starts;
    const Vec3 middle = (scaled.vertex(t, 0) + scaled.vertex(t, 1) + scaled.vertex(t, 2)) / 3;
    auto found = follower.from(middle, -across.normalized());
    if (found && (!best || found->share > best->share)) best = std::move(found);
    if (best && best->share > 0.95) break;  // no volume is left for another strand
  }
  if (!best) return std::nullopt;
  best->thickness *= unit;
  best->length *= unit;
  for (StrandStation& s : best->stations) {
    s.center = origin + unit * s.center;
    for (Vec3& p : s.rim) p = origin + unit * p;
  }
  return best;
}

}  // namespace dismantle::geometry
