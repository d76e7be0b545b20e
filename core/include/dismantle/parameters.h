/// One declaration per parameter: type, unit, default, range or choices, doc. It feeds validation,
/// `dismantle plugins describe`, the generated reference and the JSON Schema for editors.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "dismantle/export.h"

namespace dismantle {

using ParamValue = std::variant<bool, std::int64_t, double, std::string>;
using ParamSet = std::map<std::string, ParamValue>;

enum class ParamType { boolean, integer, number, text, choice };

struct ParamChoice {
  std::string name;
  std::string doc;
};

struct ParamSpec {
  std::string name;  ///< [a-z][a-z0-9_]*
  ParamType type = ParamType::number;
  std::string unit;  ///< required for numbers and integers; "1" = dimensionless
  ParamValue fallback;
  std::optional<double> min, max;
  bool min_open = false, max_open = false;  ///< true: the bound itself is not allowed
  std::vector<ParamChoice> choices;
  std::string doc;

  /// What is wrong with `value`, or nothing. Checks type, range and choice.
  DISMANTLE_API std::optional<std::string> problem_with(const ParamValue& value) const;
  DISMANTLE_API std::string range_text() const;  ///< "[0, 1)", ">= 0", "" when unbounded
};

DISMANTLE_API std::string to_text(const ParamValue& value);  ///< round-trips; locale-independent
/// Everything wrong with the declarations themselves (no doc, no unit, default out of range, bad name, twice).
DISMANTLE_API std::vector<std::string> problems_of_schema(const std::vector<ParamSpec>& specs);
/// `given` completed with the defaults. Unknown names and bad values throw std::invalid_argument
/// (the YAML binder has found them before, with their places).
DISMANTLE_API ParamSet complete(const std::vector<ParamSpec>& specs, const ParamSet& given);

/// How a number is declared: {.unit = "s", .min = 0, .doc = "..."}.
struct ParamTraits {
  std::string unit{};
  std::optional<double> min{}, max{};
  bool min_open = false, max_open = false;
  std::string doc;
};

template <class E>
struct EnumChoice {
  std::string name;
  E value;
  std::string doc;
};

/// Collects the declarations of a parameter struct. Defaults are read from a default-constructed T,
/// the only place where they are written:
///   struct P { double range = 0.05; static void describe(Schema<P>& s) { s.add("range", &P::range, {...}); } };
template <class T>
class Schema {
 public:
  Schema() { T::describe(*this); }

  template <class M>
  void add(std::string name, M T::* member, ParamTraits traits) {
    const T defaults{};
    ParamSpec spec;
    spec.name = name;
    spec.unit = std::move(traits.unit);
    spec.min = traits.min;
    spec.max = traits.max;
    spec.min_open = traits.min_open;
    spec.max_open = traits.max_open;
    spec.doc = std::move(traits.doc);
    if constexpr (std::is_same_v<M, bool>) {
      spec.type = ParamType::boolean;
      spec.fallback = defaults.*member;
      setters_.emplace_back([name, member](T& t, const ParamSet& p) { t.*member = std::get<bool>(p.at(name)); });
    } else if constexpr (std::is_integral_v<M>) {
      spec.type = ParamType::integer;
      spec.fallback = static_cast<std::int64_t>(defaults.*member);
      // What the member cannot hold is out of range, declared or not.
      if (std::is_unsigned_v<M> && !spec.min) spec.min = 0;
      if (sizeof(M) < sizeof(std::int64_t) && !spec.max) spec.max = static_cast<double>(std::numeric_limits<M>::max());
      if (sizeof(M) < sizeof(std::int64_t) && !spec.min) spec.min = static_cast<double>(std::numeric_limits<M>::min());
      setters_.emplace_back([name, member](T& t, const ParamSet& p) { t.*member = static_cast<M>(std::get<std::int64_t>(p.at(name))); });
    } else if constexpr (std::is_floating_point_v<M>) {
      spec.type = ParamType::number;
      spec.fallback = static_cast<double>(defaults.*member);
      setters_.emplace_back([name, member](T& t, const ParamSet& p) { t.*member = static_cast<M>(std::get<double>(p.at(name))); });
    } else {
      static_assert(std::is_same_v<M, std::string>, "parameters are bool, integer, floating point, string or an enum with choices");
      spec.type = ParamType::text;
      spec.fallback = defaults.*member;
      setters_.emplace_back([name, member](T& t, const ParamSet& p) { t.*member = std::get<std::string>(p.at(name)); });
    }
    specs_.push_back(std::move(spec));
  }

  template <class E>
  void add_choice(std::string name, E T::* member, std::vector<EnumChoice<E>> choices, std::string doc) {
    const T defaults{};
    ParamSpec spec;
    spec.name = name;
    spec.type = ParamType::choice;
    spec.doc = std::move(doc);
    for (const auto& c : choices) {
      spec.choices.push_back({c.name, c.doc});
      if (c.value == defaults.*member) spec.fallback = c.name;
    }
    setters_.emplace_back([name, member, choices](T& t, const ParamSet& p) {
      for (const auto& c : choices)
        if (c.name == std::get<std::string>(p.at(name))) t.*member = c.value;
    });
    specs_.push_back(std::move(spec));
  }

  const std::vector<ParamSpec>& specs() const { return specs_; }
  /// `values` must be complete (see dismantle::complete).
  T bind(const ParamSet& values) const {
    T t{};
    for (const auto& set : setters_) set(t, values);
    return t;
  }

 private:
  std::vector<ParamSpec> specs_;
  std::vector<std::function<void(T&, const ParamSet&)>> setters_;
};

}  // namespace dismantle
