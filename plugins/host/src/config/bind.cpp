#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/binder.h"
#include "dismantle/host/config.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"

namespace dismantle {
namespace {

std::string label(const SectionContext& context) {
  return context.type.empty() ? context.name : fmt::format("{} ({})", context.name, context.type);
}

std::string wanted(const ParamSpec& spec) {
  switch (spec.type) {
    case ParamType::boolean:
      return "true or false";
    case ParamType::integer:
      return "an integer";
    case ParamType::number:
      return "a number";
    default:
      return "text";
  }
}

/// Parses a number, an integer or a boolean; `problem` receives the error.
std::optional<ParamValue> parse_plain(ParamType type, const std::string& text, std::string& problem) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (type == ParamType::boolean) {
    if (text == "true") return ParamValue{true};
    if (text == "false") return ParamValue{false};
    return std::nullopt;
  }
  if (type == ParamType::integer) {
    std::int64_t integer = 0;
    const auto read = std::from_chars(begin, end, integer);
    if (read.ptr != end) return std::nullopt;
    if (read.ec == std::errc::result_out_of_range) problem = "is too large for an integer of 64 bits";
    if (read.ec != std::errc{}) return std::nullopt;
    return ParamValue{integer};
  }
  double number = 0;
  const auto read = std::from_chars(begin, end, number);
  if (read.ptr != end) return std::nullopt;
  if (read.ec == std::errc::result_out_of_range) problem = "is too large or too small for a number of 64 bits";
  if (read.ec != std::errc{}) return std::nullopt;
  return ParamValue{number};
}

}  // namespace

std::optional<ParamValue> bind_value(const ParamSpec& spec, const ConfigNode& node, const SectionContext& context,
                                     std::vector<Diagnostic>& problems) {
  const auto fail = [&](const std::string& what) {
    std::string text = fmt::format("{} {}", key_of(context.name, spec), what);
    if (!context.source.empty()) text += fmt::format(" [{}]", context.source);
    problems.push_back(node.mark.error(std::move(text)));
    return std::nullopt;
  };
  if (!node.is_scalar()) return fail(fmt::format("must be {}, got {}", wanted(spec), node.kind_name()));
  ParamValue value = node.scalar;
  if (spec.type != ParamType::text && spec.type != ParamType::choice) {
    if (node.quoted) return fail(fmt::format("must be {}, got the text \"{}\"", wanted(spec), node.scalar));
    std::string problem;
    const auto parsed = parse_plain(spec.type, node.scalar, problem);
    if (!parsed && !problem.empty()) return fail(fmt::format("= {} {}", node.scalar, problem));
    if (!parsed) return fail(fmt::format("must be {}, got '{}'", wanted(spec), node.scalar));
    value = *parsed;
  }
  if (const auto problem = spec.problem_with(value)) {
    std::string text = *problem;
    if (spec.type == ParamType::choice) {
      std::vector<std::string> names;
      for (const auto& choice : spec.choices) names.push_back(choice.name);
      if (const auto near = nearest(node.scalar, names)) text += fmt::format("; did you mean '{}'?", *near);
    }
    return fail(text);
  }
  return value;
}

std::string unknown_key_message(const std::string& key, const SectionContext& context,
                                const std::vector<std::string>& known, const KeyHomes& homes,
                                const std::vector<std::string>& advanced) {
  std::string text = context.name.empty() ? fmt::format("unknown key '{}'", key)
                                          : fmt::format("unknown key '{}' in {}", key, label(context));
  const auto home = homes.find(key);
  if (home != homes.end()) {
    std::string places;
    for (const auto& place : home->second) places += (places.empty() ? "" : " or ") + place;
    return text + fmt::format("; it belongs to {}", places);
  }
  if (const auto advice = advice_for_removed(key); !advice.empty()) return text + "; " + advice;
  if (const auto near = nearest(key, known)) return text + fmt::format("; did you mean '{}'?", *near);
  if (const auto near = nearest(key, advanced)) return text + fmt::format("; did you mean 'advanced.{}'?", *near);
  std::vector<std::string> elsewhere;
  for (const auto& entry : homes) elsewhere.push_back(entry.first);
  if (const auto near = nearest(key, elsewhere))
    return text + fmt::format("; did you mean '{}' of {}?", *near, homes.at(*near).front());
  return text;
}

ParamSet bind_section(const std::vector<ParamSpec>& specs, const ConfigNode* node, const SectionContext& context,
                      const KeyHomes& homes, std::map<std::string, std::string>& origins,
                      std::vector<Diagnostic>& problems) {
  const TypeSource none{
      [](PluginKind, const std::string&) { return nullptr; },
      [](PluginKind, const std::string& id) { return fmt::format("'{}': plugins cannot be chosen here", id); }};
  std::vector<std::string> warnings;  // these sections never had another form
  return Binder(none, homes, origins, problems, warnings).section(specs, node, context);
}

void take_schema(ConfigNode& root, std::vector<Diagnostic>& problems) {
  const auto* schema = root.find("schema");
  if (schema == nullptr) {
    problems.push_back(root.mark.error(fmt::format("missing key 'schema'; write 'schema: {}'", kConfigSchema)));
    return;
  }
  const ConfigNode& value = schema->value;
  std::int64_t version = 0;
  const char* end = value.scalar.data() + value.scalar.size();
  const auto read = std::from_chars(value.scalar.data(), end, version);
  if (!value.is_scalar() || value.quoted || read.ec != std::errc{} || read.ptr != end)
    problems.push_back(value.mark.error(fmt::format("schema must be the number {}", kConfigSchema)));
  else if (version != kConfigSchema)
    problems.push_back(
        value.mark.error(fmt::format("schema {} is not supported; this version of Dismantle reads {}{}", version,
                                     kConfigSchema, version > kConfigSchema ? ": update Dismantle" : "")));
  root.erase("schema");
}

void sort_by_place(std::vector<Diagnostic>& problems) {
  std::vector<std::string> files;
  for (const auto& problem : problems)
    if (std::find(files.begin(), files.end(), problem.file) == files.end()) files.push_back(problem.file);
  const auto rank = [&files](const Diagnostic& d) {
    return std::find(files.begin(), files.end(), d.file) - files.begin();
  };
  std::stable_sort(problems.begin(), problems.end(), [&rank](const Diagnostic& a, const Diagnostic& b) {
    return std::make_tuple(rank(a), a.line, a.column) < std::make_tuple(rank(b), b.line, b.column);
  });
}

}  // namespace dismantle
