/// Removes a single part by several translations, through its motion states.

#pragma once

#include "blocking_graph/strategy.h"
#include "state_based/motion_states.h"

namespace dismantle::state_based {

class TranslateOut final : public blocking::Strategy {
 public:
  /// All references must outlive this.
  TranslateOut(blocking::DisassemblyState& state, MotionStates& states, PathOracle& oracle)
      : state_(state), states_(states), oracle_(oracle) {}
  std::string_view name() const noexcept override { return "translate_out"; }
  blocking::Cost cost() const noexcept override { return blocking::Cost::arrangements; }
  blocking::Result apply(GroupState& group) override;
  void on_group_changed(GroupState&, const blocking::GroupChange&) override { states_.on_group_changed(); }

 private:
  bool propose(GroupState& group, SubassemblyId id, const std::vector<Eigen::Vector3d>& waypoints);

  blocking::DisassemblyState& state_;
  MotionStates& states_;
  PathOracle& oracle_;
};

}  // namespace dismantle::state_based
