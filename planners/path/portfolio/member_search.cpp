#include "member_search.h"

namespace dismantle::portfolio {

void MemberSearch::begin(const PathQuery& query, const RunContext& context) {
  query_.emplace(query);
  context_.emplace(context);
  if (stream_ > 0) context_->rng = context.rng.fork(stream_);
  search_ = planner_->start(*query_, *context_);
}

SearchStatus MemberSearch::run(const Budget& portion) {
  const SearchStatus status = search_->run(portion);
  last_ = search_->result();
  ended_ = status != SearchStatus::paused;
  return status;
}

void MemberSearch::reset() {
  search_.reset();
  context_.reset();
  query_.reset();
  last_ = PathResult::failure(Outcome::depth_limit);
  ended_ = false;
}

}  // namespace dismantle::portfolio
