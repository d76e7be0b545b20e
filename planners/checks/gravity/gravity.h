/// Step check: does what has been built stand, and which parts have to be held?
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dismantle/computed_once.h"
#include "dismantle/parameters.h"
#include "dismantle/statics/built.h"
#include "dismantle/statics/hands_bound.h"
#include "dismantle/statics/hold_proof.h"
#include "dismantle/statics/holds.h"
#include "dismantle/statics/model.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

struct GravityParameters {
  std::string fixed{};
  std::int64_t hands = 2;
  double friction = 0.4;
  std::string density{};
  std::int64_t most_parts = 150;
  static void describe(Schema<GravityParameters>& schema);
};

/// Costs the number of parts that somebody has to hold, besides the one in hand. A question is answered to the end,
/// even if the run is stopped meanwhile: the plan so far is judged as it would be otherwise.
class Gravity final : public StepCheck {
 public:
  /// @throws std::invalid_argument for a density that cannot be read.
  explicit Gravity(const GravityParameters& params = {});
  StepCheckTraits traits() const noexcept override {
    return {.remembers_orientation = true, .judges_plan = true, .reads_path = false, .estimates = true};
  }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;
  /// The parts after the step that do not stand by themselves if everything else stays.
  StepVerdict estimate(const StepQuestion& question, const RunContext& context) const override;
  /// Says whether some steps had too many parts, and how many hands any order takes at least.
  StepVerdict judge_plan(std::span<const StepQuestion> operations, const RunContext& context) const override;

 private:
  struct Hold {
    PartId part = 0;
    double newton = 0;
    std::string motion, why;  // without the hold; empty: not known
  };
  struct State {
    std::vector<Hold> holds;
    bool found = true, proved = true;
    statics::Gaps gaps = statics::Gaps::play;
    double push = 0;                // times the weight of the part that is put in, along its path
    statics::Motions displacement;  // that creates the forces on its pile; empty: not known
    statics::Numbers numbers;       // the proof; empty: none
    std::string picture;            // picture_json(); empty: nothing is held
  };
  using StatePtr = std::shared_ptr<const State>;
  /// By everything that they depend on.
  using KnownStates = std::map<std::vector<double>, std::shared_ptr<ComputedOnce<StatePtr>>>;
  struct Scene {
    std::unique_ptr<const statics::BuiltPiles> piles;
    KnownStates at_rest, while_put_in;
    statics::KnownJudgements judgements;
    std::set<std::vector<double>> bound_of;  // what the bound was asked about last: units and orientations
    std::shared_ptr<const statics::HandsBound> bound;
  };
  std::shared_ptr<Scene> scene_of(const Assembly& assembly) const;
  static std::string picture_of(const statics::Holds& holds, const statics::BuiltPile& built,
                                std::span<const PlacedPart> parts, const Assembly& assembly);
  State holds_of(Scene& scene, const statics::BuiltPile& built, std::span<const PlacedPart> parts,
                 const Assembly& assembly) const;
  StatePtr at_rest(Scene& scene, const Assembly& assembly, std::span<const PlacedPart> parts, const Eigen::Vector3d& up,
                   bool table, const RunContext& context) const;
  static std::optional<Certificate> proof_of(std::span<const PlacedPart> parts, const State& after, const State& during,
                                             const State& turned, double gap);
  std::shared_ptr<const statics::HandsBound> bound_of(std::span<const StepQuestion> operations) const;
  StatePtr while_put_in(Scene& scene, const StepQuestion& question, const RunContext& context) const;
  StatePtr pressed_and_pulled(Scene& scene, const StepQuestion& question, const std::vector<PlacedPart>& present,
                              const RunContext& context) const;
  /// What `known` has; otherwise `find()`, which is kept. Threads that ask meanwhile wait.
  template <class Find>
  StatePtr kept(KnownStates& known, std::vector<double> key, const RunContext& context, const Find& find) const {
    std::shared_ptr<ComputedOnce<StatePtr>> once;
    {
      const std::lock_guard lock(mutex_);
      auto& at = known[std::move(key)];
      if (!at) at = std::make_shared<ComputedOnce<StatePtr>>();
      once = at;
    }
    return *once->get(context, [&] { return std::optional<StatePtr>(find()); });
  }

  GravityParameters params_;
  statics::StatedModel model_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<Scene> scene_;  // of the assembly that was asked about last
};

}  // namespace dismantle::checks
