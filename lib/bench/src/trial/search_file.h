/// What searches for paths record during a trial, in a file that outlives a killed process.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <vector>

#include "dismantle/bench/trial_row.h"
#include "dismantle/plugin/search_recorder.h"

namespace dismantle::bench {

/// Writes a point whenever a search has a better state, and the first nodes of its trees.
class SearchFile final : public SearchListener {
 public:
  /// `most_nodes`: of the trial.
  SearchFile(const std::filesystem::path& file, std::size_t most_nodes);
  std::size_t begin(const PathQuery& query) override;
  void node(std::size_t search, std::ptrdiff_t parent, const std::vector<Pose>& poses, double effort,
            double distance) override;

 private:
  struct Search {
    std::string part;
    std::size_t nodes = 0;
    double size = 1, best = 0;                         // largest edge of the assembly, assembly units
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of the first moving part, assembled
    Normalization frame;
  };
  const bool keeps_nodes_;
  std::mutex mutex_;
  std::ofstream file_;
  std::size_t nodes_left_;
  std::vector<Search> searches_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// What a SearchFile has written.
SearchRecords read_searches(const std::filesystem::path& file);

}  // namespace dismantle::bench
