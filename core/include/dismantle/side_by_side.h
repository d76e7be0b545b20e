/// Two pieces of work at the same time, again and again.
#pragma once

#include <functional>
#include <memory>

#include "dismantle/export.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// The second piece is done by an idle thread of the context's crew, once there is one, which is kept until the end:
/// the pieces take less time than it takes a thread to come. Where there is none, both are done by the caller.
class DISMANTLE_API SideBySide {
 public:
  explicit SideBySide(const RunContext& context);
  ~SideBySide();
  SideBySide(const SideBySide&) = delete;
  SideBySide& operator=(const SideBySide&) = delete;
  /// Throws what either throws, when both are done.
  void operator()(const std::function<void()>& first, const std::function<void()>& second);

 private:
  struct Helper;
  std::unique_ptr<Helper> helper_;
};

}  // namespace dismantle
