/// `dismantle plan --isolate`: the run continues in a child process, so that no finished step is lost when a plugin
/// crashes, hangs or uses too much memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "dismantle/process/child.h"
#include "run_notes.h"

namespace dismantle::app {

/// How the child ended.
struct IsolatedEnd {
  bool exited = false;  ///< the child ended by itself with `status` and has printed its messages
  int status = 0;
  std::string why;           ///< if not `exited`: the reason, for the user
  bool interrupted = false;  ///< the user pressed Ctrl-C twice, or before the child could handle it
};

/// The constructor forks the child and returns in both processes. No other thread may run then.
class Isolation {
 public:
  /// `memory`: MiB of address space that the child may use; 0: the machine's physical memory.
  /// @throws Error when the child cannot be created.
  explicit Isolation(std::int64_t memory);

  bool in_child() const { return child_->is_copy(); }
  /// Shared by both processes.
  RunNotes& notes() { return *notes_; }
  /// In the parent: waits for the child, forwards Ctrl-C and SIGTERM, and kills a child that does not stop.
  IsolatedEnd wait();

 private:
  RunNotes* notes_ = nullptr;
  std::optional<process::Child> child_;  // killed with this if it still runs
  std::int64_t memory_ = 0;              // MiB
};

}  // namespace dismantle::app
