/// Step check: are equal parts put in one after the other?
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/parameters.h"
#include "dismantle/pose.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

struct IdenticalPartsParameters {
  double another_way = 0;
  static void describe(Schema<IdenticalPartsParameters>& s);
};

/// Costs 1 when an equal part, or group of parts, is in place already and the operation before put in something else.
/// Over a whole plan this counts how often a series of equal parts is interrupted. Costs
/// `another_way` when the operation before put in an equal part, and along another direction: neither the same in the
/// world, nor the same as seen from the parts.
class IdenticalParts final : public StepCheck {
 public:
  explicit IdenticalParts(const IdenticalPartsParameters& params = {}) : params_(params) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_direction = params_.another_way > 0, .remembers_shape = true, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  /// By part of one assembly.
  struct Shapes {
    std::vector<std::pair<std::shared_ptr<const Mesh>, std::string>> known;  // with their kinds
    std::vector<std::size_t> first;                                          // the first part that is the same item
    std::vector<std::size_t> surface;                                        // the first part of the same surface
    std::vector<Pose> pose;                                                  // takes that part to this part
    /// Of these parts, sorted.
    std::vector<std::size_t> of(std::span<const PlacedPart> parts) const;
    /// Is each of `wanted` the shape of a part of its own?
    bool includes(std::span<const PlacedPart> parts, std::vector<std::size_t> wanted) const;
    /// The part whose item comes first.
    const PlacedPart& least(std::span<const PlacedPart> parts) const;
    /// Are the two directions the same, in the world or as seen from the parts?
    bool same_way(std::span<const PlacedPart> parts, const Eigen::Vector3d& direction,
                  std::span<const PlacedPart> others, const Eigen::Vector3d& other) const;
  };
  std::shared_ptr<const Shapes> shapes_of(const Assembly& assembly) const;

  IdenticalPartsParameters params_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Shapes> known_;  // of the assembly that was asked about last
};

}  // namespace dismantle::checks
