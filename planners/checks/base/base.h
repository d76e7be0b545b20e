/// Step check: is the part that everything is put on a good base?
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "dismantle/geometry/part_boxes.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

/// Costs, once for a plan, from 0 (the base is the largest and lowest part, and has the most neighbours) to 1. Steps
/// cost nothing: which parts are the base is known when the order is.
class Base final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override {
    return {.judges_plan = true, .reads_path = false, .estimates = true};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;
  /// A step that no other one is before is the first: what is present is the base.
  StepVerdict estimate(const StepQuestion& question, const RunContext& context) const override;
  StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext& context) const override;

 private:
  struct Scene {
    explicit Scene(const Assembly& assembly);
    bool is_of(const Assembly& assembly) const { return boxes.is_of(assembly); }
    /// Parts outside of `parts` whose boxes touch a box of theirs.
    std::size_t neighbours(std::span<const PlacedPart> parts) const;
    geometry::PartBoxes boxes;
    double largest = 0;    // half_surface() of a part
    std::size_t most = 0;  // neighbours of a part
  };
  StepVerdict verdict_of(const Assembly& assembly, std::span<const PlacedPart> base, const Eigen::Vector3d& up) const;

  geometry::OfLastAssembly<Scene> scenes_;
};

}  // namespace dismantle::checks
