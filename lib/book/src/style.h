/// Appearance of the pictures and pages of a book. None of these numbers changes the content of a book.
#pragma once

#include <Eigen/Core>

namespace dismantle {

/// Pixels.
struct PictureSize {
  int width = 0, height = 0;
};

/// The lines of a drawing. Colours are sRGB, [0, 1]; opacities are in [0, 1].
struct LineStyle {
  int samples = 2;              ///< per pixel and axis
  float crease_cosine = 0.82f;  ///< an edge is drawn where normals of neighbouring samples differ by more
  float outline = 0.8f;         ///< opacity of the edge between bodies or depths
  float crease = 0.4f;          ///< opacity of an edge within a surface, and of hidden outlines
  float shimmer = 0.28f;        ///< opacity of a marked body that is behind others
  Eigen::Vector3f ink{0.13f, 0.15f, 0.19f};
};

/// What a picture shows and from where.
struct PictureStyle {
  PictureSize step{760, 570};       ///< the parts apart
  PictureSize placed{360, 240};     ///< the parts in their place
  PictureSize item{200, 140};       ///< one part in the bill of materials
  PictureSize front{520, 420};      ///< the title page
  PictureSize box{120, 84};         ///< one part in the box of the parts of a step
  std::size_t most_balloons = 40;   ///< more are not legible
  double fade = 0.09;               ///< rim of a picture that shows a detail, relative to its height
  double film = 0.62;               ///< size of the assembly in a film, relative to a picture that it fills
  double margin = 1.12;             ///< size of the picture, relative to the bodies shown
  double smallest = 0.14;           ///< smallest share of the picture that the moving parts fill
  double furthest = 1.1;            ///< largest distance of a part from its place, relative to the fixed parts
  double nearest = 0.16;            ///< smallest distance, relative to the fixed parts
  double speck = 0.07;              ///< parts smaller than this share of the picture's width get a ring
  double ring = 0.045;              ///< radius of the ring around a place, relative to the width
  double better_view = 1.5;         ///< another viewpoint is chosen if this many times more of the part is visible
  PictureSize view_test{160, 120};  ///< size of the drawings for comparing viewpoints
  Eigen::Vector3f accent{0.98f, 0.62f, 0.10f};  ///< of moving parts
  Eigen::Vector3f tool{0.18f, 0.60f, 0.47f};
  LineStyle lines;
};

/// A page of the PDF, points.
struct PageStyle {
  double width = 842, height = 595;  ///< A4 landscape
  double margin = 40;
  double smallest_type = 5.5;              ///< of text that would not fit otherwise
  int item_columns = 5, item_rows = 3;     ///< of a page of the bill of materials
  double box_width = 92, box_height = 74;  ///< a part in the box of the parts of a step
  Eigen::Vector3d held{0.05, 0.48, 0.58};  ///< circles at parts to hold
  Eigen::Vector3d text{0.13, 0.15, 0.19}, soft{0.4, 0.44, 0.52}, accent{0.76, 0.25, 0.05}, forced{0.8, 0, 0};
};

}  // namespace dismantle
