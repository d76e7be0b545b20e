/// overlap_lock: a point lies in both parts, deeper in the first than the pair may penetrate.
///
/// Why the parts cannot be separated: fix the point to the first part. When the parts are apart, the point is outside
/// the second part, so on the way the surface of the second part passes through it. At that moment a surface point is
/// as deep in the first part as the point. Both depths are measured here over all triangles.
#include <fmt/format.h>

#include <algorithm>

#include "certificates/body.h"
#include "certificates/checker.h"

namespace dismantle::certificates {

std::string objection_to_overlap_lock(const Certificate& certificate, const SeparationQuery& query,
                                      const RunContext& /*context*/) {
  const PartId inner = certificate.parts[0], other = certificate.parts[1];
  const auto& point = certificate.numbers.at("point");
  const Vec3 p(point[0], point[1], point[2]);
  const double claimed = certificate.numbers.at("depth").front(), allowed = certificate.numbers.at("allowed").front();
  const double rounding = rounding_of(query, inner), limit = allowed_depth(query, inner, other);
  if (!(allowed >= limit - rounding))
    return fmt::format("it allows a penetration of {:.6g}, and the pair may have {:.6g}", allowed, limit);
  if (!(claimed > allowed + rounding)) return "its depth is not more than what is allowed";
  const auto deepest = [&](PartId part) {
    double most = 0;
    for (const Body& body : bodies_of(query, part))
      if (body.closed) most = std::max(most, depth(p, body));
    return most;
  };
  if (const double in_first = deepest(inner); !(in_first >= claimed - rounding))
    return fmt::format("its point is {:.6g} deep in the first part, not {:.6g}", in_first, claimed);
  if (!(deepest(other) > rounding_of(query, other))) return "its point is not in the second part";
  return {};
}

}  // namespace dismantle::certificates
