#include <algorithm>
#include <cmath>
#include <limits>

#include "dismantle/plugin.h"
#include "forest.h"

namespace dismantle::tunnel_forest {
namespace {

constexpr Capabilities kNeeds{.dynamics = true, .distance = true};
/// Simulated steps of the first turn of a forest where two grow in turn.
constexpr std::uint64_t kFirstTurn = 10'000;
/// A forest that has seen more of its space by this share in a turn gets twice as long a next one.
constexpr double kFruitful = 1.2;

class TunnelForest final : public PathPlanner {
 public:
  explicit TunnelForest(const Parameters& parameters) : parameters_(parameters) {}
  Capabilities needs() const noexcept override { return kNeeds; }

  PathResult plan(const PathQuery& query, RunContext& context) override {
    PathResult result;
    const Capabilities has = query.simulator.capabilities();
    if (!has.dynamics || !has.distance || has.max_moving < query.cast.moving.size()) {
      result.outcome = Outcome::unsupported;
      result.message = "needs a simulator with dynamics and distances for all moving parts";
      return result;
    }
    return Search(parameters_, query, context).run();
  }

 private:
  struct Grown {
    std::unique_ptr<Forest> forest;
    std::uint64_t turn = kFirstTurn;
    std::size_t cells = 0;
    bool relaxed = false;
  };

  class Search {
   public:
    Search(const Parameters& parameters, const PathQuery& query, RunContext& context)
        : parameters_(parameters),
          query_(query),
          context_(context),
          deadline_(query.effort.timeout > 0 ? context.deadline.earlier(Deadline::after_seconds(query.effort.timeout))
                                             : context.deadline) {}

    PathResult run() {
      if (parameters_.motion != Motion::rotation) add(MotionSpace::translation, 1);
      if (parameters_.motion != Motion::translation) add(MotionSpace::rigid, 2);
      if (forests_.front().forest->starts_out()) {
        result_.outcome = Outcome::start_is_goal;
        result_.path = {forests_.front().forest->farthest(), forests_.front().forest->farthest()};
        return result_;
      }
      level_ = level_limit();
      bool solved = false;
      while (!solved && !over() && used() < level_)
        for (Grown& grown : forests_) {
          if (over()) break;
          solved = take_turn(grown);
          if (solved) break;
        }
      if (!solved) say_why();
      finish();
      return result_;
    }

   private:
    void add(MotionSpace motion, std::uint64_t stream) {
      forests_.push_back({std::make_unique<Forest>(query_, motion, parameters_, context_.rng.fork(stream),
                                                   [this] { return halted(); })});
    }

    bool take_turn(Grown& grown) {
      const std::uint64_t end = std::min(level_, used() + grown.turn);
      const auto stop = [&] { return used() >= end || stopped(); };
      bool solved = false;
      // Extensions that are stopped at once, as where nothing can move, need a count of their own.
      for (std::uint64_t k = 0; !solved && !stop() && !given_up() && k < grown.turn; ++k)
        solved = grown.forest->iterate(result_, stop);
      if (grown.forest->cells() > kFruitful * static_cast<double>(grown.cells)) grown.turn *= 2;
      grown.cells = grown.forest->cells();
      if (!grown.relaxed) grown.forest->relax();
      grown.relaxed = true;
      return solved;
    }

    std::uint64_t used() const {
      std::uint64_t steps = 0;
      for (const auto& g : forests_) steps += g.forest->steps();
      return steps;
    }
    bool halted() const { return context_.cancel.cancelled() || deadline_.passed(); }
    bool stopped() const { return halted() || (query_.effort.max_steps > 0 && used() >= query_.effort.max_steps); }
    bool given_up() const {
      return std::any_of(forests_.begin(), forests_.end(), [&](const Grown& g) {
        return g.forest->refused() >= static_cast<std::uint64_t>(parameters_.max_refusals);
      });
    }
    bool over() const { return stopped() || given_up(); }

    std::uint64_t level_limit() const {
      constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
      if (query_.effort.max_depth == 0) return kNone;
      const double steps = std::ldexp(static_cast<double>(parameters_.level_steps),
                                      static_cast<int>(std::min(query_.effort.max_depth, 60u)) - 1);
      return steps < 1e18 ? static_cast<std::uint64_t>(steps) : kNone;
    }

    void say_why() {
      result_.outcome = context_.cancel.cancelled() ? Outcome::cancelled
                        : stopped()                 ? Outcome::timeout
                        : given_up()                ? Outcome::exhausted
                                                    : Outcome::depth_limit;
      const auto& best = *std::max_element(forests_.begin(), forests_.end(), [](const Grown& a, const Grown& b) {
        return a.forest->farthest_way() < b.forest->farthest_way();
      });
      result_.best_pose = best.forest->farthest();
    }

    void finish() {
      std::map<PartId, std::uint64_t> touched;
      for (const auto& g : forests_) {
        result_.counts["nodes"] += static_cast<double>(g.forest->size());
        result_.counts["steps"] += static_cast<double>(g.forest->steps());
        result_.counts["looks"] += static_cast<double>(g.forest->looks());
        result_.counts["tunnels"] += static_cast<double>(g.forest->tunnels());
        result_.counts["refused"] += static_cast<double>(g.forest->refused());
        for (const auto& [part, times] : g.forest->touched()) touched[part] += times;
      }
      std::vector<std::pair<std::uint64_t, PartId>> order;
      for (const auto& [part, times] : touched) order.emplace_back(times, part);
      std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
      });
      for (const auto& o : order)
        if (std::none_of(query_.cast.moving.begin(), query_.cast.moving.end(),
                         [&](const PlacedPart& m) { return m.part == o.second; }))
          result_.blocked_by.push_back(o.second);
    }

    const Parameters& parameters_;
    const PathQuery& query_;
    RunContext& context_;
    Deadline deadline_;
    PathResult result_;
    std::vector<Grown> forests_;
    std::uint64_t level_ = 0;
  };

  Parameters parameters_;
};

}  // namespace
}  // namespace dismantle::tunnel_forest

DISMANTLE_PLUGIN("dismantle.tunnel_forest", DISMANTLE_VERSION, "MIT", "") {
  r.add<dismantle::PathPlanner, dismantle::tunnel_forest::TunnelForest, dismantle::tunnel_forest::Parameters>(
      "tunnel_forest", "Trees from the start and from narrow places that match, grown along contact, and joined.",
      {.source = "Zhang and Manocha 2008 (retraction), Zhang et al. 2020 (tunnels); see its README",
       .needs = dismantle::tunnel_forest::kNeeds});
}
