#include "report/search_trees.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "dismantle/bench/trial_row.h"
#include "dismantle/plan_io/markup.h"
#include "dismantle/plan_io/write_file.h"

namespace dismantle::bench {
namespace {

using Trees = std::map<std::int64_t, std::vector<SearchNode>>;

Trees read_trees(Sqlite& db, std::int64_t trial) {
  Trees trees;
  if (!db.prepare("SELECT 1 FROM sqlite_master WHERE name = 'search_nodes'").step()) return trees;
  auto read = db.prepare(
      "SELECT search, node, parent, effort, x, y, z, qw, qx, qy, qz FROM search_nodes WHERE trial = ? ORDER BY search, "
      "node");
  read.bind(trial);
  while (read.step()) {
    SearchNode node{read.integer(0), read.integer(1), read.integer(2), read.number(3), {}};
    for (int k = 0; k < 7; ++k) node.place[static_cast<std::size_t>(k)] = read.number(4 + k);
    trees[node.search].push_back(node);
  }
  return trees;
}

/// The part that each search moves first.
std::map<std::int64_t, std::string> parts_of(Sqlite& db, std::int64_t trial) {
  std::map<std::int64_t, std::string> out;
  auto read = db.prepare("SELECT DISTINCT search, part FROM searches WHERE trial = ?");
  read.bind(trial);
  while (read.step()) out[read.integer(0)] = read.text(1);
  return out;
}

Eigen::Vector3d place_of(const SearchNode& node) { return {node.place[0], node.place[1], node.place[2]}; }

/// The tree in the plane in which it is widest. Lines get darker with effort; the thick one leads to the furthest node.
std::string picture_of(const std::vector<SearchNode>& nodes) {
  constexpr double kWidth = 720, kHeight = 420, kMargin = 16;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const SearchNode& node : nodes) mean += place_of(node) / static_cast<double>(nodes.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const SearchNode& node : nodes) spread += (place_of(node) - mean) * (place_of(node) - mean).transpose();
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  std::map<std::int64_t, Eigen::Vector2d> at;
  Eigen::Vector2d lo = Eigen::Vector2d::Zero(), hi = lo;
  for (const SearchNode& node : nodes) {
    const Eigen::Vector3d p = axes.transpose() * (place_of(node) - mean);
    at[node.node] = {p[2], p[1]};
    lo = lo.cwiseMin(at[node.node]);
    hi = hi.cwiseMax(at[node.node]);
  }
  const Eigen::Vector2d size = hi - lo;
  const double scale =
      std::min((kWidth - 2 * kMargin) / std::max(size.x(), 1e-12), (kHeight - 2 * kMargin) / std::max(size.y(), 1e-12));
  const auto shown = [&](std::int64_t node) -> Eigen::Vector2d {
    const Eigen::Vector2d p = scale * (at.at(node) - lo);
    return {kMargin + p.x(), kHeight - kMargin - p.y()};
  };
  std::map<std::int64_t, std::int64_t> parents;
  for (const SearchNode& node : nodes) parents[node.node] = node.parent;
  const Eigen::Vector3d root = place_of(nodes.front());
  const auto furthest = std::max_element(nodes.begin(), nodes.end(), [&](const SearchNode& a, const SearchNode& b) {
    return (place_of(a) - root).norm() < (place_of(b) - root).norm();
  });
  std::map<std::int64_t, bool> best;
  for (std::int64_t n = furthest->node; n >= 0 && parents.contains(n); n = parents[n]) best[n] = true;
  const double most = std::max(nodes.back().effort, 1e-12);
  std::string out = fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='search tree'>\n", kWidth, kHeight);
  for (const SearchNode& node : nodes) {
    const Eigen::Vector2d to = shown(node.node);
    if (parents.contains(node.parent)) {
      const Eigen::Vector2d from = shown(node.parent);
      out += fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke-width='{}' opacity='{:.2f}'/>\n",
                         from.x(), from.y(), to.x(), to.y(), best.contains(node.node) ? 2.5 : 0.8,
                         0.3 + 0.7 * node.effort / most);
    }
    out += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}'><title>node {}, effort {:.6g}</title></circle>\n",
                       to.x(), to.y(), node.parent < 0 ? 5 : 1.8, node.node, node.effort);
  }
  return out + "</svg>\n";
}

}  // namespace

void write_search_trees(Sqlite& db, std::int64_t trial, const std::filesystem::path& folder) {
  const Trees trees = read_trees(db, trial);
  if (trees.empty()) return;
  std::map<std::int64_t, std::string> parts = parts_of(db, trial);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::string page =
      "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>Search trees</title>\n<style>"
      "body { font: 15px/1.5 system-ui, sans-serif; max-width: 780px; margin: 0 auto; padding: 1rem }"
      "svg { width: 100%; border: 1px solid #8884 } line { stroke: #0072b2 } circle { fill: #d55e00 "
      "}</style></head><body>\n"
      "<h1>Search trees</h1>\n<p>Places of the centre of the part that moves, in the plane in which the tree is "
      "widest. "
      "Large dots are roots; lines are darker the later they were found, and thick on the way to the furthest node. "
      "search_trees.json has poses and effort of all nodes that were kept.</p>\n";
  for (const auto& [search, nodes] : trees) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const SearchNode& node : nodes)
      list.push_back({{"node", node.node}, {"parent", node.parent}, {"effort", node.effort}, {"place", node.place}});
    json.push_back({{"search", search}, {"part", parts[search]}, {"nodes", list}});
    page += fmt::format("<h2>Search {}: {}</h2>\n<p>{} nodes, effort {:.6g}.</p>\n{}", search,
                        escaped_markup(parts[search]), nodes.size(), nodes.back().effort, picture_of(nodes));
  }
  write_file(folder / "search_trees.json", json.dump(1) + "\n");
  write_file(folder / "search_trees.html", page + "</body></html>\n");
}

}  // namespace dismantle::bench
