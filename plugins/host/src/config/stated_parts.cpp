#include "config/stated_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "dismantle/fasteners/recognise.h"
#include "dismantle/host/suggest.h"
#include "dismantle/preparation/name_pattern.h"

namespace dismantle {
namespace {

const std::vector<std::string> kKeys{"kind", "size", "length", "torque", "glue"};

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const auto near = nearest(word, known);
  return near ? fmt::format("; did you mean '{}'?", *near) : fmt::format("; known: {}", fmt::join(known, ", "));
}

std::optional<double> positive(const ConfigNode& node) {
  if (!node.is_scalar()) return std::nullopt;
  double value = 0;
  const char* end = node.scalar.data() + node.scalar.size();
  const auto [rest, error] = std::from_chars(node.scalar.data(), end, value);
  return error == std::errc{} && rest == end && std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

void read_key(const ConfigMember& member, StatedPart& part, std::vector<Diagnostic>& problems) {
  const std::string where = fmt::format("parts.{}.{}", part.pattern, member.key);
  const auto problem = [&](const std::string& text) { problems.push_back(member.value.mark.error(where + text)); };
  if (member.key == "length" || member.key == "torque") {
    (member.key == "length" ? part.length : part.torque) = positive(member.value);
    if (!positive(member.value)) problem(" must be a number above 0");
    return;
  }
  if (!member.value.is_scalar() || member.value.scalar.empty()) return problem(" must be a text");
  const std::string& text = member.value.scalar;
  if (member.key == "size") part.size = text;
  if (member.key == "glue") part.glue = text;
  if (member.key != "kind") return;
  if (const auto kind = fasteners::kind_from_string(text))
    part.kind = std::string(to_string(*kind));
  else
    problem(fmt::format(": there is no kind '{}'", text) +
            suggestion(text, {fasteners::kKindNames.begin(), fasteners::kKindNames.end()}));
}

bool matches(const StatedPart& stated, const std::string& name) {
  return name_matches(name, stated.pattern);
}

PartKind stated_kind(const StatedPart& stated, const std::optional<PartKind>& before) {
  PartKind out = before.value_or(PartKind{"other"});
  if (!stated.kind.empty() && stated.kind != out.kind) out = {stated.kind};
  if (!stated.size.empty() || stated.length) {
    const auto kind = fasteners::kind_from_string(out.kind).value_or(fasteners::Kind::other);
    // What is not stated of a screw's size stays: "M3x10".
    const std::string::size_type by = out.size.find('x');
    std::string size = !stated.size.empty() ? stated.size : out.size.substr(0, by);
    double length = stated.length.value_or(0);
    if (!stated.length && by != std::string::npos && kind == fasteners::Kind::screw)
      std::from_chars(out.size.data() + by + 1, out.size.data() + out.size.size(), length);
    out.size = fasteners::size_text(kind, size, length);
  }
  out.stated = true;
  out.confidence = 1;
  out.reason = "stated by the user";
  if (stated.torque) out.reason += fmt::format("; torque {:g} N m", *stated.torque);
  if (!stated.glue.empty()) out.reason += fmt::format("; glue: {}", stated.glue);
  return out;
}

}  // namespace

std::vector<StatedPart> read_stated_parts(const ConfigNode& section, std::vector<Diagnostic>& problems) {
  std::vector<StatedPart> out;
  if (!section.is_map()) {
    problems.push_back(section.mark.error(
        fmt::format("parts must be a map from names of parts to what they are, not {}", section.kind_name())));
    return out;
  }
  for (const ConfigMember& member : section.members) {
    StatedPart part;
    part.pattern = member.key;
    part.place = member.key_mark.error("");
    if (!member.value.is_map() || member.value.members.empty()) {
      problems.push_back(member.value.mark.error(
          fmt::format("parts.{} must be a map with some of: {}", member.key, fmt::join(kKeys, ", "))));
      continue;
    }
    for (const ConfigMember& key : member.value.members) {
      if (std::find(kKeys.begin(), kKeys.end(), key.key) == kKeys.end())
        problems.push_back(key.key_mark.error(fmt::format("unknown key '{}' in parts.{}", key.key, member.key) +
                                              suggestion(key.key, kKeys)));
      else
        read_key(key, part, problems);
    }
    out.push_back(std::move(part));
  }
  return out;
}

void state_kinds(const std::vector<StatedPart>& stated, Assembly& assembly) {
  std::vector<Diagnostic> problems;
  for (const StatedPart& entry : stated) {
    bool used = false;
    for (Part& part : assembly.parts) {
      if (!matches(entry, part.name)) continue;
      part.kind = stated_kind(entry, part.kind);
      used = true;
    }
    for (const ExcludedPart& part : assembly.excluded) used = used || matches(entry, part.name);
    if (used) continue;
    problems.push_back(entry.place);
    std::vector<std::string> names;
    for (const Part& part : assembly.parts) names.push_back(part.name);
    problems.back().message = fmt::format("parts: {} has no part '{}'", assembly.source, entry.pattern);
    if (const auto near = nearest(entry.pattern, names))
      problems.back().message += fmt::format("; did you mean '{}'?", *near);
  }
  if (!problems.empty()) throw ConfigError(std::move(problems));
}

}  // namespace dismantle
