#include "trial/search_file.h"

#include <fmt/format.h>

#include <sstream>
#include <string>

namespace dismantle::bench {
namespace {

/// A state is better when it is further by this share: a search may have a million states.
constexpr double kBetter = 1.05;

}  // namespace

SearchFile::SearchFile(const std::filesystem::path& file, std::size_t most_nodes)
    : keeps_nodes_(most_nodes > 0), file_(file), nodes_left_(most_nodes) {}

std::size_t SearchFile::begin(const PathQuery& query) {
  const Assembly& assembly = query.assembly;
  Search search;
  search.size = assembly.normalization.scale * assembly.input_box.size().maxCoeff();
  search.frame = assembly.normalization;
  if (!query.scene.moving.empty()) {
    const Part& part = assembly.parts[query.scene.moving.front().part];
    search.part = part.name;
    if (keeps_nodes_) {  // searches are many, and so are vertices
      Aabb box;
      for (const Eigen::Vector3d& v : part.mesh->vertices) box.extend(v);
      search.center = box.center();
    }
  }
  const std::lock_guard lock(mutex_);
  searches_.push_back(std::move(search));
  return searches_.size() - 1;
}

void SearchFile::node(std::size_t search, std::ptrdiff_t parent, const std::vector<Pose>& poses, double effort,
                      double distance) {
  const std::lock_guard lock(mutex_);
  Search& s = searches_.at(search);
  const std::size_t number = s.nodes++;
  if (distance > kBetter * s.best) {
    s.best = distance;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    file_ << fmt::format("best {} {:.6f} {:.9g} {:.6g} {}\n", search, seconds, effort, distance / s.size, s.part)
          << std::flush;
  }
  if (nodes_left_ == 0 || poses.empty()) return;
  --nodes_left_;
  const Eigen::Vector3d at = s.frame.to_input(poses.front() * s.center);
  const Eigen::Quaterniond& q = poses.front().q;
  file_ << fmt::format("node {} {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", search, number,
                       parent, effort, at.x(), at.y(), at.z(), q.w(), q.x(), q.y(), q.z());
}

SearchRecords read_searches(const std::filesystem::path& file) {
  SearchRecords out;
  std::ifstream in(file);
  for (std::string line, kind; std::getline(in, line);) {
    std::istringstream words(line);
    words >> kind;
    if (kind == "best") {
      SearchPoint p;
      if (words >> p.search >> p.seconds >> p.effort >> p.best && std::getline(words >> std::ws, p.part))
        out.points.push_back(std::move(p));
    } else if (kind == "node") {
      SearchNode n;
      words >> n.search >> n.node >> n.parent >> n.effort;
      for (double& x : n.place) words >> x;
      if (words) out.nodes.push_back(n);  // the last line of a killed process may be cut off
    }
  }
  return out;
}

}  // namespace dismantle::bench
