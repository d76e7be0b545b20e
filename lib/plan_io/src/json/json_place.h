/// A JSON value with its location, which errors name.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/errors.h"
#include "dismantle/param_value.h"

namespace dismantle::json_read {

using Json = nlohmann::ordered_json;

/// A value, and where in which file it stands (a JSON pointer).
class Place {
 public:
  Place(const Json& value, const std::string& source, std::string path)
      : value_(value), source_(source), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(source_, fmt::format("{}: {}", path_.empty() ? "/" : path_, problem));
  }

  const Json& object(std::initializer_list<const char*> required,
                     std::initializer_list<const char*> optional = {}) const {
    if (!value_.is_object()) fail("expected an object");
    for (const char* key : required)
      if (!value_.contains(key)) fail(fmt::format("'{}' is missing", key));
    const auto known = [&](const std::string& key) {
      const auto same = [&](const char* k) { return key == k; };
      return std::ranges::any_of(required, same) || std::ranges::any_of(optional, same);
    };
    for (const auto& item : value_.items())
      if (!known(item.key())) fail(fmt::format("unknown key '{}'", item.key()));
    return value_;
  }
  bool has(const char* key) const { return value_.contains(key); }
  bool is_null() const { return value_.is_null(); }
  Place at(const std::string& key) const { return {value_.at(key), source_, path_ + "/" + key}; }

  std::vector<Place> items() const {
    if (!value_.is_array()) fail("expected an array");
    std::vector<Place> out;
    out.reserve(value_.size());
    for (std::size_t i = 0; i < value_.size(); ++i)
      out.emplace_back(value_[i], source_, fmt::format("{}/{}", path_, i));
    return out;
  }

  std::vector<std::pair<std::string, Place>> members() const {
    if (!value_.is_object()) fail("expected an object");
    std::vector<std::pair<std::string, Place>> out;
    for (const auto& item : value_.items()) out.emplace_back(item.key(), at(item.key()));
    return out;
  }

  ParamValue parameter() const {
    if (value_.is_boolean()) return value_.get<bool>();
    if (value_.is_number_integer()) return value_.get<std::int64_t>();
    if (value_.is_number()) return value_.get<double>();
    if (!value_.is_string()) fail("expected a number, a string, true or false");
    return value_.get<std::string>();
  }

  std::string text() const {
    if (!value_.is_string()) fail("expected a string");
    return value_.get<std::string>();
  }
  std::string name() const {
    std::string s = text();
    if (s.empty()) fail("expected a name, found an empty string");
    return s;
  }
  double number() const {
    if (!value_.is_number()) fail("expected a number");
    const double x = value_.get<double>();
    if (!std::isfinite(x)) fail("expected a finite number");
    return x;
  }
  double number_from_zero() const {
    const double x = number();
    if (x < 0) fail("expected a number >= 0");
    return x;
  }
  double number_within(double least, double most) const {
    const double x = number();
    if (x < least || x > most) fail(fmt::format("expected a number between {:g} and {:g}", least, most));
    return x;
  }
  bool truth() const {
    if (!value_.is_boolean()) fail("expected true or false");
    return value_.get<bool>();
  }
  double positive() const {
    const double x = number();
    if (x <= 0) fail("expected a number > 0");
    return x;
  }
  std::uint64_t count(std::uint64_t limit = std::numeric_limits<std::uint64_t>::max()) const {
    if (!value_.is_number_unsigned()) fail("expected a whole number >= 0");
    const auto n = value_.get<std::uint64_t>();
    if (n > limit) fail(fmt::format("expected a whole number <= {}", limit));
    return n;
  }
  unsigned small_count() const { return static_cast<unsigned>(count(std::numeric_limits<unsigned>::max())); }

  template <std::size_t N>
  std::array<double, N> numbers() const {
    std::array<double, N> out{};
    bool right = value_.is_array() && value_.size() == N;
    for (std::size_t i = 0; right && i < N; ++i) right = value_[i].is_number();
    if (!right) fail(fmt::format("expected {} numbers", N));
    for (std::size_t i = 0; i < N; ++i) {
      out[i] = value_[i].template get<double>();
      if (!std::isfinite(out[i])) fail("expected finite numbers");
    }
    return out;
  }

 private:
  const Json& value_;
  const std::string& source_;
  std::string path_;
};

}  // namespace dismantle::json_read
