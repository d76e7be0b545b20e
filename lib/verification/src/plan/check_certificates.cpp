#include "plan/check_certificates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "certificates/checker.h"
#include "dismantle/geometry/numerics.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"

namespace dismantle {
namespace {

using geometry::kRounding;

class CertificateCheck {
 public:
  CertificateCheck(const Plan& plan, const Assembly& assembly, const Verifier& verifier, const PlanState& state,
                   const std::vector<StepMotion>& motions, const ProverOfKind& prover_of, const RunContext& context)
      : tolerance_(plan.verified_max_penetration),
        assembly_(assembly),
        state_(state),
        motions_(motions),
        prover_of_(prover_of),
        context_(context) {
    for (const Part& part : assembly.parts)
      memo_.put(
          "solids", part.id,
          std::shared_ptr<const std::vector<geometry::Solid>>(std::shared_ptr<void>(), &verifier.solids(part.id)));
  }

  /// Is there a checker or a prover for certificates of this kind?
  bool can_check(const std::string& kind) const {
    return certificates::checker_of(kind) != nullptr || prover_of(kind) != nullptr;
  }

  /// Returns what is wrong with the certificate; empty when it holds, or when nothing can check it.
  std::string problem_of(const PlanCertificate& written) {
    Certificate certificate{written.kind, {}, {}, written.full_tolerance, written.margin, written.numbers, {}};
    for (const auto& name : written.parts) {
      const auto id = state_.find(name);
      if (!id) return fmt::format("part '{}' is not in the assembly", name);
      if (assembly_.parts[*id].open)
        return fmt::format("the surface of part '{}' is open, and proofs are about solids", name);
      if (std::find(certificate.parts.begin(), certificate.parts.end(), *id) != certificate.parts.end())
        return fmt::format("part '{}' is listed twice", name);
      certificate.parts.push_back(*id);
    }
    if (certificate.parts.size() < 2) return "it needs two parts at least";
    const bool full = written.margin >= tolerance_ * (1 - kRounding);
    if (!(written.margin > 0)) return fmt::format("its margin {:.4g} is not positive", written.margin);
    if (full != written.full_tolerance)
      return fmt::format("its margin is {:.4g} of a tolerance of {:.4g}, and it says {} full tolerance", written.margin,
                         tolerance_,
                         written.full_tolerance ? "that it holds for the" : "that it does not hold for the");
    const certificates::Checker* checker = certificates::checker_of(written.kind);
    const auto prover = checker == nullptr ? prover_of(written.kind) : nullptr;
    if (checker == nullptr && !prover) return {};  // can_check() says so
    for (const Pose& pose : written.poses)
      certificate.poses.push_back(assembly_.normalization.pose_to_internal({pose.t, pose.q.normalized()}));
    const ProverTraits traits = checker != nullptr ? checker->traits : prover->traits();
    if (certificate.parts.size() < traits.min_parts || certificate.parts.size() > traits.max_parts)
      return "it has more or fewer parts than proofs of its kind are about";
    if (!certificate.poses.empty()) {
      if (certificate.poses.size() != certificate.parts.size()) return "it does not have one pose for each part";
      if (!traits.depends_on_poses) return "it has poses, and proofs of its kind are about parts as assembled";
      if (!ever_there(certificate)) return "its parts are at no time of the plan where it has them";
    }
    // A proof for more than the tolerance is checked as it stands: what holds for more holds for less.
    const double tolerance = std::max(tolerance_, written.margin);
    SeparationQuery query{assembly_, {}, {}, tolerance, full ? 1 : written.margin / tolerance, memo_};
    for (std::size_t i = 0; i < certificate.parts.size(); ++i)
      (i == 0 ? query.moving : query.fixed)
          .push_back({certificate.parts[i], certificate.poses.empty() ? Pose{} : certificate.poses[i]});
    return checker != nullptr ? certificates::objection(*checker, certificate, query, context_)
                              : prover->objection(certificate, query, context_);
  }

 private:
  std::shared_ptr<const ImmobilityProver> prover_of(const std::string& kind) const {
    return prover_of_ ? prover_of_(kind) : nullptr;
  }

  /// True if its parts are, at some time of the plan, at the certificate's poses.
  bool ever_there(const Certificate& certificate) const {
    std::vector<Pose> places(certificate.parts.size());
    const auto there = [&] {
      for (std::size_t i = 0; i < places.size(); ++i)
        if (state_.offset(certificate.parts[i], places[i], certificate.poses[i]) > state_.tolerance()) return false;
      return true;
    };
    if (there()) return true;
    for (const StepMotion& motion : motions_)
      for (const auto& instant : motion.path) {
        bool moved = false;
        for (std::size_t i = 0; i < places.size(); ++i) {
          const auto at = std::find(motion.moving.begin(), motion.moving.end(), certificate.parts[i]);
          if (at == motion.moving.end()) continue;
          places[i] = instant[static_cast<std::size_t>(at - motion.moving.begin())];
          moved = true;
        }
        if (moved && there()) return true;
      }
    return false;
  }

  double tolerance_;
  const Assembly& assembly_;
  const PlanState& state_;
  const std::vector<StepMotion>& motions_;
  const ProverOfKind& prover_of_;
  const RunContext& context_;
  PartMemo memo_;
};

}  // namespace

CertificateFindings check_certificates_of(const Plan& plan, const Assembly& assembly, const Verifier& verifier,
                                          const PlanState& state, const std::vector<StepMotion>& motions,
                                          const ProverOfKind& prover_of, const RunContext& context) {
  CertificateFindings found;
  std::vector<std::string>& problems = found.problems;
  CertificateCheck check(plan, assembly, verifier, state, motions, prover_of, context);
  for (std::size_t i = 0; i < plan.certificates.size() && !context.should_stop(); ++i) {
    const std::string& kind = plan.certificates[i].kind;
    if (const std::string problem = check.problem_of(plan.certificates[i]); !problem.empty())
      problems.push_back(fmt::format("certificate {} ({}) does not hold: {}", i, kind, problem));
    else if (!check.can_check(kind))
      found.not_checked.push_back(fmt::format(
          "certificate {}: there is no immobility prover '{}' to check it: name the folder of its plugin in "
          "DISMANTLE_PLUGIN_PATH, or in plugins.search_paths of a configuration",
          i, kind));
  }
  for (const PlanUnsolved& u : plan.unsolved) {
    const PlanCertificate* certificate =
        u.certificate && *u.certificate < plan.certificates.size() ? &plan.certificates[*u.certificate] : nullptr;
    if (u.certificate && certificate == nullptr)
      problems.push_back(fmt::format("unsolved '{}': there is no certificate {}", u.part, *u.certificate));
    if (certificate != nullptr &&
        std::find(certificate->parts.begin(), certificate->parts.end(), u.part) == certificate->parts.end())
      problems.push_back(fmt::format("unsolved '{}': its certificate is not about it", u.part));
    if (u.outcome == Outcome::infeasible && (certificate == nullptr || !certificate->full_tolerance))
      problems.push_back(
          fmt::format("unsolved '{}' is called infeasible without a certificate for the full tolerance", u.part));
  }
  return found;
}

}  // namespace dismantle
