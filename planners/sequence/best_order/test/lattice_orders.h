/// Blocks on a lattice with prices of operations, and the cheapest of all their orders by a search of its own.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <bit>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "best_order/best_order.h"
#include "dismantle/testing/run_rig.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle::lattice {

inline const std::array<Eigen::Vector3d, 6> kAxes{Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(),
                                                  Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitY(),
                                                  Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitZ()};

/// Costs of an operation: of its direction, of a change of it, and of the number of parts that are there.
struct Prices {
  std::array<double, 6> direction{};
  double change = 1, present = 0;
  double of(PartId part, std::size_t insertion, std::size_t present_parts, std::optional<std::size_t> before) const {
    const double crowd = part % 2 == 0 ? present * static_cast<double>(present_parts) : 0;
    return direction[insertion] + crowd + (before && *before != insertion ? change : 0);
  }
};

inline std::size_t axis_of(const Eigen::Vector3d& direction) {
  std::size_t best = 0;
  for (std::size_t d = 1; d < 6; ++d)
    if (kAxes[d].dot(direction) > kAxes[best].dot(direction)) best = d;
  return best;
}

class Priced final : public StepCheck {
 public:
  explicit Priced(const Prices& prices) : prices_(prices) {}
  StepCheckTraits traits() const noexcept override {
    return {.remembers_direction = true, .reads_present = prices_.present > 0, .reads_path = false};
  }
  StepVerdict judge(const StepQuestion& q, const RunContext&) const override {
    std::optional<std::size_t> before;
    if (q.previous != nullptr) before = axis_of(q.previous->direction);
    StepVerdict verdict;
    verdict.cost = prices_.of(q.moving.front().part, axis_of(q.direction), q.present.size(), before);
    return verdict;
  }

 private:
  Prices prices_;
};

/// Blocks of cells on a lattice.
struct Lattice {
  static constexpr int kSize = 3;
  std::map<std::array<int, 3>, PartId> cells;
  PartId parts = 0;

  static Lattice random(Rng& rng) {
    Lattice lattice;
    lattice.parts = 3 + static_cast<PartId>(rng.below(4));
    std::set<PartId> used;
    for (int x = 0; x < kSize; ++x)
      for (int y = 0; y < kSize; ++y)
        for (int z = 0; z < 2; ++z)
          if (rng.uniform() < 0.85)
            used.insert(lattice.cells[{x, y, z}] = static_cast<PartId>(rng.below(lattice.parts)));
    return used.size() == lattice.parts ? lattice : random(rng);
  }

  Assembly assembly() const {
    std::vector<std::pair<std::string, std::vector<fake::Box>>> all(parts);
    for (PartId id = 0; id < parts; ++id) all[id].first = "p" + std::to_string(id);
    const Eigen::Vector3d gap = Eigen::Vector3d::Constant(0.05), one = Eigen::Vector3d::Ones();
    for (const auto& [at, id] : cells) {
      const Eigen::Vector3d lo(at[0], at[1], at[2]);
      all[id].second.push_back({lo + gap, lo + one - gap});
    }
    return fake::assembly_of(all);
  }

  /// Is a cell of `other` somewhere behind one of `part`, along the axis?
  bool blocks(PartId part, PartId other, std::size_t axis) const {
    for (const auto& [at, id] : cells) {
      if (id != part) continue;
      std::array<int, 3> next = at;
      for (int k = 0; k < kSize; ++k) {
        next[axis / 2] += axis % 2 == 0 ? 1 : -1;
        if (const auto cell = cells.find(next); cell != cells.end() && cell->second == other) return true;
      }
    }
    return false;
  }
};

/// The cheapest order of single parts, by all orders.
class AllOrders {
 public:
  AllOrders(const Lattice& lattice, const Prices& prices) : lattice_(lattice), prices_(prices) {}
  /// Of everything before the removal of `last` along `axis` was done, which left `present` behind.
  double cheapest(unsigned present, std::optional<std::pair<PartId, std::size_t>> last) {
    const auto key = std::pair(present, last);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    const auto settled = [&](std::optional<std::size_t> next) {
      return last ? prices_.of(last->first, last->second ^ 1U, static_cast<std::size_t>(std::popcount(present)),
                               next ? std::optional<std::size_t>(*next ^ 1U) : std::nullopt)
                  : 0;
    };
    double best = std::numeric_limits<double>::infinity();
    if (std::popcount(present) == 1) best = settled(std::nullopt);
    for (PartId id = 0; id < lattice_.parts && std::popcount(present) > 1; ++id)
      for (std::size_t axis = 0; axis < 6 && (present >> id & 1U) != 0; ++axis) {
        bool free = true;
        for (PartId other = 0; other < lattice_.parts; ++other)
          free = free && (other == id || (present >> other & 1U) == 0 || !lattice_.blocks(id, other, axis));
        if (free) best = std::min(best, settled(axis) + cheapest(present & ~(1U << id), std::pair(id, axis)));
      }
    return known_[key] = best;
  }

 private:
  const Lattice& lattice_;
  const Prices& prices_;
  std::map<std::pair<unsigned, std::optional<std::pair<PartId, std::size_t>>>, double> known_;
};

/// The plan of best_order around `inner`, which is checked.
inline RunResult plan_of(const Assembly& assembly, const Objective& objective, std::shared_ptr<SequencePlanner> inner,
                         double effort, const RunOptions& options = {}, RunContext context = {}) {
  BestOrderParameters params;
  params.effort = effort;
  params.of = {PluginChoice{"inner", {}, {}},
               [inner](PluginKind, const PluginChoice&) -> std::shared_ptr<void> { return inner; }};
  PlanningSetup setup = fake::setup(fake::push, std::make_shared<BestOrder>(params));
  setup.objective = objective;
  RunResult result = run(assembly, setup, options, context);
  const PlanCheck check = check_plan(result.plan, assembly, options.verify, context, {});
  EXPECT_TRUE(check.valid) << (check.problems.empty() ? "" : check.problems.front().message);
  return result;
}

inline Objective priced(const Prices& prices) { return {{{"priced", std::make_shared<Priced>(prices), 1, false}}}; }

}  // namespace dismantle::lattice
