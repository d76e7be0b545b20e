/// State of an assembly in the course of a plan that is being checked.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/path_planner.h"
#include "dismantle/plan.h"

namespace dismantle {

/// A step in terms of the assembly: assembly units, parts by id.
struct StepMotion {
  std::vector<PartId> moving;
  Path path;
};

/// Reads the steps of a plan and checks the rules that need little geometry. Problems are plain text.
class PlanState {
 public:
  explicit PlanState(const Assembly& assembly);

  std::optional<PartId> find(const std::string& name) const;
  const std::string& name(PartId id) const { return assembly_->parts[id].name; }
  /// Converts poses to assembly units. Checks names and counts, that poses are finite with unit quaternions, and that
  /// no point travels too far between poses. Returns nullopt for an unusable step.
  std::optional<StepMotion> read(const std::vector<PlanMove>& moves, std::vector<std::string>& problems) const;
  /// Checks rule (a), the start pose of `id`. Returns the error, or nullopt.
  std::optional<std::string> wrong_start(PartId id, const Pose& start) const;
  /// Largest distance between the corners of the part's box at the two poses, assembly units.
  double offset(PartId id, const Pose& a, const Pose& b) const;

  /// Do the groups satisfy what was asked for?
  bool does(const PlanAsked& asked) const;

  std::vector<Pose> place;                  ///< by part, assembly units
  std::vector<std::vector<PartId>> groups;  ///< parts that are not separated yet
  double tolerance() const { return 1e-6 * size_; }

 private:
  const Assembly* assembly_;
  std::map<std::string, PartId> ids_;
  double size_ = 0;  // largest edge of the assembly's box, assembly units
};

}  // namespace dismantle
