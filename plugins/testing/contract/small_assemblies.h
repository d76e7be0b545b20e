/// Small samples for the contract tests of simulators and path planners.
#pragma once

#include <algorithm>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "dismantle/plan.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/path_checking.h"
#include "selection.h"

namespace dismantle {

// What is compared in words, for authors who see that it differs.
inline void PrintTo(Outcome outcome, std::ostream* out) { *out << "'" << to_string(outcome) << "'"; }
inline void PrintTo(const SearchStats& stats, std::ostream* out) {
  for (const auto& [name, value] : stats.by_name()) *out << name << " " << value << ", ";
}

}  // namespace dismantle

namespace dismantle::contract {

using Eigen::Vector3d;

/// The tolerance of all laws, assembly units: the loosest that a plan may have, so that plugins made for it pass.
inline constexpr double kTolerance = kLargestTolerance;

/// A sample, its largest edge scaled to 3 assembly units, and a part of it that can leave first.
struct Small {
  std::string name;
  PartId leaves = 0;
  Assembly assembly;
  std::unique_ptr<Verifier> verifier;

  Small(const std::string& sample, const ParamSet& given, const std::string& part) : name(sample) {
    PrepareOptions options;
    options.size = 3;
    RunContext context;
    PrepareReport report;
    assembly = prepare_assembly(samples::make(sample, given), sample, "", options, context, report);
    for (const auto& p : assembly.parts)
      if (p.name == part) leaves = p.id;
    verifier = std::make_unique<Verifier>(assembly, VerifyOptions{.max_penetration = kTolerance});
  }
  Scene scene() const { return cast_of({leaves}); }
  /// Parts `moving` in assembled position, all others fixed.
  Scene cast_of(const std::vector<PartId>& moving) const {
    Scene c;
    for (const PartId id : moving) c.moving.push_back({id, Pose{}});
    for (const auto& p : assembly.parts)
      if (std::find(moving.begin(), moving.end(), p.id) == moving.end()) c.fixed.push_back({p.id, Pose{}});
    return c;
  }
};

inline const std::vector<Small>& small_assemblies() {
  static const std::vector<Small> all = [] {
    std::vector<Small> list;
    list.emplace_back("peg_in_hole", ParamSet{{"shape", std::string("square")}, {"clearance", 0.4}}, "peg");
    list.emplace_back("l_slot", ParamSet{{"clearance", 0.4}}, "slider");
    list.emplace_back("stacked_box", ParamSet{{"count", std::int64_t{2}}}, "lid");
    return list;
  }();
  return all;
}

inline bool bitwise(const Pose& a, const Pose& b) { return a.t == b.t && a.q.coeffs() == b.q.coeffs(); }

}  // namespace dismantle::contract
