#include "dismantle/ordering/order_search.h"

#include <algorithm>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "dismantle/ordering/target_bound.h"

namespace dismantle::order {

namespace {

bool is_done(const Task& task, const UnitSet& left) {
  switch (task.end) {
    case End::one_left:
      return left.size() <= 1;
    case End::exactly:
      return left == task.goal;
    case End::target:
      return !left.contains(task.target) || left.size() <= 1;
  }
  return true;
}

/// May the variant be a step of the task?
bool fits(const Task& task, const UnitSet& leaving, const UnitSet& left) {
  if (!left.includes(leaving) || leaving == left) return false;
  switch (task.end) {
    case End::one_left:
      return true;
    case End::exactly:
      return !leaving.intersects(task.goal);
    case End::target:
      return task.bound->useful().includes(leaving) && (!leaving.contains(task.target) || leaving.size() == 1);
  }
  return false;
}

/// The units whose variants may be steps of the task.
UnitSet candidates(const Task& task, const UnitSet& left) {
  UnitSet units = left;
  if (task.end == End::target) units &= task.bound->useful();
  if (task.end == End::exactly) units -= task.goal;
  return units;
}

struct Key {
  UnitSet left;
  VariantId last;
  bool operator==(const Key&) const = default;
};
struct KeyHash {
  std::size_t operator()(const Key& k) const { return k.left.hash() * 31 + k.last; }
};

struct Node {
  UnitSet left;
  VariantId last = kNone;
  double cost = 0;  // of all steps before the last
  std::size_t parent = 0;
};

std::vector<VariantId> unwind(const std::vector<Node>& nodes, std::size_t node) {
  std::vector<VariantId> order;
  for (; node != 0; node = nodes[node].parent) order.push_back(nodes[node].last);
  std::reverse(order.begin(), order.end());
  return order;
}

/// Cost of the last step, which is settled when the next is known.
double settled(Problem& problem, const Node& node, VariantId next) {
  return node.last == kNone ? 0 : problem.cost(node.last, node.left, next);
}

}  // namespace

bool is_feasible(Problem& problem, const Task& task, const std::vector<VariantId>& order) {
  UnitSet left = task.start;
  for (const VariantId v : order) {
    if (!fits(task, problem.leaving(v), left) || !problem.may_leave(v, left)) return false;
    left -= problem.leaving(v);
  }
  return is_done(task, left);
}

double cost_of(Problem& problem, const Task& task, const std::vector<VariantId>& order) {
  Node state{task.start, task.last, 0, 0};
  for (const VariantId v : order) {
    state.cost += settled(problem, state, v);
    state.left = state.left - problem.leaving(v);
    state.last = v;
  }
  return state.cost + settled(problem, state, task.next);
}

/// What lower_bound() sums up: for each unit, which does not change during a search.
class BoundTerms {
 public:
  explicit BoundTerms(Problem& problem) : problem_(problem), change_(problem.change()) {
    for (std::size_t u = 0; u < problem.units(); ++u) {
      Term term;
      if (problem.leaves_alone(u))
        for (const VariantId v : problem.variants_of(u)) {
          term.least = std::min(term.least, problem.least(v));
          term.own |= problem.classes(v);
        }
      counts_.push_back(term.least < kForbidden);  // else it can only be the one that stays
      if (counts_.back() && term.own != 0) by_classes_.push_back(u);
      terms_.push_back(term);
    }
    std::sort(by_classes_.begin(), by_classes_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(std::popcount(terms_[a].own), terms_[a].own) <
             std::pair(std::popcount(terms_[b].own), terms_[b].own);
    });
  }

  /// Each unit that has to leave alone costs at least its cheapest variant. Such units of which no two have a common
  /// class need as many changes of the class as there are, less one.
  double bound(const Task& task, const UnitSet& left, VariantId last) const {
    double sum = last == kNone ? 0 : problem_.least(last), most = 0;
    if (task.end == End::target) return sum + (is_done(task, left) ? 0 : task.bound->of(left));
    const std::size_t may_stay = task.end == End::one_left ? 1 : 0;
    const UnitSet units = candidates(task, left);
    units.each([&](std::size_t u) {
      if (!counts_[u]) return;
      sum += terms_[u].least;
      most = std::max(most, terms_[u].least);
    });
    if (task.end == End::one_left) sum -= most;
    if (change_ <= 0) return sum;
    std::uint64_t taken = last == kNone ? 0 : problem_.classes(last);
    std::size_t apart = last == kNone ? 0 : 1;
    for (const std::size_t u : by_classes_)
      if ((terms_[u].own & taken) == 0 && units.contains(u)) {
        taken |= terms_[u].own;
        ++apart;
      }
    const std::size_t sure = apart > may_stay + 1 ? apart - may_stay - 1 : 0;
    return sum + static_cast<double>(sure) * change_;
  }

 private:
  struct Term {
    double least = kForbidden;
    std::uint64_t own = 0;
  };
  Problem& problem_;
  double change_;
  std::vector<Term> terms_;  // by unit
  std::vector<char> counts_;
  std::vector<std::size_t> by_classes_;  // units, those with few classes first
};

double lower_bound(Problem& problem, const Task& task, const UnitSet& left, VariantId last) {
  return BoundTerms(problem).bound(task, left, last);
}

BestFirst best_first(Problem& problem, const Task& task, double known, Effort& effort) {
  BestFirst answer;
  const BoundTerms terms(problem);
  std::vector<Node> nodes{{task.start, task.last, 0, 0}};
  std::unordered_map<Key, double, KeyHash> seen;
  // States are told apart by their last step if costs depend on it.
  const auto key_of = [&](const Node& n) { return Key{n.left, problem.remembers() ? n.last : kNone}; };
  const auto cost_to = [&](const Node& n) { return n.cost + (problem.remembers() ? 0 : settled(problem, n, kNone)); };
  // Lowest bound first; then the longest order, then the one found first.
  using Entry = std::tuple<double, std::size_t, std::size_t, bool>;  // bound, units left, node, is it finished?
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(terms.bound(task, task.start, task.last), task.start.size(), 0, false);
  while (!open.empty()) {
    const auto [f, size, at, finished] = open.top();
    if (f >= known - kSame) break;
    answer.bound = std::max(answer.bound, f);
    if (finished) {
      answer.best = {unwind(nodes, at), f};
      answer.complete = true;
      return answer;
    }
    open.pop();
    const Node node = nodes[at];
    if (const auto best = seen.find(key_of(node)); best != seen.end() && best->second < cost_to(node) - kSame) continue;
    if (is_done(task, node.left)) {
      const double total = node.cost + settled(problem, node, task.next);
      if (total < known - kSame) open.emplace(total, 0, at, true);
      continue;
    }
    bool stopped = false;
    candidates(task, node.left).each([&](std::size_t u) {
      for (const VariantId v : problem.variants_of(u)) {
        if (stopped || !fits(task, problem.leaving(v), node.left) || !problem.may_leave(v, node.left)) continue;
        if (!effort.spend()) {
          stopped = true;
          return;
        }
        Node next{node.left - problem.leaving(v), v, node.cost + settled(problem, node, v), at};
        const double bound = std::max(f, next.cost + terms.bound(task, next.left, v));
        if (bound >= known - kSame) continue;
        const double so_far = cost_to(next);
        const auto [entry, is_new] = seen.try_emplace(key_of(next), so_far);
        if (!is_new && entry->second <= so_far + kSame) continue;
        entry->second = so_far;
        open.emplace(bound, next.left.size(), nodes.size(), false);
        nodes.push_back(std::move(next));
      }
    });
    if (stopped) {
      answer.bound = std::min(f, known);
      return answer;
    }
  }
  answer.bound = known;  // nothing is cheaper
  answer.complete = true;
  return answer;
}

namespace {

constexpr std::size_t kAhead = 4;     // times the width of the beam: candidates of which the next step is looked at
constexpr std::uint64_t kFewest = 4;  // successors of a node

struct Candidate {
  Node node;
  double score = 0;
};

/// The variants that may leave, those first that are like the last one; at most `most`.
std::vector<VariantId> successors(Problem& problem, const Task& task, const Node& node, std::size_t most) {
  std::vector<VariantId> like, other;
  candidates(task, node.left).each([&](std::size_t u) {
    for (const VariantId v : problem.variants_of(u)) {
      std::vector<VariantId>& list = node.last != kNone && problem.alike(node.last, v) ? like : other;
      if (list.size() >= most || !fits(task, problem.leaving(v), node.left) || !problem.may_leave(v, node.left))
        continue;
      list.push_back(v);
    }
  });
  // Half of the places are for changes, so that a change can be found out to be worth it.
  const std::size_t kept = std::min(like.size(), most - std::min(other.size(), most / 2));
  like.resize(kept);
  like.insert(like.end(), other.begin(),
              other.begin() + static_cast<std::ptrdiff_t>(std::min(other.size(), most - kept)));
  return like;
}

/// What is left costs in the next step, beyond what that step costs at least: the cost of a step depends on what is
/// there before, which the steps that lead there do not show. By the first variant that may leave.
double ahead(Problem& problem, const Task& task, const Node& node) {
  double cost = 0;
  bool known = false;
  candidates(task, node.left).each([&](std::size_t u) {
    if (known) return;
    for (const VariantId v : problem.variants_of(u)) {
      if (!fits(task, problem.leaving(v), node.left) || !problem.may_leave(v, node.left)) continue;
      cost = std::max(0.0, problem.cost(v, node.left - problem.leaving(v), kNone) - problem.least(v));
      known = true;
      return;
    }
  });
  return cost;
}

}  // namespace

std::uint64_t least_effort(std::size_t units) { return units * (2 * kFewest + kAhead); }

Order beam(Problem& problem, const Task& task, Effort& effort) {
  const BoundTerms terms(problem);
  std::vector<Node> nodes{{task.start, task.last, 0, 0}};
  std::map<std::size_t, std::vector<std::size_t>, std::greater<>> layers{{task.start.size(), {0}}};
  Order best;
  while (!layers.empty()) {
    const std::vector<std::size_t> layer = std::move(layers.begin()->second);
    // What is left of the effort is divided among the layers to come: in each, `width` nodes with `most` successors.
    const std::uint64_t each = effort.left / std::max<std::uint64_t>(1, layers.begin()->first);
    const std::uint64_t most = std::clamp<std::uint64_t>(each / 8, kFewest, 48);
    const std::size_t width = static_cast<std::size_t>(std::clamp<std::uint64_t>(each / (2 * most + kAhead), 1, 64));
    layers.erase(layers.begin());
    std::unordered_map<Key, std::size_t, KeyHash> seen;
    std::vector<Candidate> found;
    for (const std::size_t at : layer) {
      if (is_done(task, nodes[at].left)) {
        const double total = nodes[at].cost + settled(problem, nodes[at], task.next);
        if (total < best.cost - kSame) best = {unwind(nodes, at), total};
        continue;
      }
      for (const VariantId v : successors(problem, task, nodes[at], most)) {
        if (!effort.spend(2)) return best;
        Candidate c{{nodes[at].left - problem.leaving(v), v, nodes[at].cost + settled(problem, nodes[at], v), at}};
        const double alone = problem.cost(v, c.node.left, kNone);
        c.score = c.node.cost + std::max(0.0, terms.bound(task, c.node.left, v) - problem.least(v)) + alone;
        if (!(c.score < kForbidden)) continue;
        const auto [entry, is_new] = seen.try_emplace({c.node.left, v}, found.size());
        if (is_new)
          found.push_back(std::move(c));
        else if (c.score < found[entry->second].score)
          found[entry->second] = std::move(c);
      }
    }
    // Of those that are as good so far, the ones that lead to less.
    const auto by_score = [](const Candidate& a, const Candidate& b) { return a.score < b.score - kSame; };
    std::stable_sort(found.begin(), found.end(), by_score);
    const auto looked_at = static_cast<std::ptrdiff_t>(std::min(found.size(), kAhead * width));
    for (auto c = found.begin(); c != found.begin() + looked_at; ++c) {
      if (!effort.spend()) return best;
      c->score += ahead(problem, task, c->node);
    }
    std::stable_sort(found.begin(), found.begin() + looked_at, by_score);
    // Layers of more units may have led here already: a step of several units skips layers.
    for (Candidate& c : found) {
      std::vector<std::size_t>& target = layers[c.node.left.size()];
      if (target.size() >= width) continue;
      target.push_back(nodes.size());
      nodes.push_back(std::move(c.node));
    }
  }
  return best;
}

void improve(Problem& problem, const Task& task, Order& order, Effort& effort) {
  constexpr std::size_t kWindow = 8;
  for (bool better = true; better && effort.left > 0;) {
    better = false;
    const std::size_t step = std::max<std::size_t>(1, std::min(kWindow, order.variants.size()) / 2);
    for (std::size_t first = 0; first < order.variants.size() && effort.left > 0; first += step) {
      const std::size_t n = order.variants.size(), last = std::min(n, first + kWindow);
      Task part{.start = task.start, .end = End::exactly, .last = task.last, .next = task.next};
      for (std::size_t k = 0; k < first; ++k) part.start = part.start - problem.leaving(order.variants[k]);
      part.goal = part.start;
      for (std::size_t k = first; k < last; ++k) part.goal = part.goal - problem.leaving(order.variants[k]);
      if (first > 0) part.last = order.variants[first - 1];
      if (last < n) part.next = order.variants[last];
      const auto from = order.variants.begin() + static_cast<std::ptrdiff_t>(first),
                 to = order.variants.begin() + static_cast<std::ptrdiff_t>(last);
      const double now = cost_of(problem, part, {from, to});
      Effort own{std::min<std::uint64_t>(effort.left, 4000), effort.stop};
      const std::uint64_t given = own.left;
      const BestFirst found = best_first(problem, part, now, own);
      effort.left -= std::min(effort.left, given - own.left + 1);
      if (!(found.best.cost < now - kSame)) continue;
      std::vector<VariantId> changed(order.variants.begin(), from);
      changed.insert(changed.end(), found.best.variants.begin(), found.best.variants.end());
      changed.insert(changed.end(), to, order.variants.end());
      order.variants = std::move(changed);
      better = true;
    }
  }
  order.cost = cost_of(problem, task, order.variants);
}

}  // namespace dismantle::order
