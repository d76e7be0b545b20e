/// The motions by which parts of an assembly can leave, and what is in their way.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <unordered_map>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/constraints.h"
#include "dismantle/disassembly.h"
#include "dismantle/ordering/order_search.h"
#include "dismantle/run_context.h"
#include "dismantle/step_check.h"
#include "dismantle/verification/verifier.h"

namespace dismantle {

/// Direction of the last stretch of a removal, unit; zero: a rotation in place.
Eigen::Vector3d last_direction(const Path& path);

/// Units are parts, or parts that are kept together. Pairs are tested when they are asked about, and remembered.
class Removals final : public order::Problem {
 public:
  Removals(const Assembly& assembly, const Disassembly& plan, const Constraints& constraints,
           const Objective& objective, const Verifier& verifier, const RunContext& context);

  std::size_t units() const override { return parts_.size(); }
  const std::vector<order::VariantId>& variants_of(std::size_t unit) const override { return of_unit_[unit]; }
  bool leaves_alone(std::size_t unit) const override { return !in_group_.contains(unit); }
  const order::UnitSet& leaving(order::VariantId v) const override { return motions_[v].units; }
  bool may_leave(order::VariantId v, const order::UnitSet& present) override;
  const order::UnitSet& blocking(order::VariantId v) override;
  double cost(order::VariantId v, const order::UnitSet& rest, order::VariantId previous) override;
  double least(order::VariantId v) const override { return by_objective_ ? kStep + motions_[v].least : 1; }
  std::uint64_t classes(order::VariantId /*v*/) const override { return 0; }
  double change() const override { return 0; }
  bool alike(order::VariantId a, order::VariantId b) const override;
  bool remembers() const override;

  /// Each step costs 1; or kStep, and what the objective says of it.
  void use_objective(bool on) { by_objective_ = on; }
  static constexpr double kStep = 1e4;

  std::size_t unit_of(PartId part) const { return unit_of_[part]; }
  const std::vector<PartId>& parts_of(std::size_t unit) const { return parts_[unit]; }
  std::vector<PartId> leaving_parts(order::VariantId v) const;
  /// Unit, of the last stretch; zero: a rotation.
  const Eigen::Vector3d& direction(order::VariantId v) const { return motions_[v].out; }
  /// Does the verifier confirm the step? If not, it is not proposed again.
  bool confirm(order::VariantId v, const order::UnitSet& present);
  /// False: a step was refused. It is then taken for blocked by all that was present, which may be too much.
  bool exact() const { return exact_; }

 private:
  struct Motion {
    order::UnitSet units;
    order::UnitSet free, blocking;  // units that are known not to be in the way, or to be
    order::UnitSet needs;           // blocking(): these, and those that have to leave before
    std::vector<PartId> parts;      // ascending: columns of the path
    Path path;
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    bool straight = true;  // as far as it takes: each pair that passes is apart in the end
    double least = 0;      // of its cost by the objective
  };
  struct CostKey {
    std::size_t item;
    order::VariantId variant, previous;
    order::UnitSet rest;
    bool operator==(const CostKey&) const = default;
  };
  struct CostHash {
    std::size_t operator()(const CostKey& k) const {
      return ((k.rest.hash() * 31 + k.variant) * 31 + k.previous) * 31 + k.item;
    }
  };

  void add_units();
  void add_planned(const Disassembly& plan);
  void add_straight(std::size_t unit, const std::vector<Eigen::Vector3d>& used);
  void add(Motion motion);
  void find_least();
  bool obstructs(const Motion& motion, std::size_t unit) const;
  bool meets(const Motion& motion, std::size_t column, PartId other) const;
  StepVerdict judge(const ObjectiveItem& item, order::VariantId v, const order::UnitSet& rest,
                    order::VariantId previous) const;
  std::vector<PlacedPart> placed(const order::UnitSet& units) const;

  const Assembly& assembly_;
  const Constraints& constraints_;
  const Objective& objective_;
  const Verifier& verifier_;
  const RunContext& context_;
  double far_ = 1;  // after so far, everything is apart
  std::vector<std::vector<PartId>> parts_;
  std::vector<std::size_t> unit_of_;
  std::vector<order::UnitSet> needs_gone_;  // by unit: constraints.before
  order::UnitSet in_group_;
  std::vector<Motion> motions_;
  std::vector<std::vector<order::VariantId>> of_unit_;
  bool by_objective_ = false, exact_ = true;
  std::unordered_map<CostKey, double, CostHash> costs_;
};

}  // namespace dismantle
