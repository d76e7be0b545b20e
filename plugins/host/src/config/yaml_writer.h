/// Values of parameters as YAML, with where they came from as comments.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dismantle/host/registry.h"

namespace dismantle {

std::string quoted(const std::string& text);
/// Text that YAML reads as itself without quotes, or in quotes.
std::string plain_or_quoted(const std::string& text);
/// Without line breaks, which would end a comment.
std::string one_line(std::string text);

class YamlWriter {
 public:
  /// `origins`: "run.seed" -> "a.yaml:4"; what is not in it gets no comment. `plugin_comment`: a line above each choice
  /// of a plugin, empty for none; not called where null. All outlive this.
  YamlWriter(const Registry& registry, const std::map<std::string, std::string>& origins,
             std::function<std::string(const RegisteredType&)> plugin_comment)
      : registry_(registry), origins_(origins), plugin_comment_(std::move(plugin_comment)) {}

  void line(const std::string& text) { out_ += text + "\n"; }
  /// `lead` + text, with the origin of `path` as a comment.
  void row(const std::string& lead, const std::string& text, const std::string& path);
  /// The members of a map, in the order of their declarations. `path` of the map, which is `indent` blanks in.
  void values(const std::string& path, std::size_t indent, const std::vector<ParamSpec>& specs, const ParamSet& values);
  /// The members of a choice: the comment, type, options, parameters.
  void choice(const std::string& path, std::size_t indent, PluginKind kind, const std::vector<ParamSpec>& options,
              const PluginChoice& choice);

  const std::string& text() const { return out_; }

 private:
  const Registry& registry_;
  const std::map<std::string, std::string>& origins_;
  std::function<std::string(const RegisteredType&)> plugin_comment_;
  std::string out_;
};

}  // namespace dismantle
