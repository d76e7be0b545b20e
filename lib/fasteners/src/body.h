// A turned part with its sections, and the recognisers of single kinds.
#pragma once

#include <optional>
#include <vector>

#include "dismantle/fasteners/shape.h"
#include "turned.h"

namespace dismantle::fasteners {

struct Thread;

/// A mesh about its axis, cut at equal distances.
struct Body {
  const Mesh& mesh;
  Turned turned;
  std::vector<Section> sections;  // from low to high
  double mm;                      // per unit of the mesh
  double share;                   // of the surface that is turned
  std::size_t shells;
};

/// A body with one of its ends at the bottom.
class View {
 public:
  View(const Body& body, bool flipped) : body_(body), flipped_(flipped) {}
  std::size_t size() const { return body_.sections.size(); }
  const Section& operator[](std::size_t i) const { return body_.sections[flipped_ ? size() - 1 - i : i]; }
  double height() const { return body_.turned.height(); }
  double mm() const { return body_.mm; }
  double z(std::size_t i) const { return from_bottom((*this)[i].z); }
  Section cut(double z) const {
    return body_.turned.section(flipped_ ? body_.turned.high() - z : body_.turned.low() + z);
  }
  Eigen::Vector3d axis() const { return flipped_ ? Eigen::Vector3d(-body_.turned.axis()) : body_.turned.axis(); }
  Eigen::Vector3d top() const { return body_.turned.at(flipped_ ? body_.turned.low() : body_.turned.high()); }
  const Body& body() const { return body_; }
  /// Height between `low` and `high` at which the outer radius grows beyond `radius`.
  double rise(double low, double high, double radius) const;

 private:
  double from_bottom(double z) const { return flipped_ ? body_.turned.high() - z : z - body_.turned.low(); }
  const Body& body_;
  bool flipped_;
};

/// A drive with its size.
struct DriveFound {
  Drive drive = Drive::none;
  double size = 0;   // mm across flats, or the number of a Torx
  double depth = 0;  // of a recess, unit of the mesh
};
/// The recess at the top of a body that is solid below.
DriveFound recess_of(const View& view);
/// The outline of a head as a hexagon or square.
DriveFound grip_of(const Section& section, double mm);

/// Pitch of a helix about the axis near height `z`, in the unit of the mesh; 0: none. `radius`: of the thread.
double pitch_at(const View& view, double z, double radius, bool internal);

/// What is known of a screw or nut besides its diameter; mm, 0: not known.
struct ThreadClues {
  double pitch = 0, head = 0, key = 0;
  Drive drive = Drive::none;
};
/// The thread whose nominal diameter fits best; null: none fits.
const Thread* external_thread(double diameter, const ThreadClues& clues);
const Thread* internal_thread(double hole, double across_flats, bool square);

/// Each returns none where the shape is of another kind.
std::optional<Shape> screw_of(const Body& body);
std::optional<Shape> nut_of(const Body& body);
std::optional<Shape> ring_of(const Body& body);  ///< washer, spacer, bearing, gear, pulley, wheel
std::optional<Shape> bar_of(const Body& body);   ///< pin, shaft
/// Of parts whose kind is known.
std::optional<Shape> screw_form(const Body& body);
std::optional<Shape> nut_form(const Body& body);
std::optional<Shape> slot_nut_of(const Mesh& mesh, double mm);
std::optional<Shape> flat_of(const Mesh& mesh, double mm);    ///< plate, rail
std::optional<Shape> strand_of(const Mesh& mesh, double mm);  ///< spring, ring, belt

/// Number of teeth of an outline: equal maxima in equal distances; 0: it has no teeth.
int teeth_of(const Radii& radii);

}  // namespace dismantle::fasteners
