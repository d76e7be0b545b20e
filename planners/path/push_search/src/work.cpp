#include "dismantle/push_search/work.h"

namespace dismantle::push {

void Work::begin(const Limits& limits) {
  deadline_ = limits.deadline;
  left_ = limits.work_left;
  pauses_ = limits.pause_after > 0;
  pause_at_ = total() + limits.pause_after;
}

bool Work::used_up() const {
  return (left_ != nullptr && *left_ == 0) || context_->should_stop() || deadline_.passed();
}

}  // namespace dismantle::push
