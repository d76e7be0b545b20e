/// Work that will most likely turn out needless makes way for what decides that.
#pragma once

#include <condition_variable>
#include <mutex>

#include "dismantle/crew.h"
#include "dismantle/path_planner.h"

namespace dismantle::guided {

/// While the judge looks at a way of one search, the search beside it, of which nothing is used if that way holds,
/// waits: its place is for those who help the judge.
class GiveWay {
 public:
  /// `crew` must outlive this.
  explicit GiveWay(Crew& crew) : crew_(crew) {}

  /// Of the one search, from any of its threads.
  PathCheck judged(const PathChecker& checker, const Path& path) {
    const Turn turn(*this);
    return checker.check(path);
  }

  /// Of the other, by a thread that has a place: as long as a way is judged.
  void wait() {
    std::unique_lock lock(mutex_);
    if (judged_ == 0) return;
    lock.unlock();
    crew_.leave();
    lock.lock();
    ended_.wait(lock, [this] { return judged_ == 0; });
    lock.unlock();
    crew_.enter();
  }

 private:
  struct Turn {
    explicit Turn(GiveWay& of) : whose(of) { whose.change(1); }
    ~Turn() { whose.change(-1); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    GiveWay& whose;
  };

  void change(int by) {
    const std::scoped_lock lock(mutex_);
    judged_ += by;
    ended_.notify_all();
  }

  Crew& crew_;
  std::mutex mutex_;
  std::condition_variable ended_;
  int judged_ = 0;  // now
};

}  // namespace dismantle::guided
