// acme.walled_in: an immobility prover. A closed surface of one part encloses a point deep inside the other part. When
// they are apart, the point is outside, so on the way it crosses the surface, which then is too deep in the other part.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/plugin.h"

namespace {

using Eigen::Vector3d;

struct AcmeWalledInParameters {
  std::int64_t points = 8;

  static void describe(dismantle::Schema<AcmeWalledInParameters>& s) {
    s.add("points", &AcmeWalledInParameters::points,
          {.unit = "1",
           .min = 1,
           .max = 100,
           .doc = "Points along each edge of the part's box, in the search for one that is deep enough."});
  }
};

class AcmeWalledIn final : public dismantle::ImmobilityProver {
 public:
  explicit AcmeWalledIn(const AcmeWalledInParameters& params) : params_(params) {}

  dismantle::ProverTraits traits() const noexcept override {
    return {.effort = dismantle::ProofEffort::low, .min_parts = 2, .max_parts = 2, .depends_on_poses = false};
  }

  std::optional<dismantle::Certificate> prove(const dismantle::SeparationQuery& query,
                                              const dismantle::RunContext& context) const override {
    if (query.moving.size() != 1 || query.fixed.size() != 1) return std::nullopt;
    const dismantle::PartId a = query.moving[0].part, b = query.fixed[0].part;
    // What a part with an open surface encloses is not known.
    if (query.assembly.parts[a].open || query.assembly.parts[b].open) return std::nullopt;
    // Separation is symmetric: either part may be the enclosed one.
    for (const auto& [inside, around] : {std::pair(a, b), std::pair(b, a)}) {
      const double allowed = query.assembly.initial_overlap(inside, around) + query.margin();
      const auto point =
          walled_in(*query.assembly.parts[inside].mesh, *query.assembly.parts[around].mesh, allowed, context);
      if (context.should_stop()) return std::nullopt;
      if (point) return certificate(query, inside, around, *point, allowed);
    }
    return std::nullopt;
  }

 private:
  struct DeepPoint {
    Vector3d at;
    double depth = 0;
  };

  /// The deepest point of `part` that is deeper than `allowed` and inside a closed shell of `other`.
  std::optional<DeepPoint> walled_in(const dismantle::Mesh& part, const dismantle::Mesh& other, double allowed,
                                     const dismantle::RunContext& context) const {
    const dismantle::Aabb box = part.box();
    const dismantle::TriangleBvh surface(part);
    const auto shells = shells_of(other);
    std::optional<DeepPoint> found;
    const std::int64_t n = params_.points;
    for (std::int64_t k = 0; k < n * n * n; ++k) {
      if (context.should_stop()) return std::nullopt;
      const Vector3d share((static_cast<double>(k % n) + 0.5) / static_cast<double>(n),
                           (static_cast<double>(k / n % n) + 0.5) / static_cast<double>(n),
                           (static_cast<double>(k / (n * n)) + 0.5) / static_cast<double>(n));
      const Vector3d point = box.lo + share.cwiseProduct(box.size());
      const double depth = -surface.signed_distance(point);
      if (depth <= allowed || (found && depth <= found->depth)) continue;
      if (std::any_of(shells.begin(), shells.end(), [&](const auto& s) { return s.winding_number(point) != 0; }))
        found = DeepPoint{point, depth};
    }
    return found;
  }

  /// The closed surfaces of a mesh: its outer shells and its cavities.
  static std::vector<dismantle::TriangleBvh> shells_of(const dismantle::Mesh& mesh) {
    dismantle::DisjointSets connected(mesh.vertices.size());
    for (const auto& t : mesh.triangles) {
      connected.join(t[0], t[1]);
      connected.join(t[0], t[2]);
    }
    std::map<std::uint32_t, dismantle::Mesh> shells;
    for (const auto& t : mesh.triangles) {
      dismantle::Mesh& shell = shells[connected.root(t[0])];
      shell.vertices = mesh.vertices;
      shell.triangles.push_back(t);
    }
    std::vector<dismantle::TriangleBvh> out;
    for (const auto& [root, shell] : shells) out.emplace_back(shell);
    return out;
  }

  static dismantle::Certificate certificate(const dismantle::SeparationQuery& query, dismantle::PartId inside,
                                            dismantle::PartId around, const DeepPoint& point, double allowed) {
    dismantle::Certificate c;
    c.parts = {inside, around};
    c.numbers = {
        {"point", {point.at.x(), point.at.y(), point.at.z()}}, {"depth", {point.depth}}, {"allowed", {allowed}}};
    const double scale = query.assembly.normalization.scale;  // the text uses input units
    c.text = "'" + query.assembly.parts[inside].name + "' is walled in by '" + query.assembly.parts[around].name +
             "': a point of it lies " + std::to_string(point.depth / scale) +
             " below its surface, and would have to pass " + "a closed wall; " + std::to_string(allowed / scale) +
             " is allowed";
    return c;
  }

  AcmeWalledInParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("acme.walled_in", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::ImmobilityProver, AcmeWalledIn, AcmeWalledInParameters>(
      "acme.walled_in", "A point deep inside one part is walled in by a closed surface of the other.",
      {.source = "own"});
}
