/// A plan as the checks see it that judge a plan as a whole.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/step_check.h"

namespace dismantle {

/// All operations, in the order of assembly. What is present is not copied for each: an operation shares
/// a list with those before it as long as the parts of the group only grow in number, and has its beginning.
class WholePlan {
 public:
  WholePlan(const Disassembly& done, const Assembly& assembly, const Eigen::Vector3d& up);
  std::span<const StepQuestion> all() const { return all_; }

 private:
  std::vector<PlacedPart>* new_list(std::size_t capacity);

  std::deque<std::vector<PlacedPart>> lists_;
  std::deque<Operation> operations_;
  std::deque<StepQuestion> alone_;
  std::vector<StepQuestion> all_;
};

}  // namespace dismantle
