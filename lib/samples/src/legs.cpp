/// Furniture: a top, and legs that are screwed into it.
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "build.h"

namespace dismantle::samples {
namespace {

using std::numbers::pi;

struct LegParameters {
  int legs = 4, segments = 32;
  double diameter = 16, pitch = 4, length = 60, clearance = 0.15;
  static void describe(Schema<LegParameters>& s) {
    s.add("legs", &LegParameters::legs, {.unit = "1", .min = 1, .max = 16, .doc = "Number of legs below the top."});
    s.add("diameter", &LegParameters::diameter,
          {.unit = "mm", .min = 4, .max = 100, .doc = "Major diameter of the threads, and their length."});
    s.add("pitch", &LegParameters::pitch,
          {.unit = "mm",
           .min = 0.5,
           .max = 25,
           .doc = "Pitch of the right-handed, single-start threads; at most a quarter of `diameter`."});
    s.add("length", &LegParameters::length,
          {.unit = "mm", .min = 5, .max = 1000, .doc = "Length of a leg below the top."});
    s.add("clearance", &LegParameters::clearance,
          {.unit = "mm",
           .min = 0.001,
           .max = 0.5,
           .doc = "Distance between the flanks of leg and top; at most a tenth of `pitch`."});
    s.add("segments", &LegParameters::segments,
          {.unit = "1", .min = 24, .max = 512, .doc = "Number of flat faces per full turn of a round surface."});
  }
};

/// Square tiles in rows and columns, joined to one solid: neighbours share their corners, and the walls between them
/// are left out.
class Tiles {
 public:
  Tiles(int columns, int rows, double half) : columns_(columns), rows_(rows), half_(half) {}

  Point center(int column, int row) const {
    return {(2 * column - columns_ + 1) * half_, (2 * row - rows_ + 1) * half_, 0};
  }

  /// `tile` is centred on the z axis and has corners at (+-half, +-half).
  void put(const Mesh& tile, int column, int row) {
    std::vector<std::uint32_t> ids;
    std::vector<Corner> corners;
    for (const Point& v : tile.vertices) {
      const bool is_corner = std::abs(v.x()) == half_ && std::abs(v.y()) == half_;
      const Corner corner{column + (v.x() > 0), row + (v.y() > 0), v.z()};
      corners.push_back(is_corner ? corner : Corner{-1, -1, 0});
      const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
      const std::uint32_t id = is_corner ? known_.try_emplace(corner, next).first->second : next;
      if (id == next)
        mesh_.vertices.push_back(
            is_corner ? Point((2 * corner.column - columns_) * half_, (2 * corner.row - rows_) * half_, v.z())
                      : Point(v + center(column, row)));
      ids.push_back(id);
    }
    for (const Triangle& t : tile.triangles)
      if (!between({corners[t[0]], corners[t[1]], corners[t[2]]}))
        mesh_.triangles.push_back({ids[t[0]], ids[t[1]], ids[t[2]]});
  }

  const Mesh& mesh() const { return mesh_; }

 private:
  struct Corner {
    int column, row;  ///< -1: not a corner of a tile
    double z;
    auto operator<=>(const Corner&) const = default;
  };

  /// True if the triangle lies in a plane between two tiles.
  bool between(const std::array<Corner, 3>& c) const {
    const bool same_column = c[0].column == c[1].column && c[1].column == c[2].column;
    const bool same_row = c[0].row == c[1].row && c[1].row == c[2].row;
    return (same_column && c[0].column > 0 && c[0].column < columns_) || (same_row && c[0].row > 0 && c[0].row < rows_);
  }

  int columns_, rows_;
  double half_;
  Mesh mesh_;
  std::map<Corner, std::uint32_t> known_;
};

Model threaded_legs(const LegParameters& p) {
  if (p.pitch > p.diameter / 4) throw std::invalid_argument("threaded_legs: pitch is more than a quarter of diameter");
  if (p.clearance > p.pitch / 10) throw std::invalid_argument("threaded_legs: clearance is more than a tenth of pitch");
  Model model;
  model.clearance = p.clearance;
  model.truth.base = "top";
  const double d = p.diameter, sharp = p.pitch * std::numbers::sqrt3 / 2;  // H of ISO 68-1
  ThreadProfile external;
  external.pitch = p.pitch;
  external.crest_radius = d / 2;
  external.root_radius = d / 2 - 0.625 * sharp;
  external.crest_flat = p.pitch / 8;
  external.root_flat = p.pitch / 4;

  const double gap = std::max(p.clearance, 0.05 * d), bore = d + gap, thickness = 1.5 * d, half = 1.5 * d;
  const ThreadWall leg_wall = thread_wall(external, 0, d, p.segments);
  // As in bolt_and_nut: flanks are inclined by 30 degrees, and flat faces between the helix points cut into the bore.
  const double lead = std::atan2(p.pitch, 2 * pi * external.root_radius);
  const double shift = 2.02 * p.clearance / std::cos(lead) + 0.002 * p.pitch;
  const double half_gap = thread_wall(external, 0, bore, p.segments).half_gap;
  ThreadProfile internal = external;
  internal.crest_radius = (external.crest_radius + shift) / std::cos(half_gap);
  internal.root_radius = (external.root_radius + shift) / std::cos(half_gap);
  const ThreadWall bore_wall = thread_wall(internal, 0, bore, p.segments);

  const int columns = static_cast<int>(std::ceil(std::sqrt(p.legs))), rows = (p.legs + columns - 1) / columns;
  Tiles top(columns, rows, half);
  std::vector<std::pair<std::string, Mesh>> legs;
  for (int k = 0; k < columns * rows; ++k) {
    const int column = k % columns, row = k / columns;
    Loft tile;
    if (k < p.legs) tile.strip(reversed(bore_wall.mesh), bore_wall.top, bore_wall.bottom);
    top.put(tile.to(rectangle(half, half, 0)).to(rectangle(half, half, thickness)).capped(), column, row);
    if (k >= p.legs) continue;
    Loft leg;
    leg.to(circle(0.6 * d, -p.length, p.segments)).to(circle(0.75 * d, -gap, p.segments));
    leg.to(circle(external.root_radius - 0.05 * sharp, -gap, p.segments));
    Mesh mesh = leg.strip(leg_wall.mesh, leg_wall.bottom, leg_wall.top).capped();
    const Point at = top.center(column, row);
    for (Point& v : mesh.vertices) v += at;
    const std::string name = "leg_" + std::to_string(k + 1);
    legs.emplace_back(name, std::move(mesh));
    const double turns = (d + 0.2 * d) / p.pitch;
    model.truth.steps.push_back({{{name, {Point::UnitZ(), at, -2 * pi * turns, -turns * p.pitch}}}, ""});
    model.truth.steps.push_back(slide(name, Point(0, 0, -p.length - d), true));
  }
  add_part(model, "top", top.mesh());
  for (auto& [name, mesh] : legs) add_part(model, name, std::move(mesh));
  return model;
}

}  // namespace

std::vector<Maker> leg_makers() {
  return {maker<LegParameters>("threaded_legs", "A top with legs that are screwed into it by coarse threads.",
                               &threaded_legs, {.translation_only = false})};
}

}  // namespace dismantle::samples
