// acme.in_turn: a sequence planner. Asks for one part after the other until none leaves; then the searches go deeper,
// as long as depth is what they lack.
#include <algorithm>
#include <optional>

#include "dismantle/plugin.h"

namespace {

enum class First { as_given, small, large };

struct AcmeInTurnParameters {
  First first = First::small;
  std::int64_t max_depth = 0;

  static void describe(dismantle::Schema<AcmeInTurnParameters>& s) {
    s.add_choice("first", &AcmeInTurnParameters::first,
                 {{"as_given", First::as_given, "as the assembly lists its parts"},
                  {"small", First::small, "ascending volume"},
                  {"large", First::large, "descending volume"}},
                 "Order in which parts are asked for.");
    s.add("max_depth", &AcmeInTurnParameters::max_depth,
          {.unit = "1", .min = 0, .max = 1e6, .doc = "Largest depth of a path search; 0 = no limit."});
  }
};

class AcmeInTurn final : public dismantle::SequencePlanner {
 public:
  explicit AcmeInTurn(const AcmeInTurnParameters& params) : params_(params) {}

  // Without other traits the start is one group of all parts as assembled, and there are no constraints.
  dismantle::SequenceResult plan(const dismantle::SequenceQuery& query, dismantle::PathOracle& oracle,
                                 dismantle::SequenceObserver& observer, dismantle::RunContext& context) override {
    const dismantle::Assembly& assembly = query.assembly;
    std::vector<dismantle::PartId> left = ordered(assembly);
    std::vector<std::optional<dismantle::Unsolved>> why(left.size());  // by part: what its last search said
    dismantle::SequenceResult result;
    bool stopped = false;
    unsigned depth = 1;
    for (bool go_on = true; go_on && left.size() > 1 && !stopped;) {
      bool removed = false, deeper = false;
      for (const dismantle::PartId part : std::vector(left)) {
        stopped = context.should_stop();
        if (stopped || left.size() < 2) break;
        const std::size_t all = assembly.parts.size() - 1;
        context.progress("sequence", result.removals.size(), all, assembly.parts[part].name);
        const dismantle::AttemptResult& answer = oracle.attempt(question(part, left, depth), context);
        const dismantle::PathResult& found = answer.result;
        if (is_success(found.outcome())) {
          removed = true;
          std::erase(left, part);
          result.removals.push_back({{part}, &answer});
          observer.removed(result.removals.back(), left.size());  // saved from now on
          context.progress("sequence", result.removals.size(), all, assembly.parts[part].name);
        } else {
          deeper = deeper || found.outcome() == dismantle::Outcome::depth_limit;
          why[part] = dismantle::Unsolved{part,          found.outcome(),   found.blocked_by, found.best_pose,
                                          found.message, answer.certificate};
        }
      }
      const bool may_go_deeper = deeper && (params_.max_depth == 0 || depth < params_.max_depth);
      if (!removed && may_go_deeper) ++depth;
      go_on = removed || may_go_deeper;
    }
    finish(result, left, why, stopped, context);
    return result;
  }

 private:
  std::vector<dismantle::PartId> ordered(const dismantle::Assembly& assembly) const {
    std::vector<dismantle::PartId> parts;
    for (const auto& part : assembly.parts) parts.push_back(part.id);
    const auto volume = [&](dismantle::PartId id) { return assembly.parts[id].volume; };
    std::stable_sort(parts.begin(), parts.end(), [&](dismantle::PartId a, dismantle::PartId b) {
      if (params_.first == First::as_given) return false;
      return params_.first == First::small ? volume(a) < volume(b) : volume(a) > volume(b);
    });
    return parts;
  }

  /// Can `part` leave, while all others that are left stay where they are?
  static dismantle::Attempt question(dismantle::PartId part, const std::vector<dismantle::PartId>& left,
                                     unsigned depth) {
    dismantle::Attempt attempt;
    attempt.max_depth = depth;
    attempt.moving.push_back({part, dismantle::Pose{}});
    for (const dismantle::PartId id : left)
      if (id != part) attempt.fixed.push_back({id, dismantle::Pose{}});
    return attempt;
  }

  /// Says how it ended, and for each part that is left why.
  static void finish(dismantle::SequenceResult& result, const std::vector<dismantle::PartId>& left,
                     std::vector<std::optional<dismantle::Unsolved>>& why, bool stopped,
                     const dismantle::RunContext& context) {
    result.remaining = left;
    result.outcome = dismantle::Outcome::solved;
    if (left.size() < 2) return;
    const auto end = context.cancel.cancelled() ? dismantle::Outcome::cancelled : dismantle::Outcome::timeout;
    bool depth_limit = false;
    for (const dismantle::PartId part : left) {
      dismantle::Unsolved reason =
          why[part].value_or(dismantle::Unsolved{part, end, {}, {}, "not asked for: the run was stopped before"});
      std::erase_if(reason.blocked_by,
                    [&](dismantle::PartId id) { return std::find(left.begin(), left.end(), id) == left.end(); });
      depth_limit = depth_limit || reason.outcome == dismantle::Outcome::depth_limit;
      result.unsolved.push_back(reason);
    }
    result.outcome = stopped ? end : depth_limit ? dismantle::Outcome::depth_limit : dismantle::Outcome::exhausted;
  }

  AcmeInTurnParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.in_turn", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::SequencePlanner, AcmeInTurn, AcmeInTurnParameters>(
      "acme.in_turn", "One part after the other, until none leaves.", {.source = "own"});
}
