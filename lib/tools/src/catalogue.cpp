#include "dismantle/tools/catalogue.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "dismantle/errors.h"

namespace dismantle::tools {
namespace {

/// Reads values and collects what is wrong with them.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  std::vector<Diagnostic> problems;

  void wrong(const YAML::Mark& mark, std::string message) {
    problems.push_back({file_, mark.line + 1, mark.column + 1, std::move(message)});
  }
  void wrong(const YAML::Node& node, std::string message) { wrong(node.Mark(), std::move(message)); }

  /// False if it is not a map. Reports other keys, and required ones that are missing.
  bool keys(const YAML::Node& node, const char* what, const std::vector<std::string>& required,
            const std::vector<std::string>& optional) {
    if (!node.IsMap()) {
      wrong(node, fmt::format("{} must be a map of keys", what));
      return false;
    }
    bool all = true;
    for (const auto& member : node) {
      const auto key = member.first.as<std::string>("");
      const auto in = [&](const auto& list) { return std::find(list.begin(), list.end(), key) != list.end(); };
      if (in(required) || in(optional)) continue;
      wrong(member.first, fmt::format("{} has no key '{}'; it has {}{}{}", what, key, fmt::join(required, ", "),
                                      optional.empty() ? "" : ", ", fmt::join(optional, ", ")));
    }
    for (const std::string& key : required)
      if (!node[key]) wrong(node, fmt::format("{} needs the key '{}'", what, key)), all = false;
    return all;
  }
  double number(const YAML::Node& node, double least) {
    const double value = node.as<double>(std::numeric_limits<double>::quiet_NaN());
    if (std::isfinite(value) && value >= least) return value;
    wrong(node, std::isfinite(least) ? fmt::format("this must be a number >= {}", least) : "this must be a number");
    return least > 0 ? least : 0;
  }
  /// A pair of numbers; `ascending`: the second one is larger.
  Eigen::Vector2d pair(const YAML::Node& node, bool ascending) {
    if (!node.IsSequence() || node.size() != 2) {
      wrong(node, "this must be a list of two numbers");
      return {0, 1};
    }
    constexpr double kAny = -std::numeric_limits<double>::infinity();
    const Eigen::Vector2d out(number(node[0], kAny), number(node[1], kAny));
    if (ascending && !(out.x() < out.y())) wrong(node, "the second number must be larger than the first one");
    return out;
  }
  std::string text(const YAML::Node& node) {
    if (node.IsScalar() && !node.Scalar().empty()) return node.Scalar();
    wrong(node, "this must be a text");
    return "";
  }
  bool flag(const YAML::Node& node) {
    bool value = false;
    if (!YAML::convert<bool>::decode(node, value)) wrong(node, "this must be true or false");
    return value;
  }

 private:
  std::string file_;
};

Volume volume_of(const YAML::Node& node, Reader& r) {
  Volume v;
  if (!node.IsMap() || node.size() != 1) {
    r.wrong(node, "a volume is a map of one key: tube, box or obround");
    return v;
  }
  const auto form = node.begin()->first.as<std::string>("");
  const YAML::Node body = node.begin()->second;
  const auto height = [&] {
    const Eigen::Vector2d z = r.pair(body["z"], true);
    v.low = z.x();
    v.high = z.y();
  };
  if (form == "tube") {
    if (!r.keys(body, "a tube", {"radius", "z"}, {"inner"})) return v;
    v.radius = r.number(body["radius"], 0);
    if (body["inner"]) v.inner = r.number(body["inner"], 0);
    if (!(v.inner < v.radius)) r.wrong(body, "'inner' must be smaller than 'radius'");
    height();
  } else if (form == "box") {
    v.form = Form::box;
    if (!r.keys(body, "a box", {"x", "y", "z"}, {})) return v;
    const Eigen::Vector2d x = r.pair(body["x"], true), y = r.pair(body["y"], true);
    v.from = {x.x(), y.x()};
    v.to = {x.y(), y.y()};
    height();
  } else if (form == "obround") {
    v.form = Form::obround;
    if (!r.keys(body, "an obround", {"from", "to", "radius", "z"}, {})) return v;
    v.from = r.pair(body["from"], false);
    v.to = r.pair(body["to"], false);
    v.radius = r.number(body["radius"], 0);
    if (!(v.radius > 0)) r.wrong(body["radius"], "this must be > 0");
    height();
  } else {
    r.wrong(node.begin()->first, fmt::format("'{}' is no volume; volumes are tube, box, obround", form));
  }
  return v;
}

std::vector<Volume> volumes_of(const YAML::Node& node, Reader& r) {
  std::vector<Volume> out;
  if (!node.IsSequence() || node.size() == 0) r.wrong(node, "this must be a list of volumes");
  if (node.IsSequence())
    for (const auto& item : node) out.push_back(volume_of(item, r));
  return out;
}

Fit fit_of(const YAML::Node& node, Reader& r) {
  Fit fit;
  if (!r.keys(node, "an item of 'fits'", {"size"}, {"drive", "kind"})) return fit;
  if (node["drive"].IsDefined() == node["kind"].IsDefined())
    r.wrong(node, "an item of 'fits' has either 'drive' or 'kind'");
  if (const YAML::Node drive = node["drive"]) {
    const auto& names = fasteners::kDriveNames;
    const auto at = std::find(names.begin(), names.end(), r.text(drive));
    if (at == names.end())
      r.wrong(drive, fmt::format("no such drive; drives are {}", fmt::join(names.begin() + 1, names.end(), ", ")));
    else
      fit.drive = static_cast<fasteners::Drive>(at - names.begin());
  }
  if (const YAML::Node kind = node["kind"]) {
    fit.kind = fasteners::kind_from_string(r.text(kind));
    if (!fit.kind) r.wrong(kind, fmt::format("no such kind; kinds are {}", fmt::join(fasteners::kKindNames, ", ")));
  }
  const YAML::Node size = node["size"];
  if (size.IsSequence()) {
    const Eigen::Vector2d range = r.pair(size, true);
    fit.least = range.x();
    fit.most = range.y();
  } else {
    constexpr double kPlay = 0.03;  // sizes of one series differ by more, and makers by less
    const double nominal = r.number(size, 0);
    fit.least = (1 - kPlay) * nominal;
    fit.most = (1 + kPlay) * nominal;
  }
  return fit;
}

Use use_of(const YAML::Node& node, Reader& r) {
  Use use;
  if (!r.keys(node, "a use", {"tool"}, {"name", "swing", "depth", "from", "beside", "hand"})) return use;
  if (node["name"]) use.name = r.text(node["name"]);
  if (node["swing"]) {
    const double degrees = r.number(node["swing"], 0);
    if (degrees > 360) r.wrong(node["swing"], "this must be at most 360 degrees");
    use.swing = degrees * std::numbers::pi / 180;
  }
  if (node["depth"]) use.depth = r.number(node["depth"], 0);
  if (const YAML::Node from = node["from"]) {
    const std::string text = r.text(from);
    if (text != "axis" && text != "side") r.wrong(from, "this must be axis or side");
    use.from_side = text == "side";
  }
  if (node["beside"]) use.beside = r.flag(node["beside"]);
  use.tool = volumes_of(node["tool"], r);
  if (node["hand"]) use.hand = volumes_of(node["hand"], r);
  return use;
}

Tool tool_of(const YAML::Node& node, Reader& r) {
  Tool tool;
  if (!r.keys(node, "a tool", {"id", "name", "fits", "uses"}, {})) return tool;
  tool.id = r.text(node["id"]);
  tool.name = r.text(node["name"]);
  for (const char* key : {"fits", "uses"})
    if (!node[key].IsSequence() || node[key].size() == 0)
      r.wrong(node[key], fmt::format("'{}' must be a list that is not empty", key));
  if (node["fits"].IsSequence())
    for (const auto& item : node["fits"]) tool.fits.push_back(fit_of(item, r));
  if (node["uses"].IsSequence())
    for (const auto& item : node["uses"]) tool.uses.push_back(use_of(item, r));
  return tool;
}

}  // namespace

std::vector<Tool> read_catalogue(const std::string& yaml, const std::string& file) {
  Reader reader(file);
  std::vector<Tool> tools;
  try {
    const YAML::Node root = YAML::Load(yaml);
    if (reader.keys(root, "a catalogue", {"tools"}, {})) {
      if (!root["tools"].IsSequence()) reader.wrong(root["tools"], "'tools' must be a list");
      std::set<std::string> ids;
      if (root["tools"].IsSequence())
        for (const auto& item : root["tools"]) {
          tools.push_back(tool_of(item, reader));
          if (!tools.back().id.empty() && !ids.insert(tools.back().id).second)
            reader.wrong(item["id"], fmt::format("there are two tools '{}'", tools.back().id));
        }
    }
  } catch (const YAML::Exception& e) {
    reader.wrong(e.mark, e.msg);
  }
  if (!reader.problems.empty()) throw ConfigError(std::move(reader.problems));
  return tools;
}

std::vector<Tool> read_catalogue(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  if (!in || !(text << in.rdbuf())) throw InputError(file.string(), "cannot be read as a catalogue of tools");
  return read_catalogue(text.str(), file.string());
}

}  // namespace dismantle::tools
