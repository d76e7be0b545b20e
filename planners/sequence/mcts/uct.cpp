#include "mcts/uct.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace dismantle::mcts {
namespace {

struct Node;

/// A search below a node.
struct Branch {
  explicit Branch(PartId id) : part(id) {}
  PartId part;
  std::uint64_t visits = 0;
  double sum = 0;
  std::unique_ptr<Node> after[2];  // by result: failed, succeeded
};

struct Node {
  std::uint64_t visits = 0;
  std::vector<Branch> branches;
};

class Simulation {
 public:
  Simulation(const Knowledge& knowledge, const UctSettings& settings, Rng& rng)
      : knowledge_(knowledge), settings_(settings), rng_(rng), possible_(static_cast<double>(knowledge.left()) - 1) {}

  double run(Node& root) {
    descend(root);
    while (!ended()) ask(draw());
    return value();
  }

 private:
  bool ended() {
    if (knowledge_.left() <= 1 || asked_ == settings_.horizon) return true;
    open_ = knowledge_.open();
    return open_.empty();
  }

  /// Simulates a search. True: the part left.
  bool ask(PartId part) {
    ++asked_;
    spent_ += knowledge_.cost(part);
    if (rng_.uniform() >= knowledge_.chance(part)) {
      knowledge_.imagine_failure(part);
      return false;
    }
    knowledge_.imagine_removal(part);
    sum_ += std::pow(settings_.discount, spent_);
    return true;
  }

  double value() const { return possible_ > 0 ? sum_ / possible_ : 0; }

  /// Draws an open part in proportion to its probability of success. No weight is 0, so that every part can be drawn.
  PartId draw() {
    const auto weight = [this](PartId p) { return std::max(1e-3, knowledge_.chance(p)); };
    double total = 0;
    for (const PartId p : open_) total += weight(p);
    double at = rng_.uniform() * total;
    for (const PartId p : open_) {
      at -= weight(p);
      if (at < 0) return p;
    }
    return open_.back();
  }

  /// Descends the tree, adds one node, completes the simulation, and backs its value up.
  void descend(Node& node) {
    if (ended()) return;
    if (node.branches.empty())
      for (const PartId p : open_) node.branches.emplace_back(p);
    Branch& branch = best(node);
    ++node.visits;
    const bool is_new = branch.visits++ == 0;
    const bool left = ask(branch.part);
    if (is_new) {
      while (!ended()) ask(draw());
    } else {
      auto& next = branch.after[left ? 1 : 0];
      if (!next) next = std::make_unique<Node>();
      descend(*next);
      while (!ended()) ask(draw());
    }
    branch.sum += value();
  }

  Branch& best(Node& node) const {
    Branch* best = nullptr;
    double most = 0;
    for (Branch& b : node.branches) {
      if (b.visits == 0) return b;
      const auto visits = static_cast<double>(b.visits);
      const double bound =
          b.sum / visits + settings_.exploration * std::sqrt(std::log(static_cast<double>(node.visits)) / visits);
      if (best == nullptr || bound > most) most = bound, best = &b;
    }
    return *best;
  }

  Knowledge knowledge_;
  const UctSettings& settings_;
  Rng& rng_;
  double possible_, spent_ = 0, sum_ = 0;
  unsigned asked_ = 0;
  std::vector<PartId> open_;
};

}  // namespace

std::vector<Choice> choose(const Knowledge& knowledge, const UctSettings& settings, Rng& rng) {
  Node root;
  std::vector<Choice> choices;
  const std::vector<PartId> open = knowledge.open();
  if (open.size() == 1) return {{open.front(), 0, 0}};
  for (std::int64_t k = 0; k < settings.simulations; ++k) Simulation(knowledge, settings, rng).run(root);
  for (const PartId part : open) {
    const auto branch =
        std::find_if(root.branches.begin(), root.branches.end(), [&](const Branch& b) { return b.part == part; });
    Choice choice{part, 0, 0};
    if (branch != root.branches.end() && branch->visits > 0)
      choice = {part, branch->visits, branch->sum / static_cast<double>(branch->visits)};
    choices.push_back(choice);
  }
  std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
    return a.visits != b.visits ? a.visits > b.visits : a.value > b.value;
  });
  return choices;
}

}  // namespace dismantle::mcts
