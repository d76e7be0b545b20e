#include "describe/facts.h"

#include <fmt/format.h>

namespace dismantle {

std::string type_name(ParamType type) {
  switch (type) {
    case ParamType::boolean:
      return "boolean";
    case ParamType::integer:
      return "integer";
    case ParamType::number:
      return "number";
    case ParamType::text:
      return "text";
    case ParamType::choice:
      return "choice";
  }
  return "value";
}

std::string default_text(const ParamSpec& spec) {
  const std::string text = to_text(spec.fallback);
  return text.empty() ? "\"\"" : text;
}

std::string limits_text(const ParamSpec& spec) {
  if (spec.type == ParamType::boolean) return "true | false";
  if (spec.type != ParamType::choice) return spec.range_text();
  std::vector<std::string> names;
  for (const auto& choice : spec.choices) names.push_back(choice.name);
  return joined(names, " | ");
}

std::vector<std::string> capability_words(const Capabilities& c) {
  std::vector<std::string> words;
  if (c.dynamics) words.emplace_back("dynamics");
  if (c.contacts) words.emplace_back("contacts");
  if (c.distance) words.emplace_back("distance");
  if (c.max_moving == static_cast<unsigned>(-1))
    words.emplace_back("any number of parts moving at once");
  else if (c.max_moving > 1)
    words.push_back(fmt::format("{} parts moving at once", c.max_moving));
  return words;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

}  // namespace dismantle
