#include "mcts/knowledge.h"

#include <algorithm>
#include <cmath>

namespace dismantle::mcts {

std::vector<PartId> Knowledge::open() const {
  std::vector<PartId> parts;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (!parts_[k].gone && !parts_[k].closed) parts.push_back(static_cast<PartId>(k));
  return parts;
}

void Knowledge::removed(PartId part, double cost) {
  ++asked_, ++successes_;
  spent_ += cost;
  imagine_removal(part);
}

void Knowledge::imagine_removal(PartId part) {
  parts_[part].gone = true;
  --left_;
  for (PartKnowledge& other : parts_) other.closed = false;
}

void Knowledge::failed(PartId part, Outcome outcome, const std::vector<PartId>& blocked_by, double cost) {
  ++asked_;
  spent_ += cost;
  PartKnowledge& p = parts_[part];
  p.cost = cost;
  p.blockers = blocked_by;
  p.left = left_;
  p.limited = outcome == Outcome::depth_limit && p.depth != max_depth_;
  p.closed = !p.limited;
  if (p.limited) ++p.depth;
}

void Knowledge::imagine_failure(PartId part) {
  PartKnowledge& p = parts_[part];
  if (p.limited && p.depth != max_depth_) {
    ++p.depth;
    return;
  }
  if (p.left == 0) p.left = left_;
  p.closed = true;
}

double Knowledge::chance(PartId part) const {
  const PartKnowledge& p = parts_[part];
  const double rate = (successes_ + 1) / (asked_ + 2);
  if (p.left == 0) return rate;
  double gone = 0;
  if (p.blockers.empty())
    gone = static_cast<double>(p.left - left_) / static_cast<double>(p.left);
  else
    gone = static_cast<double>(
               std::count_if(p.blockers.begin(), p.blockers.end(), [&](PartId b) { return parts_[b].gone; })) /
           static_cast<double>(p.blockers.size());
  const double deeper = p.limited ? std::ldexp(1.0, 1 - static_cast<int>(std::min(p.depth, 60U))) : 0;
  return rate * (gone + (1 - gone) * deeper);
}

double Knowledge::cost(PartId part) const {
  const PartKnowledge& p = parts_[part];
  if (!(spent_ > 0) || !(p.cost > 0)) return 1;
  return (p.limited ? 2 : 1) * p.cost * asked_ / spent_;
}

}  // namespace dismantle::mcts
