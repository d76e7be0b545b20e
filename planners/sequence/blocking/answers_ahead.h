/// Answers to questions about pairs, some of them found by other threads before they are asked for.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "dismantle/crew.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::blocking {

/// A pair, how the two stand to each other, and a direction; see Relations.
using RelationKey = std::tuple<PartId, PartId, std::size_t, long, long, long, std::size_t, std::size_t>;

/// "Does `moving` fail to pass `still`, which stands at `still_at`, on this way?" An answer is a fact about the two and
/// nothing else, so it does not matter who finds it, and when.
struct PassQuestion {
  RelationKey key;
  PartId moving = 0, still = 0;
  Pose still_at;
  std::vector<Pose> way;
};

/// The judge's answers. One caller; idle threads of a crew work beside it, on what the caller waits for, else on what
/// it is likely to ask next.
class AnswersAhead {
 public:
  /// Questions in the order in which they would be asked, of which those after the first "blocked" are not asked.
  using Line = std::deque<PassQuestion>;

  /// `judge` must outlive this; `crew` may be null.
  AnswersAhead(const Verifier& judge, std::shared_ptr<Crew> crew);
  /// Waits for the answers that are being found.
  ~AnswersAhead();
  AnswersAhead(const AnswersAhead&) = delete;
  AnswersAhead& operator=(const AnswersAhead&) = delete;

  bool works_ahead() const { return helpers_most_ > 0; }
  /// Lines that are not answered.
  std::size_t waiting() const;
  /// Replaces those.
  void hint(std::deque<Line> lines);
  /// True where the part is blocked, in the order of the questions.
  std::vector<char> answer(std::span<const PassQuestion> questions);

 private:
  enum class State : char { running, free, blocked };
  State ask(const PassQuestion& question) const;
  void call_helpers(Crew::Rank rank);
  void work();
  void settle(const PassQuestion& question, std::unique_lock<std::mutex>& lock);
  const PassQuestion* next_wanted();
  std::optional<PassQuestion> next_hinted();

  const Verifier& judge_;
  mutable std::mutex mutex_;
  std::condition_variable answered_;
  std::map<RelationKey, State> states_;
  std::deque<const PassQuestion*> wanted_;  ///< the caller waits for these; they live as long as it does
  std::deque<Line> lines_;
  bool stop_ = false;
  const std::shared_ptr<Crew> crew_;
  const std::size_t helpers_most_;
  std::size_t helpers_ = 0;          ///< called, and not through with what there is
  std::vector<Crew::Offer> offers_;  ///< to them, and to some before
};

}  // namespace dismantle::blocking
