/// Proofs that pairs hold each other, some of them sought on idle threads before they are asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dismantle/crew.h"
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

/// What the judge says of a pair is a fact about the two, so it does not matter who finds it, and when. One caller.
class ProofsAhead {
 public:
  /// Both must outlive this.
  ProofsAhead(const Verifier& judge, const Assembly& assembly) : judge_(judge), assembly_(assembly) {}
  /// Tells what is still sought to stop, and waits for that.
  ~ProofsAhead();
  ProofsAhead(const ProofsAhead&) = delete;
  ProofsAhead& operator=(const ProofsAhead&) = delete;

  /// Offers the first of `wanted`, the likeliest to be asked first, to the context's crew. What is not among them any
  /// more is withdrawn, or told to stop.
  void begin(std::span<const HoldQuestion> wanted, const RunContext& context);
  /// Why they do. Idle threads work on the first of `next` meanwhile.
  std::optional<std::string> answer(const HoldQuestion& question, std::span<const HoldQuestion> next,
                                    const RunContext& context);
  std::size_t open() const;  ///< offers that have not come to an end

 private:
  struct Job {
    CancelToken cancel;
    std::shared_ptr<std::optional<std::string>> why;
    Crew::Offer offer;
  };
  std::optional<std::string> ask(const HoldQuestion& question, const RunContext& context) const;
  void drop_all_but(std::span<const HoldQuestion> wanted);

  const Verifier& judge_;
  const Assembly& assembly_;
  std::map<HoldQuestion, Job> jobs_;
  std::list<Job> dropped_;  // which come to an end
};

}  // namespace dismantle::blocking
