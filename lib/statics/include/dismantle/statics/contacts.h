/// Where parts touch.
///
/// Faces that lie against each other give one contact for each common plane, whatever the triangulation; curved
/// surfaces give points spread over the common region; an edge or a corner on a face gives its points. A gap, or an
/// overlap, of up to a share of the smaller part counts as touching.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/mesh.h"
#include "dismantle/pose.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Gap that counts as touching, as a share of the radius of the smaller part.
inline constexpr double kTouching = 0.004;

/// A part with what is needed to find its contacts and its weight. Its own frame.
class DISMANTLE_API Shape {
 public:
  explicit Shape(const Mesh& mesh);
  ~Shape();
  Shape(Shape&&) noexcept;

  double volume() const;
  Eigen::Vector3d center() const;  ///< centre of mass of a body of one material
  double radius() const;           ///< of the ball about it that holds the part
  const Mesh& mesh() const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// A part where it is.
struct PlacedShape {
  const Shape* shape = nullptr;
  Pose pose{};
};

/// Contacts of two parts; Contact::a, b and friction are left to the caller. `touching`: share of the smaller radius.
DISMANTLE_API std::vector<Contact> contacts_between(const PlacedShape& a, const PlacedShape& b, double touching);

/// Contact of a part with a flat table whose surface has the unit normal `up` at `height` = up . p; no points: none.
DISMANTLE_API Contact contact_with_table(const PlacedShape& part, const Eigen::Vector3d& up, double height,
                                         double touching);

/// Lowest value of up . p.
DISMANTLE_API double lowest(const PlacedShape& part, const Eigen::Vector3d& up);

}  // namespace dismantle::statics
