/// Parts in assembled position, in assembly units.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/contact_class.h"
#include "dismantle/mesh.h"
#include "dismantle/parameters.h"
#include "dismantle/part_kind.h"
#include "dismantle/pose.h"
#include "dismantle/reference_step.h"
#include "dismantle/rgba.h"

namespace dismantle {

/// Index into Assembly::parts.
using PartId = std::uint32_t;

/// One rigid part. `mesh` holds the original triangles (welded, oriented, repaired), scaled to assembly units; the
/// verifier works on it. `surface` is the same surface with no edge longer than the `subdivide` parameter (appendix
/// B.1, step 9); simulators take their contact points from it.
struct Part {
  PartId id = 0;
  std::string name;  ///< unique in the assembly
  std::string file;  ///< file name (not path) that it came from
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const Mesh> surface;
  double volume = 0;                 ///< assembly units cubed, > 0 unless the part is open
  std::optional<Rgba> colour;        ///< as in its file
  std::vector<std::string> parents;  ///< assemblies in its file that contain it, outermost first
  /// Ids, unique in the assembly, of the uses of products that contain the part, outermost first; the last one is the
  /// product whose body it is. Empty: its file has no products.
  std::vector<std::string> instances{};
  std::string product{};            ///< name of the product whose body it is; empty: not known
  bool open = false;                ///< the surface has a boundary and is a wall; `volume` is then an estimate, or 0
  std::optional<double> density{};  ///< g/cm3, as its file states it
  std::optional<PartKind> kind{};   ///< none: not looked at
  std::optional<PartId> unit{};     ///< the same for all parts that are kept together, as one body; none: by itself
};

/// From input units to assembly units: internal = scale * (input - center).
struct Normalization {
  double scale = 1;  ///< > 0
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_internal(const Eigen::Vector3d& p) const { return scale * (p - center); }
  Eigen::Vector3d to_input(const Eigen::Vector3d& p) const { return p / scale + center; }
  /// Converts a pose on internal coordinates to the equivalent pose on input coordinates, and back.
  Pose pose_to_input(const Pose& p) const { return {center - p.q * center + p.t / scale, p.q}; }
  Pose pose_to_internal(const Pose& p) const { return {scale * (p.t + p.q * center - center), p.q}; }
};

/// Surface repair settings: the parameters of the same names in PrepareOptions. A plan must be verified on surfaces
/// that were repaired with the same settings.
struct SurfaceRepair {
  double weld = 1e-6;
  bool repair = true;
  double max_hole = 0.1;
  bool operator==(const SurfaceRepair&) const = default;
};

/// A part of the input that is not part of the assembly, and why.
struct ExcludedPart {
  std::string name;
  std::string reason;
  bool by_choice = false;  ///< excluded by a rule of the configuration; otherwise it was unusable
};

/// Importer parameters that differ from their defaults, by importer. Other values give other surfaces.
using ImportParameters = std::map<std::string, ParamSet>;

/// Two parts that penetrate each other when assembled (usual in CAD). depth: assembly units, > 0.
struct InitialOverlap {
  PartId a = 0, b = 0;  ///< a < b
  double depth = 0;
  std::optional<OverlapPlace> place{};  ///< assembly units; none: not classified
  /// Depth that the user allows for this pair, whatever its overlap; assembly units. If set, `depth` may be 0.
  std::optional<double> declared{};

  /// Allowed penetration along a path: `declared` if set, otherwise the depth when assembled. For the classes `inside`
  /// and `duplicate` the latter counts as 0, because it would let the parts pass through each other.
  double allowed() const {
    if (declared) return *declared;
    const bool through = place && (place->contact == ContactClass::inside || place->contact == ContactClass::duplicate);
    return through ? 0 : depth;
  }
};

/// Input of planning: the parts in assembled position, and their relation to the input files.
struct Assembly {
  std::string source;  ///< as the user named it
  std::string sha256;  ///< of the input files' bytes, in name order
  Normalization normalization;
  SurfaceRepair repair;
  ImportParameters import_params;
  std::string unit;  ///< input unit ("mm", "inch", "m") if the files say so and agree; else empty
  Aabb input_box;    ///< of all parts kept, input units
  std::vector<Part> parts;
  std::vector<ExcludedPart> excluded;
  std::vector<InitialOverlap> overlaps;          ///< sorted by (a, b); measured on the original triangles
  std::vector<ReferenceStep> reference_order{};  ///< how its author builds it, if the file says so; ids of parts

  /// InitialOverlap::allowed() of the pair; 0 if it has no entry.
  double initial_overlap(PartId a, PartId b) const {
    const InitialOverlap* o = overlap_of(a, b);
    return o == nullptr ? 0 : o->allowed();
  }
  /// Null for pairs that neither overlap nor have a declared depth.
  const InitialOverlap* overlap_of(PartId a, PartId b) const {
    if (a > b) std::swap(a, b);
    for (const auto& o : overlaps)
      if (o.a == a && o.b == b) return &o;
    return nullptr;
  }
};

}  // namespace dismantle
