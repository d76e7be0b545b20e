/// Data derived from the parts of an assembly, computed once and shared by all users.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <typeinfo>
#include <utility>

#include "dismantle/assembly.h"
#include "dismantle/computed_once.h"

namespace dismantle {

/// Values by name and part, for one assembly. If a value depends on more than the part, on a tolerance for instance,
/// its name must say so. Safe to use from several threads; values never move or change.
class PartMemo {
 public:
  /// The value; the first caller computes it by compute() -> std::optional<T>, with no lock held. nullptr: this
  /// caller's compute() returned nothing, for instance because it was stopped; the next caller tries again.
  /// @throws std::logic_error when the name stands for a value of another type.
  template <class T, class Compute>
  const T* get(const std::string& name, PartId part, const RunContext& context, Compute&& compute) {
    const Value* value = entry(name, part).get(context, [&]() -> std::optional<Value> {
      std::optional<T> made = compute();
      if (!made) return std::nullopt;
      return Value{std::make_shared<const T>(std::move(*made)), typeid(T).name()};
    });
    if (value == nullptr) return nullptr;
    if (value->type != typeid(T).name()) throw std::logic_error("PartMemo: '" + name + "' has another type");
    return static_cast<const T*>(value->data.get());
  }

  /// Stores a known value. Must be called before any get() for it.
  template <class T>
  void put(const std::string& name, PartId part, std::shared_ptr<const T> value) {
    entry(name, part).get(RunContext{}, [&] {
      return std::optional<Value>(Value{std::move(value), typeid(T).name()});
    });
  }

 private:
  struct Value {
    std::shared_ptr<const void> data;
    std::string type;
  };

  ComputedOnce<Value>& entry(const std::string& name, PartId part) {
    const std::scoped_lock lock(mutex_);
    return values_[{name, part}];
  }

  std::mutex mutex_;
  std::map<std::pair<std::string, PartId>, ComputedOnce<Value>> values_;
};

}  // namespace dismantle
