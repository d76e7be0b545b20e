/// Step check: are equal parts put in one after the other?
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

/// Costs 1 when an equal part, or group of parts, is in place already and the operation before put in something else.
/// Over a whole plan this counts how often a series of equal parts is interrupted.
class IdenticalParts final : public StepCheck {
 public:
  StepCheckTraits traits() const noexcept override { return {.remembers_shape = true, .reads_path = false}; }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  /// By part of one assembly: the first part of the same shape.
  struct Shapes {
    std::vector<std::shared_ptr<const Mesh>> meshes;
    std::vector<std::size_t> first;
    /// Of these parts, sorted.
    std::vector<std::size_t> of(std::span<const PlacedPart> parts) const;
  };
  std::shared_ptr<const Shapes> shapes_of(const Assembly& assembly) const;

  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Shapes> known_;  // of the assembly that was asked about last
};

}  // namespace dismantle::checks
