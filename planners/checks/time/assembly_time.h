/// Step check: how long does a step take by hand?
#pragma once

#include <Eigen/Core>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/geometry/part_boxes.h"
#include "dismantle/parameters.h"
#include "dismantle/step_check.h"
#include "figures.h"
#include "symmetry.h"

namespace dismantle::checks {

struct TimeParameters {
  std::string table{};
  static void describe(Schema<TimeParameters>& s);
};

/// Costs the seconds that a step takes by hand, turning the whole included, and says them in a note; the plan's note
/// has the sum.
class Time final : public StepCheck {
 public:
  /// @throws std::invalid_argument for a table that cannot be read.
  explicit Time(const TimeParameters& params = {});
  StepCheckTraits traits() const noexcept override {
    return {.remembers_orientation = true, .judges_plan = true, .reads_path = false, .estimates = true};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;
  /// As if no part was symmetric.
  StepVerdict estimate(const StepQuestion& question, const RunContext& context) const override;
  StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext& context) const override;

 private:
  struct Scene {
    explicit Scene(const Assembly& assembly) : boxes(assembly), edges(assembly.parts.size()) {}
    bool is_of(const Assembly& assembly) const { return boxes.is_of(assembly); }
    /// Edges of the smallest box of a part, ascending.
    Eigen::Vector3d edges_of(const Part& part) const;
    /// `axis`: in the frame of the part.
    Symmetry symmetry(const Part& part, const Eigen::Vector3d& axis) const;
    geometry::PartBoxes boxes;

   private:
    mutable std::mutex mutex;
    mutable std::vector<std::optional<Eigen::Vector3d>> edges;
    mutable std::map<std::vector<double>, Symmetry> symmetries;
  };
  StepVerdict verdict_of(const StepQuestion& question, bool symmetric) const;
  std::optional<double> stated(const Part& part) const;

  std::vector<std::pair<std::string, double>> table_;
  geometry::OfLastAssembly<Scene> scenes_;
};

}  // namespace dismantle::checks
