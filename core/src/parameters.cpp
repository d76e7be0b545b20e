#include "dismantle/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "text.h"

namespace dismantle {
namespace {

/// By ParamType.
constexpr std::array kNouns{"true or false",      "an integer",           "a number",                    "text",
                            "one of its choices", "a choice of a plugin", "a list of choices of plugins"};
const char* noun(ParamType type) { return kNouns.at(static_cast<std::size_t>(type)); }

/// What the user gave, for a message: text in quotes, numbers with their unit.
std::string shown(const ParamValue& value, const std::string& unit) {
  if (const auto* s = std::get_if<std::string>(&value)) return text::join("'", *s, "'");
  std::string text = to_text(value);
  if (!std::holds_alternative<bool>(value) && !unit.empty() && unit != "1") text += " " + unit;
  return text;
}

std::string listed(const std::vector<ParamChoice>& choices) {
  std::string text;
  for (const auto& c : choices) text += (text.empty() ? "" : ", ") + c.name;
  return text;
}

bool in_range(const ParamSpec& spec, double x) {
  if (spec.min && (spec.min_open ? !(x > *spec.min) : !(x >= *spec.min))) return false;
  if (spec.max && (spec.max_open ? !(x < *spec.max) : !(x <= *spec.max))) return false;
  return true;
}

/// "must be in [0, 1)" or "must be >= 0".
std::string demand(const ParamSpec& spec) {
  return (spec.min && spec.max ? "must be in " : "must be ") + spec.range_text();
}

bool good_name(const std::string& name) {
  if (name.empty() || name[0] < 'a' || name[0] > 'z') return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

void check_choices(const ParamSpec& spec, std::vector<std::string>& problems) {
  if (spec.choices.empty()) problems.push_back(text::join("parameter '", spec.name, "' has no choices"));
  std::set<std::string> names;
  for (const auto& c : spec.choices) {
    if (c.name.empty()) problems.push_back(text::join("parameter '", spec.name, "' has a choice without a name"));
    if (!names.insert(c.name).second)
      problems.push_back(text::join("parameter '", spec.name, "' lists the choice '", c.name, "' twice"));
    if (c.doc.empty() && !spec.advanced)
      problems.push_back(text::join("choice '", c.name, "' of parameter '", spec.name, "' has no doc"));
  }
}

void check_numeric(const ParamSpec& spec, std::vector<std::string>& problems) {
  if (spec.unit.empty() && !spec.advanced)
    problems.push_back(text::join("parameter '", spec.name, "' has no unit (\"1\" for a pure number)"));
  const bool empty =
      spec.min && spec.max && (*spec.min > *spec.max || (*spec.min == *spec.max && (spec.min_open || spec.max_open)));
  if (empty) problems.push_back(text::join("parameter '", spec.name, "' has an empty range ", spec.range_text()));
}

/// A member of a flow map: text in quotes, as it may hold anything.
std::string in_map(const ParamValue& value) {
  const auto* s = std::get_if<std::string>(&value);
  if (s == nullptr) return to_text(value);
  std::string quoted = "\"";
  for (const char c : *s) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// The values of `given`, completed with defaults; `what` is "parameter" or "option".
ParamSet completed(const std::vector<ParamSpec>& specs, const ParamSet& given, const char* what) {
  ParamSet values;
  for (const auto& spec : specs) {
    const auto it = given.find(spec.name);
    if (it == given.end() && spec.required)
      throw std::invalid_argument(text::join(what, " '", spec.name, "' has to be given"));
    const ParamValue& value = it == given.end() ? spec.fallback : it->second;
    if (const auto problem = spec.problem_with(value))
      throw std::invalid_argument(text::join(what, " '", spec.name, "' ", *problem));
    const auto* integer = std::get_if<std::int64_t>(&value);
    ParamValue& out = values[spec.name];
    if (spec.type == ParamType::number && integer != nullptr)
      out = static_cast<double>(*integer);
    else
      out = value;
    if (auto* choices = std::get_if<std::vector<PluginChoice>>(&out))
      for (PluginChoice& choice : *choices) choice.options = completed(spec.options, choice.options, "option");
  }
  for (const auto& [name, value] : given)
    if (!values.contains(name)) throw std::invalid_argument(text::join("unknown ", what, " '", name, "'"));
  return values;
}

}  // namespace

bool PluginChoice::operator==(const PluginChoice& other) const {
  return type == other.type && parameters == other.parameters && options == other.options;
}

std::string to_text(const ParamValue& value) {
  struct Visitor {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return text::join(i); }
    std::string operator()(double d) const { return text::join(d); }
    std::string operator()(const std::string& s) const { return s; }
    std::string operator()(const PluginChoice& choice) const {
      std::string out = "{type: " + in_map(choice.type);
      for (const ParamSet* set : {&choice.options, &choice.parameters})
        for (const auto& [name, held] : *set) out += ", " + name + ": " + in_map(held);
      return out + "}";
    }
    std::string operator()(const std::vector<PluginChoice>& choices) const {
      std::string out;
      for (const auto& choice : choices) out += (out.empty() ? "" : ", ") + (*this)(choice);
      return "[" + out + "]";
    }
  };
  return std::visit(Visitor{}, value);
}

std::string ParamSpec::range_text() const {
  if (min && max) return text::join(min_open ? '(' : '[', *min, ", ", *max, max_open ? ')' : ']');
  if (min) return text::join(min_open ? ">" : ">=", " ", *min);
  if (max) return text::join(max_open ? "<" : "<=", " ", *max);
  return "";
}

std::optional<std::string> ParamSpec::problem_with(const ParamValue& value) const {
  const auto mistyped = [&] { return text::join("must be ", noun(type), ", got ", shown(value, "")); };
  switch (type) {
    case ParamType::boolean:
      if (!std::holds_alternative<bool>(value)) return mistyped();
      return std::nullopt;
    case ParamType::text:
      if (!std::holds_alternative<std::string>(value)) return mistyped();
      return std::nullopt;
    case ParamType::choice: {
      const auto* s = std::get_if<std::string>(&value);
      const bool known =
          s != nullptr && std::any_of(choices.begin(), choices.end(), [&](const auto& c) { return c.name == *s; });
      if (known) return std::nullopt;
      return text::join("must be one of ", listed(choices), "; got ", shown(value, ""));
    }
    case ParamType::plugin: {
      const auto* choice = std::get_if<PluginChoice>(&value);
      if (choice == nullptr) return mistyped();
      if (choice->type.empty()) return "has to name a plugin";
      return std::nullopt;
    }
    case ParamType::plugins: {
      const auto* list = std::get_if<std::vector<PluginChoice>>(&value);
      if (list == nullptr) return mistyped();
      if (list->empty() && !may_be_empty) return "has to name a plugin";
      const bool unnamed = std::any_of(list->begin(), list->end(), [](const auto& c) { return c.type.empty(); });
      if (unnamed) return "has an item that names no plugin";
      return std::nullopt;
    }
    case ParamType::integer: {
      const auto* i = std::get_if<std::int64_t>(&value);
      if (i == nullptr) return mistyped();
      if (in_range(*this, static_cast<double>(*i))) return std::nullopt;
      return text::join(demand(*this), ", got ", shown(value, unit));
    }
    case ParamType::number: {
      double x = 0;
      if (const auto* d = std::get_if<double>(&value)) {
        x = *d;
      } else if (const auto* i = std::get_if<std::int64_t>(&value)) {
        x = static_cast<double>(*i);
      } else {
        return mistyped();
      }
      if (!std::isfinite(x)) return text::join("must be a finite number, got ", shown(value, ""));
      if (in_range(*this, x)) return std::nullopt;
      return text::join(demand(*this), ", got ", shown(value, unit));
    }
  }
  return "has an unknown type";
}

std::vector<std::string> problems_of_schema(const std::vector<ParamSpec>& specs) {
  std::vector<std::string> problems;
  std::set<std::string> names;
  for (const auto& spec : specs) {
    if (!good_name(spec.name))
      problems.push_back(text::join("parameter name '", spec.name, "' does not match [a-z][a-z0-9_]*"));
    if (spec.name == "type")  // stands beside the parameters in a configuration
      problems.push_back("parameter name 'type' is reserved for the id in a configuration");
    if (!names.insert(spec.name).second)
      problems.push_back(text::join("parameter '", spec.name, "' is declared twice"));
    if (spec.name == "advanced")
      problems.push_back("parameter name 'advanced' is reserved for the map of such parameters");
    if (spec.advanced && spec.required)
      problems.push_back(text::join("advanced parameter '", spec.name, "' has no default"));
    if (spec.doc.empty() && !spec.advanced) problems.push_back(text::join("parameter '", spec.name, "' has no doc"));
    if (spec.type == ParamType::integer || spec.type == ParamType::number) check_numeric(spec, problems);
    if (spec.type == ParamType::choice) check_choices(spec, problems);
    for (const auto& problem : problems_of_schema(spec.options))
      problems.push_back(text::join("in the items of '", spec.name, "': ", problem));
    if (const auto problem = spec.required ? std::nullopt : spec.problem_with(spec.fallback))
      problems.push_back(text::join("default of parameter '", spec.name, "' ", *problem));
  }
  return problems;
}

ParamSet complete(const std::vector<ParamSpec>& specs, const ParamSet& given) {
  return completed(specs, given, "parameter");
}

}  // namespace dismantle
