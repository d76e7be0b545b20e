/// Step check: does a tool reach the screws, nuts and circlips that are put in?
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dismantle/parameters.h"
#include "dismantle/step_check.h"
#include "dismantle/tools/catalogue.h"

namespace dismantle::checks {

class FastenerMemo;

struct ToolAccessParameters {
  std::string catalogue{};
  std::string only{};
  bool hand = true;
  static void describe(Schema<ToolAccessParameters>& s);
};

/// Costs 1 for each fastener that no tool of the catalogue reaches, and 0.1 for a change of the tool. Notes name the
/// tool, or what is in the way.
class ToolAccess final : public StepCheck {
 public:
  /// @throws ConfigError, InputError for a catalogue that cannot be used.
  explicit ToolAccess(const ToolAccessParameters& params = {});
  ~ToolAccess() override;
  StepCheckTraits traits() const noexcept override { return {.remembers_shape = true, .reads_path = false}; }
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;

 private:
  const std::vector<tools::Tool>& tools() const;
  std::shared_ptr<const FastenerMemo> memo_of(const Assembly& assembly) const;

  ToolAccessParameters params_;
  std::vector<tools::Tool>
      left_out_{};                // tools of the catalogue that `only` does not name; before `own_`, which fills it
  std::vector<tools::Tool> own_;  // empty: the standard catalogue
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const FastenerMemo> known_;  // of the assembly that was asked about last
};

}  // namespace dismantle::checks
