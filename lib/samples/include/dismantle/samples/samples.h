/// Parametric example assemblies, each with a known truth.
///
/// Lengths are mm, angles rad; the frame is that of the files written. Every mesh of every sample is closed,
/// consistently oriented, of positive volume and free of self-intersections. The distance between two parts is at least
/// the sample's `clearance`, except for the pairs in Truth::contacts.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/contact_class.h"
#include "dismantle/export.h"
#include "dismantle/importer.h"
#include "dismantle/parameters.h"
#include "dismantle/pose.h"

namespace dismantle::samples {

/// The properties of a sample that are known before it is made.
struct Sample {
  std::string name;     ///< [a-z][a-z0-9_]*
  std::string summary;  ///< one line
  std::vector<ParamSpec> params;
  bool solvable = true;          ///< false: its parts cannot all be separated by rigid motions
  bool clean = true;             ///< false: parts overlap when assembled, as in real CAD; see Truth::contacts
  bool translation_only = true;  ///< every part leaves without rotation
  bool one_at_a_time = true;     ///< false: some step needs several parts to move simultaneously
};

/// Rotation by `angle` about the line through `point` along the unit vector `axis`, and translation `advance` on it.
struct Screw {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double angle = 0;    ///< rad, right-handed
  double advance = 0;  ///< mm
  /// Displacement after the fraction u in [0, 1] of the motion.
  DISMANTLE_API Pose at(double u) const;
};

/// Motion of one part, applied after its earlier motions.
struct TruthMotion {
  std::string part;
  Screw screw;
};

/// All motions of a step are simultaneous: at any time each has completed the same share.
struct TruthStep {
  std::vector<TruthMotion> motions;
  std::string out;  ///< the part that this step separates from all remaining ones; empty: none
};

/// Two parts that do not keep the clearance when assembled.
struct TruthContact {
  std::string a, b;
  ContactClass contact = ContactClass::kissing;
  double depth = 0;              ///< largest depth of a surface point of one in the other, mm
  double depth_error = 0;        ///< largest error of `depth` because flat faces approximate round ones, mm
  std::optional<Screw> apart{};  ///< a motion of `a` that separates the two without a deeper overlap; none: no rigid
                                 ///< motion does so
};

/// One disassembly sequence, and the precedence that holds in every sequence in which `base` stays to the end.
struct Truth {
  std::string base;                                             ///< the part that all others leave; empty: no such part
  std::vector<TruthStep> steps;                                 ///< empty when not solvable
  std::vector<std::pair<std::string, std::string>> precedence;  ///< (before, after), necessary, not transitive
  std::vector<TruthContact> contacts;                           ///< all other pairs keep the clearance
};

/// A sample: its parts and their truth.
struct Model {
  std::vector<RawPart> parts;  ///< names are file names without ".obj"
  Truth truth;
  double clearance = 0;  ///< lower bound of the distance, when assembled, of two parts not in `truth.contacts`, mm
};

/// All samples, in a fixed order.
DISMANTLE_API const std::vector<Sample>& list();
/// The sample of that name, or null.
DISMANTLE_API const Sample* find(const std::string& name);

/// Makes a sample with its truth; parameters not given have their defaults.
/// @throws std::invalid_argument for an unknown sample, an unknown parameter or a bad value.
DISMANTLE_API Model make_model(const std::string& name, const ParamSet& given = {});
/// The parts of make_model().
DISMANTLE_API std::vector<RawPart> make(const std::string& name, const ParamSet& given = {});

/// Writes each part as `dir`/NAME.obj; creates `dir` if needed. The same parts give the same bytes; coordinates are
/// the shortest decimals that read back as the same double. Returns the files in the order of `parts`.
/// @throws std::filesystem::filesystem_error when a file cannot be written.
DISMANTLE_API std::vector<std::filesystem::path> write(const std::vector<RawPart>& parts,
                                                       const std::filesystem::path& dir);

}  // namespace dismantle::samples
