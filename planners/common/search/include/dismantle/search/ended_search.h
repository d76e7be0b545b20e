/// A search that ends before it begins.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "dismantle/path_planner.h"

namespace dismantle::path {

class EndedSearch final : public PathSearch {
 public:
  explicit EndedSearch(PathResult result) : result_(std::move(result)) {}
  SearchStatus run(const Budget&) override { return status_of(result_.outcome()); }
  PathResult result() override { return result_; }

 private:
  PathResult result_;
};

/// For a simulator that lacks a capability the planner needs.
inline std::unique_ptr<PathSearch> unsupported(std::string message) {
  return std::make_unique<EndedSearch>(PathResult::failure(Outcome::unsupported, std::move(message)));
}

}  // namespace dismantle::path
