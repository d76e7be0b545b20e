/// Proofs that pairs hold each other, some of them sought on idle threads before they are asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dismantle/speculative_cache.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::blocking {

/// Do two parts hold each other?
struct HoldQuestion {
  enum class Kind : char {
    cage,               ///< Verifier::caged
    flat,               ///< Verifier::caged_flat, a within b
    confined_for_sure,  ///< Verifier::confined, for motions that cut in as deep as ways may
    confined_at_last,   ///< likewise, for motions that cut in half as deep
  };
  Kind kind;
  PartId a, b;  ///< a < b, except for flat pieces
  auto operator<=>(const HoldQuestion&) const = default;

  static HoldQuestion of_pair(Kind kind, PartId a, PartId b) { return {kind, std::min(a, b), std::max(a, b)}; }
};

/// What the judge says of a pair is a fact about the two, so it does not matter which thread finds it and when. One
/// caller.
class ProofsAhead {
 public:
  /// All must outlive this; `executor` may be null.
  ProofsAhead(const Verifier& judge, const Assembly& assembly, std::shared_ptr<Executor> executor)
      : judge_(judge), assembly_(assembly), known_(std::move(executor), Executor::Priority::speculative) {}

  /// Idle threads work on the first few of `wanted`, the likeliest to be asked first, that are not known. What is not
  /// among them any more is cancelled.
  void begin(std::span<const HoldQuestion> wanted, const RunContext& context);
  /// Why they do. Idle threads work on the first of `next` meanwhile.
  std::optional<std::string> answer(const HoldQuestion& question, std::span<const HoldQuestion> next,
                                    const RunContext& context);

 private:
  using Known = SpeculativeCache<HoldQuestion, std::optional<std::string>>;
  std::optional<std::string> ask(const HoldQuestion& question, const RunContext& context) const;

  const Verifier& judge_;
  const Assembly& assembly_;
  Known known_;
};

}  // namespace dismantle::blocking
