/// A JSON value with its location, which errors name, and the rules by which values are read.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "dismantle/aabb.h"
#include "dismantle/errors.h"
#include "dismantle/param_value.h"
#include "dismantle/pose.h"

namespace dismantle::plan_json {

using Json = nlohmann::ordered_json;

/// The file that is read, and the parts that it has named.
struct Source {
  const std::string& name;
  std::set<std::string> parts{};
};

/// A value, and where in which file it stands (a JSON pointer).
class Place {
 public:
  Place(const Json& value, Source& source, std::string path = "")
      : value_(value), source_(source), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(source_.name, fmt::format("{}: {}", path_.empty() ? "/" : path_, problem));
  }
  void expect(bool right, std::string_view what) const {
    if (!right) fail(fmt::format("expected {}", what));
  }
  const Json& json() const { return value_; }
  std::set<std::string>& parts() const { return source_.parts; }
  bool has(const std::string& key) const { return value_.contains(key); }
  Place at(const std::string& key) const { return {value_.at(key), source_, path_ + "/" + key}; }
  Place at(std::size_t i) const { return {value_.at(i), source_, fmt::format("{}/{}", path_, i)}; }

  template <class T>
  T as(bool right, std::string_view what) const {
    expect(right, what);
    return value_.get<T>();
  }
  std::vector<Place> items() const {
    expect(value_.is_array(), "an array");
    std::vector<Place> out;
    out.reserve(value_.size());
    for (std::size_t i = 0; i < value_.size(); ++i) out.push_back(at(i));
    return out;
  }
  std::vector<std::pair<std::string, Place>> members() const {
    expect(value_.is_object(), "an object");
    std::vector<std::pair<std::string, Place>> out;
    for (const auto& item : value_.items()) out.emplace_back(item.key(), at(item.key()));
    return out;
  }

 private:
  const Json& value_;
  Source& source_;
  std::string path_;
};

// The rules: each reads a value, or says what is wrong with it.

/// `rule`, and `test` of what it reads.
template <class Rule, class Test>
constexpr auto checked(Rule rule, Test test, std::string_view expected) {
  return [=](const Place& place) {
    auto value = rule(place);
    place.expect(test(value), expected);
    return value;
  };
}

/// An array, each item by `rule`.
template <class Rule>
constexpr auto list(Rule rule) {
  return [=](const Place& place) {
    std::vector<std::invoke_result_t<Rule, const Place&>> out;
    for (const Place& item : place.items()) out.push_back(rule(item));
    return out;
  };
}

inline bool truth(const Place& place) { return place.as<bool>(place.json().is_boolean(), "true or false"); }
inline std::string text(const Place& place) { return place.as<std::string>(place.json().is_string(), "a string"); }
inline double any_number(const Place& place) { return place.as<double>(place.json().is_number(), "a number"); }

/// What `from_text` makes of a string; it returns an optional.
template <class FromText>
constexpr auto choice(FromText from_text, std::string_view expected) {
  return [=](const Place& place) {
    const auto given = text(place);
    const auto value = from_text(given);
    place.expect(value.has_value(), fmt::format("{}, not \"{}\"", expected, given));
    return *value;
  };
}

/// An enumerator, the last of which is `last`.
template <class Enum>
constexpr auto enumerator(Enum last, std::string_view expected) {
  const auto from_text = [=](std::string_view given) {
    std::optional<Enum> found;
    for (int i = 0; i <= static_cast<int>(last); ++i)
      if (to_string(static_cast<Enum>(i)) == given) found = static_cast<Enum>(i);
    return found;
  };
  return choice(from_text, expected);
}

inline constexpr auto name = checked(
    text, [](const auto& s) { return !s.empty(); }, "a name, found an empty string");
inline constexpr auto number = checked(
    any_number, [](double x) { return std::isfinite(x); }, "a finite number");
inline constexpr auto from_zero = checked(
    number, [](double x) { return x >= 0; }, "a number >= 0");
inline constexpr auto positive = checked(
    number, [](double x) { return x > 0; }, "a number > 0");

inline auto from_zero_to(double most) {
  return [=](const Place& place) {
    const double x = number(place);
    place.expect(x >= 0 && x <= most, fmt::format("a number between 0 and {:g}", most));
    return x;
  };
}

template <class T>
T count(const Place& place) {
  const auto n = place.as<std::uint64_t>(place.json().is_number_unsigned(), "a whole number >= 0");
  place.expect(n <= std::numeric_limits<T>::max(), fmt::format("a whole number <= {}", std::numeric_limits<T>::max()));
  return static_cast<T>(n);
}

inline ParamValue parameter(const Place& place) {
  if (place.json().is_boolean()) return truth(place);
  if (place.json().is_number_integer()) return place.json().get<std::int64_t>();
  if (place.json().is_number()) return place.json().get<double>();
  return place.as<std::string>(place.json().is_string(), "a number, a string, true or false");
}

template <std::size_t N>
std::array<double, N> numbers(const Place& place) {
  std::array<double, N> out{};
  const Json& json = place.json();
  bool right = json.is_array() && json.size() == N;
  for (std::size_t i = 0; right && i < N; ++i) right = json[i].is_number();
  place.expect(right, fmt::format("{} numbers", N));
  for (std::size_t i = 0; i < N; ++i) {
    out[i] = json[i].template get<double>();
    place.expect(std::isfinite(out[i]), "finite numbers");
  }
  return out;
}

inline Eigen::Vector3d vector(const Place& place) { return Eigen::Vector3d(numbers<3>(place).data()); }
inline constexpr auto unit_vector = checked(
    vector, [](const auto& v) { return std::abs(v.norm() - 1) <= 1e-3; }, "a vector of length 1");

inline Pose pose(const Place& place) {
  const auto n = numbers<7>(place);
  Pose p{{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}};
  const double norm = p.q.norm();
  // Plans by other programs may be rounded to a few digits; ours are left as they are, bit for bit.
  if (!(std::abs(norm - 1) <= 1e-3)) place.fail(fmt::format("the quaternion has length {:.6g}, expected 1", norm));
  if (std::abs(norm - 1) > 1e-12) p.q.normalize();
  return p;
}

inline Aabb box(const Place& place) {
  const auto corners = list(vector)(place);
  place.expect(corners.size() == 2, "two corners");
  const Aabb box{corners[0], corners[1]};
  if (box.empty()) place.fail("the first corner is above the second");
  return box;
}

inline Aabb box_or_null(const Place& place) { return place.json().is_null() ? Aabb{} : box(place); }

inline std::string part(const Place& place) {
  const std::string s = name(place);
  if (!place.parts().contains(s)) place.fail(fmt::format("there is no part '{}' in /assembly/parts", s));
  return s;
}

/// Part names, none twice.
inline std::vector<std::string> group(const Place& place) {
  const auto out = list(part)(place);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!seen.insert(out[i]).second) place.at(i).fail(fmt::format("part '{}' stands here twice", out[i]));
  return out;
}

inline constexpr auto some_parts = checked(
    group, [](const auto& parts) { return !parts.empty(); }, "at least one part");

inline std::pair<std::string, std::string> pair(const Place& place) {
  const auto both = list(part)(place);
  place.expect(both.size() == 2, "two parts");
  return {both[0], both[1]};
}

}  // namespace dismantle::plan_json
