/// Records the progress of a search for a path: the nodes of its tree, and how far the best one is. Without a listener
/// nothing is recorded, and a call costs a test of a pointer.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "dismantle/path_planner.h"

namespace dismantle {

/// Receives what is recorded. Called from several threads.
class SearchListener {
 public:
  virtual ~SearchListener() = default;
  /// A search begins; returns its number.
  virtual std::size_t begin(const PathQuery& query) = 0;
  /// A node of search `search`. `parent`: number of an earlier node of this search, or -1 for a root; nodes are
  /// numbered from 0. `poses`: of the moving parts. `effort`: SearchStats::cost so far. `distance`: how far the centre of a
  /// moving part is from where it was, assembly units.
  virtual void node(std::size_t search, std::ptrdiff_t parent, const std::vector<Pose>& poses, double effort,
                    double distance) = 0;
};

/// A RunContext::on_log that also carries a listener.
struct SearchRecorder {
  std::function<void(LogLevel, std::string_view)> log;
  std::shared_ptr<SearchListener> listener;
  void operator()(LogLevel level, std::string_view text) const {
    if (log) log(level, text);
  }
};

/// The record of one search; a member of the search, used by one thread at a time.
class SearchRecord {
 public:
  /// `query` outlives this.
  SearchRecord(const PathQuery& query, const RunContext& context) : query_(&query) {
    if (const auto* recorder = context.on_log.target<SearchRecorder>()) listener_ = recorder->listener;
    restart();
  }

  /// False: there is no listener, node() does nothing, and its arguments need not be computed.
  bool listens() const { return listener_ != nullptr; }
  /// As SearchListener::node(): nodes are numbered from 0, in the order of these calls.
  void node(std::ptrdiff_t parent, const std::vector<Pose>& poses, double effort, double distance) {
    if (listens()) listener_->node(search_, parent, poses, effort, distance);
  }
  /// The search forgets its nodes and begins anew.
  void restart() {
    if (listens()) search_ = listener_->begin(*query_);
  }

 private:
  const PathQuery* query_;
  std::shared_ptr<SearchListener> listener_;
  std::size_t search_ = 0;
};

}  // namespace dismantle
