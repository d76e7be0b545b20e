/// Writes parameter values as YAML, with their origins as comments.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle {

std::string quoted(const std::string& text);
/// The text as it is where YAML reads it back unchanged, otherwise in quotes.
std::string plain_or_quoted(const std::string& text);
/// The text without line breaks, which would end a comment.
std::string one_line(std::string text);

class YamlWriter {
 public:
  /// `origins`: "run.seed" -> "a.yaml:4"; values not in it get no comment. `plugin_comment`: returns the line above
  /// each plugin choice, empty for no line; may be null. All arguments must outlive this.
  YamlWriter(const Registry& registry, const std::map<std::string, std::string>& origins,
             std::function<std::string(const RegisteredType&)> plugin_comment)
      : registry_(registry), origins_(origins), plugin_comment_(std::move(plugin_comment)) {}

  void line(const std::string& text) { out_ += text + "\n"; }
  /// Writes `lead` + `text`, with the origin of `path` as a comment.
  void row(const std::string& lead, const std::string& text, const std::string& path);
  /// Writes the members of the map at `path` in declaration order, indented by `indent` blanks. Advanced parameters
  /// come last, in the map `advanced`, and only those that differ from their defaults. `path` is empty for the file
  /// itself.
  void values(const std::string& path, std::size_t indent, const std::vector<ParamSpec>& specs, const ParamSet& values);
  /// Writes the section `name`, if it has any value to write.
  void section(const std::string& name, const std::vector<ParamSpec>& specs, const ParamSet& values);
  /// Writes the members of a choice: comment, type, options, parameters. `below`: the choice whose values hold where
  /// none is written, if it has the same type; may be nullptr.
  void choice(const std::string& path, std::size_t indent, PluginKind kind, const std::vector<ParamSpec>& options,
              const PluginChoice& choice, const PluginChoice* below = nullptr);

  const std::string& text() const { return out_; }

 private:
  void value(const std::string& path, std::size_t indent, const ParamSpec& spec, const ParamValue& value);

  const Registry& registry_;
  const std::map<std::string, std::string>& origins_;
  std::function<std::string(const RegisteredType&)> plugin_comment_;
  std::string out_;
};

}  // namespace dismantle
