#include "dismantle/orders/order.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/plan_io/motion_words.h"
#include "reference_groups.h"

namespace dismantle {
namespace {

/// The parts of each group that comes apart in a plan, as a tree: what is taken out of what.
struct Group {
  std::vector<std::string> parts;                                // that are in it now
  std::vector<std::pair<std::size_t, std::size_t>> taken_out{};  // step of the plan, index of the group
};

OrderStep step_of(const PlanStep& step, const PlanAssembly& assembly) {
  OrderStep out;
  out.up = step.up;
  if (step.moves.empty()) return out;
  const std::vector<Pose>& poses = step.moves.front().poses;
  const Eigen::Vector3d point = point_on_axis(poses, assembly.box.empty() ? assembly.center : assembly.box.center());
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const Eigen::Vector3d along = poses[k - 1] * point - poses[k] * point;  // of the insertion
    if (!out.direction && along.norm() > 0) out.direction = along.normalized();
    out.travel += along.norm();
    out.turns += poses[k - 1].q.angularDistance(poses[k].q) / (2 * std::numbers::pi);
  }
  return out;
}

void append(const std::vector<Group>& groups, std::size_t index, OrderStep put_in, const Plan& plan, Order& out) {
  const Group& group = groups[index];
  put_in.parts = group.parts;
  out.push_back(std::move(put_in));
  for (auto taken = group.taken_out.rbegin(); taken != group.taken_out.rend(); ++taken)
    append(groups, taken->second, step_of(plan.disassembly[taken->first], plan.assembly), plan, out);
}

/// The fields of a line; quoted ones may hold separators and doubled quotes.
std::vector<std::string> fields_of(const std::string& line, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

std::string without_blanks(const std::string& field) {
  const auto first = field.find_first_not_of(" \t");
  return first == std::string::npos ? "" : field.substr(first, field.find_last_not_of(" \t") + 1 - first);
}

/// Lines that end with LF, CRLF or CR, without a byte order mark: spreadsheets write all of them.
std::istringstream lines_of(std::istream& in) {
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string lines;
  for (std::size_t i = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; i < text.size(); ++i)
    if (text[i] != '\r')
      lines += text[i];
    else if (i + 1 == text.size() || text[i + 1] != '\n')
      lines += '\n';
  return std::istringstream(lines);
}

}  // namespace

Order order_of(const Plan& plan) {
  std::vector<Group> groups(1);
  std::map<std::string, std::size_t> at;
  for (const PlanPart& part : plan.assembly.parts) {
    groups[0].parts.push_back(part.name);
    at[part.name] = 0;
  }
  for (std::size_t k = 0; k < plan.disassembly.size(); ++k)
    for (const auto& separated : plan.disassembly[k].separates) {
      if (separated.empty()) continue;
      const std::size_t from = at.at(separated.front()), index = groups.size();
      groups.push_back({separated});
      groups[from].taken_out.emplace_back(k, index);
      std::erase_if(groups[from].parts, [&](const std::string& part) {
        return std::find(separated.begin(), separated.end(), part) != separated.end();
      });
      for (const std::string& part : separated) at[part] = index;
    }
  Order order;
  append(groups, 0, {}, plan, order);
  return order;
}

Order order_of(const std::vector<PlanReferenceStep>& reference) {
  const ReferenceGroups groups(reference);
  std::set<std::string> around;
  Order order;
  const auto add = [&](const auto& self, const std::string& group) -> void {
    around.insert(group);
    for (const PlanReferenceStep& step : reference) {
      if (step.group != group) continue;
      StepItems<std::string> items = groups.items_of(step, around);
      if (!items.parts.empty()) order.push_back({std::move(items.parts), {}, step.up, 0});
      for (const std::string& name : items.groups) self(self, name);
    }
    around.erase(group);
  };
  add(add, "");
  return order;
}

std::optional<Eigen::Vector3d> direction_named(const std::string& text) {
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'x' && text[1] <= 'z')
    return Eigen::Vector3d::Unit(text[1] - 'x') * (text[0] == '+' ? 1 : -1);
  std::istringstream words(text);
  Eigen::Vector3d v;
  if (!(words >> v.x() >> v.y() >> v.z()) || !(words >> std::ws).eof() || !(v.norm() > 0) || !v.allFinite()) return {};
  return v.normalized();
}

Order read_order(const std::filesystem::path& file) {
  std::ifstream opened(file);
  if (!opened) throw InputError(file.string(), "cannot be opened");
  std::istringstream in = lines_of(opened);
  char separator = ',';
  std::string line;
  std::size_t number = 0;
  std::map<std::string, std::size_t> columns;
  std::map<double, OrderStep> steps;
  std::set<std::string> seen;
  while (std::getline(in, line)) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (columns.empty() && line.find(',') == std::string::npos && line.find(';') != std::string::npos) separator = ';';
    const std::vector<std::string> fields = fields_of(line, separator);
    const std::string where = fmt::format("{}:{}", file.string(), number);
    if (columns.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) columns.emplace(without_blanks(fields[i]), i);
      if (!columns.contains("step") || !columns.contains("part"))
        throw InputError(where, "the header needs the columns 'step' and 'part'");
      continue;
    }
    const auto field = [&](const char* name) {
      const auto column = columns.find(name);
      return column == columns.end() || column->second >= fields.size() ? std::string() : fields[column->second];
    };
    const std::string text = without_blanks(field("step"));
    double step = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(step))
      throw InputError(where, fmt::format("'{}' is no number of a step", text));
    const std::string part = field("part");
    if (part.empty() || !seen.insert(part).second)
      throw InputError(where, part.empty() ? "no part is named" : fmt::format("part '{}' is there twice", part));
    steps[step].parts.push_back(part);
    if (const std::string direction = field("direction"); !direction.empty()) {
      steps[step].direction = direction_named(direction);
      if (!steps[step].direction)
        throw InputError(where, fmt::format("'{}' is no direction: {}", direction, kDirections));
    }
  }
  if (steps.empty()) throw InputError(file.string(), "it holds no step");
  Order order;
  for (auto& [step, content] : steps) order.push_back(std::move(content));
  return order;
}

PartClasses classes_of(const PlanAssembly& assembly) {
  PartClasses classes;
  for (const PlanPart& part : assembly.parts)
    if (!part.product.empty()) classes[part.name] = "product " + part.product;
  return classes;
}

OrderMeasures measures_of(const Order& order, const PartClasses& classes) {
  constexpr double same = 0.99985;  // cosine of a degree
  OrderMeasures out;
  const OrderStep *directed = nullptr, *oriented = nullptr;
  std::map<std::string, std::size_t> latest;  // step of each class
  for (std::size_t k = 0; k < order.size(); ++k) {
    const OrderStep& step = order[k];
    ++out.steps;
    out.parts += step.parts.size();
    out.travel += step.travel;
    out.turns += step.turns;
    if (step.direction) {
      out.off_axis += step.direction->cwiseAbs().maxCoeff() < same;
      out.direction_changes += directed != nullptr && directed->direction->dot(*step.direction) < same;
      directed = &step;
    }
    if (step.up) {
      out.reorientations += oriented != nullptr && oriented->up->dot(*step.up) < same;
      oriented = &step;
    }
    std::set<std::string> here;
    for (const std::string& part : step.parts)
      if (const auto known = classes.find(part); known != classes.end()) here.insert(known->second);
    for (const std::string& name : here) {
      if (const auto before = latest.find(name); before != latest.end()) out.torn += before->second + 1 < k;
      latest[name] = k;
    }
  }
  return out;
}

}  // namespace dismantle
