/// Proofs that pairs hold each other, some of them sought on other threads before they are asked for.
#pragma once

#include <compare>
#include <cstddef>
#include <future>
#include <list>
#include <map>
#include <optional>
#include <span>

#include "dismantle/verify/verifier.h"

namespace dismantle::blocking {

/// What the judge says of a pair is a fact about the two, so it does not matter who finds it, and when. One caller.
class ConfinementsAhead {
 public:
  /// Of Verifier::confined.
  struct Question {
    PartId a, b;  ///< a < b
    double share;
    auto operator<=>(const Question&) const = default;
  };

  /// `judge` must outlive this.
  explicit ConfinementsAhead(const Verifier& judge) : judge_(judge) {}
  /// Tells what is still sought to stop, and waits for that.
  ~ConfinementsAhead();
  ConfinementsAhead(const ConfinementsAhead&) = delete;
  ConfinementsAhead& operator=(const ConfinementsAhead&) = delete;

  /// Begins with the first of `wanted`, the likeliest to be asked first, as long as less than so many threads are at
  /// work here. What is not among them any more is told to stop.
  void begin(std::span<const Question> wanted, std::size_t threads, const RunContext& context);
  /// With more than one thread, the others work on the first of `next` meanwhile.
  std::optional<Confinement> answer(const Question& question, std::span<const Question> next,
                                    const RunContext& context);
  std::size_t working() const;  ///< threads that are at work here

 private:
  struct Job {
    CancelToken cancel;
    std::future<std::optional<Confinement>> found;
    bool works() const;
  };
  void drop_all_but(std::span<const Question> wanted);

  const Verifier& judge_;
  std::map<Question, Job> jobs_;
  std::list<Job> dropped_;  // which come to an end
};

}  // namespace dismantle::blocking
