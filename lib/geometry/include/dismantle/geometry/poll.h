/// Interruption of long constructions.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

namespace dismantle::geometry {

/// Callback that a long construction calls periodically. It may be empty; an exception from it ends the construction.
class Poll {
 public:
  Poll() = default;
  template <class Function>
    requires(std::invocable<Function&> && !std::same_as<std::remove_cvref_t<Function>, Poll>)
  Poll(Function&& function) : function_(std::forward<Function>(function)) {}

  void operator()() const {
    if (function_) function_();
  }
  /// Call before work on `triangles` triangles; skips the callback if there are few.
  void before(std::size_t triangles) const {
    if (triangles >= kTriangles) (*this)();
  }
  /// Call in each pass of a loop whose length grows with the triangles; runs the callback in some passes.
  void in_pass(std::size_t pass) const {
    if (pass % kTriangles == kTriangles - 1) (*this)();
  }

 private:
  static constexpr std::size_t kTriangles = std::size_t{1} << 15;  // about 10 ms of work
  std::function<void()> function_;
};

}  // namespace dismantle::geometry
