/// The part of a plan whose steps can be put in another order: single parts and groups that leave one group for good.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "blocking_graph/relations.h"
#include "blocking_graph/unit_extents.h"
#include "dismantle/ordering/order_search.h"
#include "dismantle/sequence_planner.h"

namespace dismantle::order {

/// A check threw.
struct CheckFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a check says of a step, without its weight; kForbidden: it is required, and does not allow the step.
/// \throws CheckFailed
double cost_by(const ObjectiveItem& item, const StepQuestion& question, Objective::Ask ask, const RunContext& context);

constexpr double kPreference = 1e-7;  ///< of a direction, by one degree; far below all costs of checks

/// What all segments of a plan share.
struct OrderScene {
  const SequenceQuery& query;
  PathOracle& oracle;
  RunContext& context;
  const blocking::PairSweep* sweep;  ///< null: an oracle without geometry
  const blocking::Directions& directions;
  std::vector<std::size_t> everywhere;  ///< directions that are tried for each part: the axes, and those of the plan
  std::vector<std::optional<Eigen::Vector3d>> ups;  ///< how the whole may lie; the first: as drawn
  Effort& sweeps;                                   ///< pairs of parts that may be tested
};

/// How units leave.
struct Motion {
  std::vector<PartId> parts;                            ///< ascending
  std::optional<std::size_t> direction;                 ///< straight, along this one of OrderScene::directions
  const Removal* planned = nullptr;                     ///< the path of this step of the first plan
  Eigen::Vector3d insertion = Eigen::Vector3d::Zero();  ///< unit: direction of its last stretch, as assembly
};

/// Is the path a translation of each part along one line?
bool is_straight(const Path& path);

class Segment final : public Problem {
 public:
  /// `start`: the group; `planned`: its steps in the order of the first plan. All references must outlive this.
  Segment(OrderScene& scene, std::vector<PlacedPart> start, std::vector<const Removal*> planned);
  struct ToTarget {};
  /// For the way to one part: all units can leave, straight or, alone or together, as in a planned step. `planned`:
  /// steps out of `start`, one after the other.
  Segment(OrderScene& scene, std::vector<PlacedPart> start, std::vector<const Removal*> planned, ToTarget);

  std::size_t units() const override { return parts_.size(); }
  const std::vector<VariantId>& variants_of(std::size_t unit) const override { return of_unit_[unit]; }
  bool leaves_alone(std::size_t unit) const override { return !in_group_.contains(unit); }
  const UnitSet& leaving(VariantId v) const override { return moves_[variants_[v].move].units; }
  bool may_leave(VariantId v, const UnitSet& present) override;
  const UnitSet& blocking(VariantId v) override;
  double cost(VariantId v, const UnitSet& rest, VariantId previous) override;
  double least(VariantId v) const override { return least_[v] + preference_[v]; }
  std::uint64_t classes(VariantId v) const override { return std::uint64_t{1} << class_of_[v]; }
  double change() const override { return change_; }
  bool alike(VariantId a, VariantId b) const override { return class_of_[a] == class_of_[b]; }

  /// Like cost() without a previous variant, with what the checks say instead of their estimates.
  double verdict(VariantId v, const UnitSet& rest);

  /// The whole segment.
  Task task() const;
  /// The steps of the first plan.
  std::vector<VariantId> as_planned() const;
  std::size_t unit_of(PartId part) const { return unit_of_.at(part); }
  const Motion& motion(VariantId v) const { return moves_[variants_[v].move].motion; }
  const std::optional<Eigen::Vector3d>& up(VariantId v) const { return scene_.ups[variants_[v].up]; }
  const std::vector<PlacedPart>& start() const { return start_; }
  /// Orders that cost the same by the checks differ a little: along an axis is better than along none, from above
  /// better than from the side, and that better than from below. This is the part of cost() that says so, for an order.
  double preference(const std::vector<VariantId>& order) const;
  /// No order has a larger one.
  double most_preference() const;
  /// The motion of the variant is not possible while these parts are there, whatever the sweeps said. Empty: never.
  void forbid(VariantId v, const std::vector<PartId>& blocked_by);
  /// False: cost() is an estimate, because a check reads the path, or gives estimates.
  bool exact() const { return exact_; }
  /// The sweeps did not suffice, and what is not known was taken to be in the way.
  bool unsure() const { return unsure_; }

 private:
  struct Move {
    Motion motion;
    UnitSet units;
    UnitSet free, blocking;               ///< units that are known not to be in the way, or to be
    UnitSet unknown;                      ///< for which no sweep is left: taken to be in the way
    UnitSet needs;                        ///< as blocking(): these, and those that have to leave before
    std::vector<std::vector<Pose>> path;  ///< of a planned step: until it is apart from all of the start
    std::size_t course = 0;               ///< number of the direction of insertion
    bool knows_far = false;               ///< `free` has all units that it passes at a distance
  };
  struct Variant {
    std::size_t move = 0, up = 0;
  };
  struct CostKey {
    VariantId variant;
    std::size_t memory;
    UnitSet rest;
    bool operator==(const CostKey&) const = default;
  };
  struct CostHash {
    std::size_t operator()(const CostKey& k) const { return (k.rest.hash() * 31 + k.variant) * 31 + k.memory; }
  };
  struct Item {
    const ObjectiveItem* item;
    StepCheckTraits traits;
    std::unordered_map<CostKey, double, CostHash> known;
  };

  void prepare();
  void add_kept_units();
  void add_units(const std::vector<const Removal*>& planned);
  void add_moves(const std::vector<const Removal*>& planned);
  void add_planned(const Removal* planned, const UnitSet& present);
  void add_straight(std::size_t unit);
  void add(Move move);
  void add_variants();
  void find_bounds();
  bool is_in_the_way(Move& move, std::size_t unit);
  void extend(Move& move);
  std::size_t memory(const Item& item, VariantId v) const;
  double judge(const Item& item, VariantId v, const UnitSet& rest, VariantId previous,
               Objective::Ask ask = &StepCheck::estimate);
  const std::vector<PlacedPart>& present(const UnitSet& rest);
  double length_out(const Move& move, const UnitSet& rest);

  OrderScene& scene_;
  std::vector<PlacedPart> start_;
  std::vector<std::vector<PlacedPart>> parts_;  // by unit
  std::map<PartId, std::size_t> unit_of_;
  UnitSet stay_;                     // units that the first plan does not remove
  UnitSet in_group_;                 // units that a planned step removes together with others
  bool one_left_ = false;            // any other unit may be the one that stays
  std::vector<UnitSet> needs_gone_;  // by unit: constraints.before
  std::vector<Move> moves_;
  std::vector<Variant> variants_;
  std::vector<std::vector<VariantId>> of_unit_;
  std::vector<VariantId> planned_;
  std::vector<Eigen::Vector3d> courses_;
  std::vector<Item> items_;
  std::vector<double> least_, preference_;  // by variant
  std::vector<std::size_t> class_of_;
  double change_ = 0;
  bool exact_ = true, unsure_ = false;
  blocking::Orientations orientations_;
  std::unique_ptr<blocking::Relations> relations_;
  std::vector<blocking::ExtentTable> extents_;                 // by direction
  std::vector<std::pair<PlacedPart, std::size_t>> with_unit_;  // the parts, ascending, each with its unit
  UnitSet present_of_;
  std::vector<PlacedPart> present_;
};

}  // namespace dismantle::order
