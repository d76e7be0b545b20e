/// How Dismantle writes JSON: the same bytes for the same value, one line per leaf.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dismantle {

/// Shortest decimal that reads back as exactly `x`; never "-0". Locale-independent.
/// @throws Error when x is not finite, since JSON has no such number.
std::string number_text(double x);

/// `value` with two spaces of indentation. An array or object that holds no other container is written on
/// one line, so that a pose is a line and a diff of two plans shows poses. Ends without a line break.
/// A binary value is JSON text, which is written as it is. Bytes that are not UTF-8 are replaced by U+FFFD.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace dismantle
