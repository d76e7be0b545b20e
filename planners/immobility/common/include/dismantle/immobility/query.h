/// Accessors of a query that provers share: solids, depths, pairs, names.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/geometry/solid.h"
#include "dismantle/immobility/geometry_names.h"
#include "dismantle/immobility_prover.h"

namespace dismantle::immobility {

/// The closed shells of a part that is not open, computed once per assembly. Assembled frame.
const std::vector<Solid>& solids_of(const SeparationQuery& query, PartId part);

/// The penetration depth up to which motions of the pair have to be considered: the initial overlap and the query's
/// margin, enlarged by rounding. Assembly units, > 0.
double depth_allowed(const SeparationQuery& query, PartId a, PartId b);

/// The length that a proof gives away for rounding: 1e-4 of the tolerance. It also covers corners that are not exactly
/// in the plane of their face, as in files in single precision. Assembly units, > 0.
double slack_of(const SeparationQuery& query);

/// True if their boxes are no further apart than the tolerance. Parts further apart do not hold each other.
bool near_each_other(const SeparationQuery& query, PartId a, PartId b);

/// Proofs are about solids: what a part with an open surface encloses is not known, so nothing is proved about it.
bool is_open(const SeparationQuery& query, PartId part);
/// A part of the query is open.
bool any_open(const SeparationQuery& query);

/// The two parts of a query about a pair, in ascending order; nullopt when there are more, or one of them is open.
std::optional<std::pair<PartId, PartId>> pair_of(const SeparationQuery& query);

/// The pair in both orders.
std::array<std::pair<PartId, PartId>, 2> both_orders(const std::pair<PartId, PartId>& pair);

/// Diagonal of a part's box; assembly units.
double extent_of(const SeparationQuery& query, PartId part);

/// The part's name in quotes.
std::string name_of(const SeparationQuery& query, PartId part);
std::string names_of(const SeparationQuery& query, const std::vector<PartId>& parts);
/// A length in assembly units, converted to input units for messages.
double input_length(const SeparationQuery& query, double length);
/// "(x, y, z)" in input units, of a point of the assembled frame.
std::string position_text(const SeparationQuery& query, const Eigen::Vector3d& point);

inline std::vector<double> numbers_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace dismantle::immobility
