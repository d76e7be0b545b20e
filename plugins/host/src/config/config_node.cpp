#include "dismantle/host/config_node.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "config/config_limits.h"

namespace dismantle {
namespace {

/// Ends the parsing after an error was reported.
struct Stop {};

std::size_t node_count(const ConfigNode& node) {
  std::size_t count = 1;
  for (const auto& item : node.items) count += node_count(item);
  for (const auto& member : node.members) count += node_count(member.value);
  return count;
}

/// Builds the tree from the parser's events: only they give the place of a key and show repeated keys.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::shared_ptr<const std::string> source, std::vector<Diagnostic>& problems)
      : source_(std::move(source)), problems_(problems) {}

  ConfigNode root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& at, YAML::anchor_t anchor) override { leaf(make(ConfigNode::Kind::null, at), anchor); }

  void OnScalar(const YAML::Mark& at, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(at, tag);
    ConfigNode node = make(ConfigNode::Kind::scalar, at);
    node.scalar = value;
    node.quoted = tag == "!";  // yaml-cpp: "?" = plain
    leaf(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& at, YAML::anchor_t anchor) override {
    const auto it = anchors_.find(anchor);
    if (it == anchors_.end()) stop(at, "alias of a node that is not finished");
    ConfigNode copy = it->second;
    count(node_count(copy), at);
    leaf(std::move(copy), YAML::NullAnchor);
  }

  void OnSequenceStart(const YAML::Mark& at, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check_tag(at, tag);
    open(make(ConfigNode::Kind::sequence, at), anchor, at);
  }
  void OnMapStart(const YAML::Mark& at, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    check_tag(at, tag);
    open(make(ConfigNode::Kind::map, at), anchor, at);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

  ConfigMark place(const YAML::Mark& at) const {
    if (at.is_null()) return {source_, 0, 0};
    return {source_, at.line + 1, at.column + 1};
  }

 private:
  struct Open {
    ConfigNode node;
    YAML::anchor_t anchor;
    bool has_key = false;
    bool skip = false;  // the current key is a repetition or not a text
    std::string key;
    ConfigMark key_mark;
  };

  ConfigNode make(ConfigNode::Kind kind, const YAML::Mark& at) {
    count(1, at);
    ConfigNode node;
    node.kind = kind;
    node.mark = place(at);
    return node;
  }
  [[noreturn]] void stop(const YAML::Mark& at, const std::string& message) {
    problems_.push_back(place(at).error(message));
    throw Stop{};
  }
  void count(std::size_t more, const YAML::Mark& at) {
    nodes_ += more;
    if (nodes_ > kConfigLimits.nodes)
      stop(at, fmt::format("more than {} nodes: this is no configuration", kConfigLimits.nodes));
  }
  void check_tag(const YAML::Mark& at, const std::string& tag) {
    if (!tag.empty() && tag != "?" && tag != "!")
      problems_.push_back(place(at).error(fmt::format("YAML tags are not supported: '{}'", tag)));
  }
  void open(ConfigNode node, YAML::anchor_t anchor, const YAML::Mark& at) {
    if (open_.size() >= kConfigLimits.depth)
      stop(at, fmt::format("nested more than {} levels deep", kConfigLimits.depth));
    open_.push_back({std::move(node), anchor, false, false, "", {}});
  }
  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    leaf(std::move(done.node), done.anchor);
  }
  void leaf(ConfigNode node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) {
      count(node_count(node), {});  // counts the copy for aliases: nested anchors multiply
      anchors_[anchor] = node;
    }
    if (open_.empty()) {
      root = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == ConfigNode::Kind::sequence) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.has_key) {
      take_key(parent, node);
    } else {
      // The parser puts an empty value at the next token; the place of its key is more useful.
      if (node.kind == ConfigNode::Kind::null) node.mark = parent.key_mark;
      if (!parent.skip) parent.node.members.push_back({parent.key, parent.key_mark, std::move(node)});
      parent.has_key = false;
    }
  }
  void take_key(Open& parent, const ConfigNode& node) {
    parent.has_key = true;
    parent.skip = false;
    parent.key = node.scalar;
    parent.key_mark = node.mark;
    if (!node.is_scalar()) {
      parent.skip = true;
      problems_.push_back(node.mark.error(fmt::format("a key must be text, not {}", node.kind_name())));
    } else if (const auto* first = parent.node.find(node.scalar)) {
      parent.skip = true;
      problems_.push_back(node.mark.error(
          fmt::format("key '{}' is repeated; it stands at line {} already", node.scalar, first->key_mark.line)));
    }
  }

  std::shared_ptr<const std::string> source_;
  std::vector<Diagnostic>& problems_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, ConfigNode> anchors_;
  std::size_t nodes_ = 0;
};

}  // namespace

std::string ConfigMark::text() const { return line > 0 ? fmt::format("{}:{}", file(), line) : file(); }

std::string ConfigMark::warning(const std::string& message) const {
  return fmt::format("{}{}: {}", text(), line > 0 && column > 0 ? fmt::format(":{}", column) : "", message);
}

Diagnostic ConfigMark::error(std::string message) const { return {file(), line, column, std::move(message)}; }

const ConfigMember* ConfigNode::find(const std::string& key) const {
  const auto it = std::find_if(members.begin(), members.end(), [&](const auto& m) { return m.key == key; });
  return it == members.end() ? nullptr : &*it;
}

ConfigMember* ConfigNode::find(const std::string& key) {
  return const_cast<ConfigMember*>(std::as_const(*this).find(key));
}

void ConfigNode::erase(const std::string& key) {
  std::erase_if(members, [&](const auto& m) { return m.key == key; });
}

std::string_view ConfigNode::kind_name() const {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::scalar:
      return "a value";
    case Kind::sequence:
      return "a list";
    case Kind::map:
      return "a map";
  }
  return "nothing";
}

ConfigNode parse_yaml(const std::string& text, const std::string& source, std::vector<Diagnostic>& problems) {
  auto name = std::make_shared<const std::string>(source);
  TreeBuilder builder(name, problems);
  bool any = false, cut_off = false;
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    any = parser.HandleNextDocument(builder);
    if (any) {
      ConfigNode first = std::move(builder.root);
      builder.root = {};
      if (parser.HandleNextDocument(builder))
        problems.push_back(builder.root.mark.error("a second YAML document begins here: a configuration is one"));
      builder.root = std::move(first);
    }
  } catch (const YAML::Exception& e) {
    problems.push_back(builder.place(e.mark).error("invalid YAML: " + e.msg));
    cut_off = true;
  } catch (const Stop&) {
    cut_off = true;  // reported where it was thrown
  }
  if (!any || builder.root.kind == ConfigNode::Kind::null) {
    builder.root.kind = ConfigNode::Kind::map;
    builder.root.mark = {name, 1, 1};
  }
  builder.root.cut_off = cut_off;
  return std::move(builder.root);
}

bool read_yaml(const std::string& file, ConfigNode& node, std::vector<Diagnostic>& problems, std::string& unreadable) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    unreadable = fmt::format("'{}' is a folder, not a YAML file", file);
    return false;
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    unreadable = fmt::format("cannot read '{}': {}", file, std::generic_category().message(errno));
    return false;
  }
  std::string text;
  char block[65536];
  while (text.size() <= kConfigLimits.bytes && (stream.read(block, sizeof(block)), stream.gcount() > 0))
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  if (stream.bad() || text.size() > kConfigLimits.bytes) {
    unreadable = fmt::format("'{}' {}", file, stream.bad() ? "cannot be read" : "is larger than 1 MiB");
    return false;
  }
  node = parse_yaml(text, file, problems);
  return true;
}

}  // namespace dismantle
