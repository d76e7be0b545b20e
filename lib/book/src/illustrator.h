/// Composes pictures of parts: content, viewpoint and the line of motion.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "balloons.h"
#include "dismantle/assembly.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"
#include "instructions.h"
#include "raster.h"
#include "style.h"
#include "words.h"

namespace dismantle {

/// A drawing with overlaid lines, in pixels of the image.
struct Picture {
  Image image;
  /// Dashed lines with an arrow head at the last point. Empty: none.
  std::vector<std::vector<Eigen::Vector2d>> arrows;
  /// Centre and radius of circles around details that would be overlooked.
  std::vector<std::pair<Eigen::Vector2d, double>> rings;
  std::vector<Balloon> balloons{};
};

/// By part: the number that stands in its circle, 0: none.
using PartNumbers = std::vector<std::size_t>;

/// Corner of the box around the assembly from which the viewer looks at it.
struct Viewpoint {
  bool left = false, back = false, below = false;
  bool usual() const { return !left && !back && !below; }
  /// "from the back left, from below"
  std::string words() const;
};

struct StepPictures {
  Picture apart;   ///< the moving parts away from their place, with the line of motion
  Picture placed;  ///< the moving parts in their place
  Viewpoint view;
  bool stretched = false;  ///< parts are drawn further from their place than in the plan
};

/// "seen from the back left; drawn further apart than needed", or nothing.
std::string caption_of(const StepPictures& pictures, const BookWords& words);

class Illustrator;

/// Pictures of the title page.
struct BookPictures {
  Picture whole, exploded;
};
/// @throws InputError when the plan names a part that the assembly does not have.
BookPictures front_pictures(const Plan& plan, const Assembly& assembly, const Illustrator& illustrator,
                            const PartNumbers& numbers);

class Illustrator {
 public:
  Illustrator(const Assembly& assembly, const Eigen::Vector3d& up);

  /// The parts at the given poses, from the usual viewpoint.
  Picture scene(const std::vector<PlacedPart>& parts, const PictureSize& size, const PartNumbers& numbers = {}) const;
  /// Two parts as assembled and a ring around the place `at`, input coordinates.
  Picture pair(PartId other, PartId marked, const Eigen::Vector3d& at) const;
  /// `scale`: factor for the style's sizes in pixels.
  /// `numbers`: of the parts that move and of those that are `held`.
  StepPictures step(const BookStep& step, bool disassembly, double scale = 1, const PartNumbers& numbers = {},
                    const std::vector<std::size_t>& held = {}) const;
  /// A moment of a step, from the usual viewpoint, with room for parts that leave.
  Image moment(const BookStep& step, const std::vector<PlacedPart>& movers, const PictureSize& size) const;
  const PictureStyle& style() const { return style_; }
  /// By part: the first part of the same shape.
  const std::vector<geometry::ShapePlacement>& shapes() const { return placements_; }

 private:
  struct Arrangement;
  /// Of all parts, with the movers in their place; input units.
  double extent_of(const BookStep& step, bool disassembly) const;
  Arrangement arranged(const BookStep& step, bool disassembly) const;
  static void align(const BookStep& step, Arrangement& arrangement);
  /// What stands there, and the movers, which are marked.
  std::vector<DrawnBody> bodies_with(const BookStep& step, const std::vector<PlacedPart>& movers) const;
  Picture draw_apart(const BookStep& step, const Arrangement& arrangement, bool disassembly, const PictureSize& size,
                     const PartNumbers& numbers, const std::vector<std::size_t>& held) const;
  Picture draw_placed(const BookStep& step, const Arrangement& arrangement, const PictureSize& size) const;
  /// `parts`: of the bodies.
  void number_parts(Picture& picture, const std::vector<DrawnBody>& bodies, const std::vector<std::size_t>& parts,
                    const Camera& camera, const PartNumbers& numbers, const std::vector<std::size_t>& held) const;
  DrawnBody body_of(const PlacedPart& placed, bool marked) const;
  /// `lies`: how the assembly is turned, from how it is drawn.
  Eigen::Matrix3d axes_of(const Viewpoint& view, const Eigen::Quaterniond& lies = Eigen::Quaterniond::Identity()) const;
  Camera camera_for(const std::vector<Eigen::Vector3d>& points, const Eigen::Matrix3d& axes, int width,
                    int height) const;
  std::vector<Eigen::Vector3d> corners(const std::vector<PlacedPart>& parts) const;
  /// Adds a circle around `parts` if together they are only a speck in the picture.
  void ring_specks(Picture& picture, const std::vector<PlacedPart>& parts, const Camera& camera) const;
  std::vector<PlacedPart> movers_at(const BookStep& step, const std::vector<std::size_t>& pose_indices) const;
  /// Shift beyond pose `away` that makes a short motion from pose `place` visible, input units.
  Eigen::Vector3d stretch(const BookMover& mover, std::size_t away, std::size_t place, double extent) const;
  Viewpoint best_view(const BookStep& step, const std::vector<PlacedPart>& away,
                      const std::vector<PlacedPart>& placed) const;

  const Assembly& assembly_;
  PictureStyle style_;
  InputFrame frame_;
  std::vector<geometry::ShapePlacement> placements_;
  std::vector<ShadedMesh> meshes_;        // by part; empty unless it is the first part of its shape
  std::vector<Eigen::Vector3d> centers_;  // by part: origin of its mesh, input units
  std::vector<Eigen::Vector3f> colours_;  // by part, sRGB
};

}  // namespace dismantle
