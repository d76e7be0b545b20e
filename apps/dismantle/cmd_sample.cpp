// dismantle sample list | NAME -o DIR
#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "command.h"
#include "console.h"
#include "dismantle/errors.h"
#include "dismantle/host/suggest.h"
#include "dismantle/samples/samples.h"
#include "settings.h"

namespace dismantle::app {
namespace {

struct SampleOptions {
  std::string name, folder;
  std::vector<std::string> set;
  ConsoleOptions console;
};

/// Not a ConfigError, since there is no file to refer to.
class UsageError : public Error {
  using Error::Error;
};

std::string facts(const samples::Sample& sample) {
  const char* overlap = sample.clean ? "" : "parts overlap; ";
  if (!sample.solvable) return fmt::format("{}cannot be taken apart", overlap);
  return fmt::format("{}{}{}", overlap, sample.translation_only ? "straight motions" : "needs turning",
                     sample.one_at_a_time ? "" : ", several parts simultaneously");
}

std::string list_text() {
  std::string out;
  for (const auto& sample : samples::list()) {
    out += fmt::format("{}: {} ({})\n", sample.name, sample.summary, facts(sample));
    for (const auto& p : sample.params) {
      const std::string unit = p.unit.empty() || p.unit == "1" ? "" : " " + p.unit, range = p.range_text();
      out += fmt::format("    {} = {}{}{}: {}\n", p.name, to_text(p.fallback), unit,
                         range.empty() ? "" : " in " + range, p.doc);
    }
  }
  return out;
}

template <class Number>
Number number_of(const std::string& key, const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw UsageError(
        fmt::format("--set {}: '{}' is not a {}", key, text, std::is_integral_v<Number> ? "whole number" : "number"));
  return value;
}

ParamValue value_of(const ParamSpec& spec, const std::string& text) {
  switch (spec.type) {
    case ParamType::boolean:
      if (text != "true" && text != "false")
        throw UsageError(fmt::format("--set {}: expected true or false", spec.name));
      return text == "true";
    case ParamType::integer:
      return number_of<std::int64_t>(spec.name, text);
    case ParamType::number:
      return number_of<double>(spec.name, text);
    case ParamType::text:
    case ParamType::choice:
    case ParamType::plugin:  // no sample has such parameters; complete() reports them
    case ParamType::plugins:
      break;
  }
  return text;
}

ParamSet parameters(const samples::Sample& sample, const std::vector<std::string>& set) {
  ParamSet out;
  for (const auto& item : set) {
    const auto equals = item.find('=');
    if (equals == std::string::npos) throw UsageError(fmt::format("--set {}: expected KEY=VALUE", item));
    const std::string key = item.substr(0, equals);
    std::vector<std::string> known;
    const ParamSpec* found = nullptr;
    for (const auto& spec : sample.params) {
      known.push_back(spec.name);
      if (spec.name == key) found = &spec;
    }
    if (found == nullptr) {
      const auto near = nearest(key, known);
      throw UsageError(fmt::format("--set {}: sample '{}' has no parameter of this name{}", key, sample.name,
                                   near ? fmt::format("; did you mean '{}'?", *near) : ""));
    }
    if (!out.emplace(key, value_of(*found, item.substr(equals + 1))).second)
      throw UsageError(fmt::format("--set {}: given twice", key));
  }
  return out;
}

int sample(const SampleOptions& options) {
  Console console(options.console);
  if (options.name == "list") {
    console.text(list_text());
    return kComplete;
  }
  const samples::Sample* found = samples::find(options.name);
  if (found == nullptr) {
    std::vector<std::string> names;
    for (const auto& s : samples::list()) names.push_back(s.name);
    const auto near = nearest(options.name, names);
    throw UsageError(fmt::format("there is no sample '{}'{} (see 'dismantle sample list')", options.name,
                                 near ? fmt::format("; did you mean '{}'?", *near) : ""));
  }
  if (options.folder.empty()) throw UsageError("-o DIR is missing: where should the sample's files go?");
  std::vector<RawPart> parts;
  try {
    parts = samples::make(options.name, parameters(*found, options.set));
  } catch (const std::invalid_argument& e) {  // invalid or inconsistent values
    throw UsageError(fmt::format("sample {}: {}", options.name, e.what()));
  }
  open_output_folder(options.folder);
  const auto files = samples::write(parts, options.folder);
  std::string text;
  for (const auto& file : files) text += fmt::format("wrote {}\n", file.string());
  console.text(text);
  return kComplete;
}

}  // namespace

void add_sample(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("sample", "Make one of the parametric example assemblies");
  auto options = std::make_shared<SampleOptions>();
  command->add_option("NAME", options->name, "'list', or the name of a sample")->required()->option_text(" ");
  command->add_option("-o,--output", options->folder, "Folder for the parts, one OBJ file each")->option_text("DIR");
  command->add_option("--set", options->set, "A parameter of the sample; may be repeated")
      ->option_text("KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  add_verbosity(*command, options->console);
  command->footer(
      "Examples:\n"
      "  dismantle sample list\n"
      "  dismantle sample machine -o machine --set parts=12");
  command->callback([&action, options] { action = [options] { return sample(*options); }; });
}

}  // namespace dismantle::app
