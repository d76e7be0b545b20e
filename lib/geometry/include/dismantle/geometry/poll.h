/// Interruption of long constructions.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

namespace dismantle::geometry {

/// What a long construction calls now and then. The function may be empty; what it throws ends the construction.
class Poll {
 public:
  Poll() = default;
  template <class Function>
    requires(std::invocable<Function&> && !std::same_as<std::remove_cvref_t<Function>, Poll>)
  Poll(Function&& function) : function_(std::forward<Function>(function)) {}

  void operator()() const {
    if (function_) function_();
  }
  /// Before work on that many triangles: not called if there are few.
  void before(std::size_t triangles) const {
    if (triangles >= kTriangles) (*this)();
  }
  /// In a loop over triangles, or what grows with them: called in some of its passes.
  void in_pass(std::size_t pass) const {
    if (pass % kTriangles == kTriangles - 1) (*this)();
  }

 private:
  static constexpr std::size_t kTriangles = std::size_t{1} << 15;  // which take some 10 ms
  std::function<void()> function_;
};

}  // namespace dismantle::geometry
