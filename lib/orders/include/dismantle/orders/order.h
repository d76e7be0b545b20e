/// Orders of assembly: of plans, of the authors of models, of CSV files.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/plan.h"

namespace dismantle {

/// Parts that are put in at the same time, or in an order that is not stated.
struct OrderStep {
  std::vector<std::string> parts;
  std::optional<Eigen::Vector3d> direction{};  ///< unit, of the last stretch of the insertion; none: not known
  std::optional<Eigen::Vector3d> up{};         ///< unit; how the assembly lies; none: not known
  double travel = 0;                           ///< input units; 0: not known
  double turns = 0;                            ///< whole turns along the path
};

/// In the order of assembly. What is built apart stands where it is put in, step by step.
using Order = std::vector<OrderStep>;

/// The disassembly of the plan, backwards. What the plan leaves together is the first step.
DISMANTLE_API Order order_of(const Plan& plan);
/// The order of a model's author, sub-models in place of the step that puts them in.
DISMANTLE_API Order order_of(const std::vector<PlanReferenceStep>& reference);
/// A CSV file with a header and the columns `step` (a number), `part`, and maybe `direction` ("+z", "-x", "0 0 1").
/// Rows of one step number are one step. @throws InputError naming file and line.
DISMANTLE_API Order read_order(const std::filesystem::path& file);

/// How directions are written.
inline constexpr const char* kDirections = "+x, -z, or three numbers with blanks between";
/// The unit vector; none if the text is no direction.
DISMANTLE_API std::optional<Eigen::Vector3d> direction_named(const std::string& text);

/// Names of equal parts are mapped to one class; a part that is missing here is a class by itself.
using PartClasses = std::map<std::string, std::string>;
/// Parts of one product are equal.
DISMANTLE_API PartClasses classes_of(const PlanAssembly& assembly);

/// What a person notices about an order.
struct OrderMeasures {
  std::size_t steps = 0, parts = 0;
  std::size_t direction_changes = 0;  ///< between steps whose directions are known
  std::size_t off_axis = 0;           ///< steps along no coordinate axis (within 1 degree)
  std::size_t reorientations = 0;     ///< changes of `up`
  std::size_t torn = 0;               ///< interruptions between equal parts
  double travel = 0;                  ///< input units
  double turns = 0;                   ///< whole turns along the paths
};
DISMANTLE_API OrderMeasures measures_of(const Order& order, const PartClasses& classes);

}  // namespace dismantle
