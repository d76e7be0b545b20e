/// `dismantle plan --isolate`: the run goes on in a child process, so that a plugin that crashes, hangs or eats memory
/// costs no step that was finished.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "dismantle/run_notes.h"

namespace dismantle::app {

/// How the child ended.
struct IsolatedEnd {
  bool exited = false;  ///< by itself, with `status`; its messages have been printed
  int status = 0;
  std::string why;           ///< else: what happened, for the user
  bool interrupted = false;  ///< the user pressed Ctrl-C twice, or once and the child did not stop
};

/// Makes the child when it is constructed; both processes return from there. No other thread may run.
class Isolation {
 public:
  /// `memory`: MiB of address space that the child may use; 0: as much as the machine has memory.
  /// @throws Error when there can be no child.
  explicit Isolation(std::int64_t memory);
  ~Isolation();  ///< of the parent: kills the child if it is still there
  Isolation(const Isolation&) = delete;
  Isolation& operator=(const Isolation&) = delete;

  bool in_child() const { return child_ == 0; }
  /// Shared by both.
  RunNotes& notes() { return *notes_; }
  /// For the parent: waits, passes Ctrl-C and SIGTERM on, kills a child that does not stop.
  IsolatedEnd wait();

 private:
  RunNotes* notes_ = nullptr;
  pid_t child_ = -1;
  std::int64_t memory_ = 0;  // MiB
};

}  // namespace dismantle::app
