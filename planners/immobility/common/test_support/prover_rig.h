/// Queries about small assemblies, and the laws that every answer must obey.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/executor.h"
#include "dismantle/immobility_prover.h"
#include "dismantle/part_memo.h"
#include "dismantle/testing/held_shapes.h"
#include "dismantle/verification/check_certificate.h"
#include "dismantle/verification/verifier.h"

namespace dismantle::immobility {

class ProverRig {
 public:
  ProverRig(Assembly assembly, double tolerance) : assembly_(std::move(assembly)), tolerance_(tolerance) {}

  const Assembly& assembly() const { return assembly_; }

  SeparationQuery query(const std::vector<PlacedPart>& moving, const std::vector<PlacedPart>& fixed,
                        double share = 1) const {
    return {assembly_, moving, fixed, tolerance_, share, *memo_};
  }
  static std::vector<PlacedPart> assembled(const std::vector<PartId>& parts) {
    std::vector<PlacedPart> placed;
    for (const PartId id : parts) placed.push_back({id, Pose{}});
    return placed;
  }

  std::optional<Certificate> prove(const ImmobilityProver& prover, const std::vector<PartId>& moving,
                                   const std::vector<PartId>& fixed, double share = 1,
                                   const RunContext& context = {}) const {
    return prover.prove(query(assembled(moving), assembled(fixed), share), context);
  }

  /// Objection to the certificate, first part against the others, by the checker of the kind, else by the prover.
  std::string objection(const ImmobilityProver& prover, const std::string& kind, Certificate c,
                        double share = 1) const {
    std::vector<PlacedPart> moving, fixed;
    for (std::size_t i = 0; i < c.parts.size(); ++i)
      (i == 0 ? moving : fixed).push_back({c.parts[i], c.poses.empty() ? Pose{} : c.poses[i]});
    c.kind = kind;
    const SeparationQuery asked = query(moving, fixed, share);
    const auto independent = independent_objection(c, asked, {});
    return independent ? *independent : prover.objection(c, asked, {});
  }

  /// Forgets what was derived from the parts.
  ProverRig anew() const { return {assembly_, tolerance_}; }

 private:
  Assembly assembly_;
  double tolerance_;
  std::unique_ptr<PartMemo> memo_ = std::make_unique<PartMemo>();
};

/// Proves parts 0 and 1, anywhere in space. The answer does not depend on the order of parts, the number of threads, or
/// an earlier call that was told to stop. Its certificate must be accepted.
inline std::optional<Certificate> prove_pair(const ImmobilityProver& prover, const std::string& kind, const Mesh& a,
                                             const Mesh& b, double tolerance, Rng& rng, double share = 1) {
  const Pose turned = shapes::random_pose(rng, 2);
  const ProverRig rig(shapes::assembly_of({shapes::moved(a, turned), shapes::moved(b, turned)}), tolerance);
  const auto found = rig.prove(prover, {0}, {1}, share);
  const auto back = rig.prove(prover, {1}, {0}, share);
  EXPECT_EQ(found.has_value(), back.has_value());
  RunContext helped;
  helped.executor = std::make_shared<Executor>(3);
  const auto same = rig.anew().prove(prover, {0}, {1}, share, helped);
  EXPECT_EQ(found.has_value(), same.has_value());
  RunContext stopped;
  stopped.cancel.cancel();
  const ProverRig later = rig.anew();
  EXPECT_FALSE(later.prove(prover, {0}, {1}, share, stopped));
  EXPECT_EQ(later.prove(prover, {0}, {1}, share).has_value(), found.has_value()) << "a stopped call says nothing";
  if (!found || !same || !back) return found;
  for (const auto* other : {&*back, &*same}) {
    EXPECT_EQ(found->parts, other->parts);
    EXPECT_EQ(found->numbers, other->numbers);
    EXPECT_EQ(found->text, other->text);
  }
  EXPECT_EQ(rig.anew().objection(prover, kind, *found, share), "");
  for (const PartId id : found->parts)
    EXPECT_NE(found->text.find(rig.assembly().parts[id].name), std::string::npos) << found->text;
  return found;
}

/// True if the verifier accepts that `part` leaves `of` by that translation.
inline bool comes_out(const Mesh& part, const Mesh& of, const Eigen::Vector3d& by, double tolerance) {
  const Verifier verifier(shapes::assembly_of({part, of}), {tolerance});
  return verifier.check_motion({0}, {{1, Pose{}}}, {{Pose{}}, {shapes::shift(by)}}).valid;
}

}  // namespace dismantle::immobility
