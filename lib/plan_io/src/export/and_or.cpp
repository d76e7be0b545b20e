// The AND/OR graph of the sub-assemblies of a plan.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/plan_io/text_columns.h"
#include "export/dot_text.h"
#include "json/json_text.h"
#include "json/verdicts_json.h"

namespace dismantle {
namespace {

struct AndOrArc {
  std::size_t step = 0;  // index
  std::size_t from = 0;
  std::vector<std::size_t> to;
};

struct AndOrGraph {
  std::vector<std::vector<std::size_t>> nodes;  // ascending part indices
  std::vector<AndOrArc> arcs;
};

AndOrGraph and_or_graph(const Plan& plan) {
  AndOrGraph graph;
  std::map<std::vector<std::size_t>, std::size_t> known;
  const auto node = [&](std::span<const std::size_t> members) {
    std::vector<std::size_t> parts(members.begin(), members.end());
    std::ranges::sort(parts);
    const auto [it, fresh] = known.try_emplace(parts, graph.nodes.size());
    if (fresh) graph.nodes.push_back(parts);
    return it->second;
  };
  if (plan.assembly.parts.empty()) return graph;
  const PlanHistory history(plan);
  node(history.members(0, 0));
  for (std::size_t s = 0; s < history.steps(); ++s)
    for (const GroupSplit& split : history.splits(s)) {
      AndOrArc arc{s, node(history.members(split.from, s)), {node(history.members(split.from, s + 1))}};
      for (const std::size_t group : split.out) arc.to.push_back(node(history.members(group, s + 1)));
      graph.arcs.push_back(std::move(arc));
    }
  return graph;
}

std::vector<std::string> part_names(const Plan& plan, const std::vector<std::size_t>& indices) {
  std::vector<std::string> out;
  for (const std::size_t i : indices) out.push_back(plan.assembly.parts[i].name);
  return out;
}

/// All names of a few parts; for many parts, the first names and the count.
std::string node_label(std::vector<std::string> names) {
  const std::size_t shown = 4;
  const std::size_t count = names.size();
  if (count <= shown) return text::joined(names);
  names.resize(shown - 1);
  return fmt::format("{} parts: {}, ...", count, text::joined(names));
}

}  // namespace

std::string and_or_json(const Plan& plan) {
  const AndOrGraph graph = and_or_graph(plan);
  nlohmann::ordered_json out = {{"format", "dismantle.and_or"}, {"version", 1}, {"source", plan.assembly.source}};
  auto nodes = nlohmann::ordered_json::array(), arcs = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    nodes.push_back({{"id", i}, {"parts", part_names(plan, graph.nodes[i])}});
  for (const AndOrArc& arc : graph.arcs) {
    const PlanStep& step = plan.disassembly[arc.step];
    std::vector<std::string> moves;
    for (const PlanMove& move : step.moves) moves.push_back(move.part);
    arcs.push_back({{"step", step.step},
                    {"from", arc.from},
                    {"to", arc.to},
                    {"moves", moves},
                    {"max_penetration", step.max_penetration}});
    if (!step.checks.empty()) arcs.back()["checks"] = verdicts_json(step.checks);
  }
  out["nodes"] = std::move(nodes);
  out["arcs"] = std::move(arcs);
  return json_text(out) + "\n";
}

std::string and_or_dot(const Plan& plan) {
  const AndOrGraph graph = and_or_graph(plan);
  std::string out =
      "// A box is a set of parts that are together at some time, a circle the step that takes it apart.\n"
      "digraph and_or {\n"
      "  node [fontname=\"sans-serif\"];\n";
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const bool alone = graph.nodes[i].size() == 1;
    out += fmt::format("  n{} [shape=box, label={}{}];\n", i, dot_quoted(node_label(part_names(plan, graph.nodes[i]))),
                       alone ? ", style=rounded" : "");
  }
  for (const AndOrArc& arc : graph.arcs) {
    const unsigned step = plan.disassembly[arc.step].step;
    const std::string circle = fmt::format("a{}_{}", step, arc.from);
    out += fmt::format("  {} [shape=circle, fixedsize=true, width=0.4, label=\"{}\"];\n  n{} -> {} [arrowhead=none];\n",
                       circle, step, arc.from, circle);
    for (const std::size_t to : arc.to) out += fmt::format("  {} -> n{};\n", circle, to);
  }
  return out + "}\n";
}

}  // namespace dismantle
