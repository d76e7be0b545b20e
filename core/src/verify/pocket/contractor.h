/// Contracts the two halves of a cell, on two threads where there are two.
#pragma once

#include <memory>

#include "verify/pocket/pose_cell.h"

namespace dismantle::verify {

/// Keeps its thread between calls: a contraction takes less time than a thread to start. Exceptions of either are
/// thrown by the call.
class Contractor {
 public:
  Contractor(const Pinned& pinned, unsigned threads);
  ~Contractor();
  void operator()(PoseCell& x, PoseCell& y, const PinList& in_use);

 private:
  struct Helper;
  const Pinned& pinned_;
  std::unique_ptr<Helper> helper_;
};

}  // namespace dismantle::verify
