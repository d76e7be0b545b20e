/// The threads of a run: how many may be at work at the same time, and work for those that would be idle.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "dismantle/export.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// A thread that works has a place, of which there are as many as threads; the one that makes the crew has the first.
/// Threads of the crew wait for places and do what was offered. Who does it, or whether anybody does before it is
/// withdrawn, depends on the clock, so nothing that is said may.
class DISMANTLE_API Crew {
  struct Work;
  struct Impl;

 public:
  /// Work that somebody else does or nobody. The destructor withdraws it or waits for its end.
  class DISMANTLE_API Offer {
   public:
    Offer() = default;
    Offer(Offer&&) noexcept = default;
    Offer& operator=(Offer&& other) noexcept;
    ~Offer();
    /// True: nobody has begun, and nobody will.
    bool withdraw();
    /// Begun and not ended.
    bool running() const;
    bool done() const;
    /// For its end, so long at most; the caller's place is free meanwhile, and the caller gets that of the thread that
    /// did it. True: it is done.
    bool wait_for(std::chrono::milliseconds most);
    /// Until it is done. Throws what the work threw.
    void wait();
    /// Likewise; when `context` says to stop, the work is told so by its own `cancel`.
    void wait(const RunContext& context, const CancelToken& cancel);

   private:
    friend class Crew;
    Offer(std::shared_ptr<Impl> crew, std::shared_ptr<Work> work) : crew_(std::move(crew)), work_(std::move(work)) {}
    void await(std::chrono::milliseconds often, const std::function<bool()>& goes_on);
    std::shared_ptr<Impl> crew_;
    std::shared_ptr<Work> work_;
  };
  /// `part`: of something that a thread is at, and waits for in the end. `ahead`: what may be needed some time.
  enum class Rank : char { part, ahead };

  explicit Crew(unsigned threads);  ///< >= 1
  /// What nobody has begun is not done; waits for the rest.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  unsigned threads() const;
  /// Parts first, then in the order of offering.
  [[nodiscard]] Offer offer(std::function<void()> work, Rank rank);

  // For threads of others.
  bool try_enter();  ///< takes a place, if there is one
  void enter();      ///< takes a place, even if there is none
  void leave();
  /// Called, by whatever thread, when there is a place and no offer; one at a time. Empty: nobody is.
  void when_idle(std::function<void()> call);

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace dismantle
