#include "blocking_graph/pair_sweep.h"

#include "dismantle/geometry/overlap_region.h"
#include "dismantle/geometry/pair_check.h"
#include "dismantle/geometry/part_data.h"

namespace dismantle::blocking {

PairSweep::PairSweep(const Assembly& assembly, PathOracle& oracle)
    : assembly_(assembly),
      tolerance_(oracle.tolerance()),
      own_(oracle.memo() == nullptr ? std::make_unique<PartMemo>() : nullptr),
      memo_(own_ ? *own_ : *oracle.memo()),
      shapes_(geometry::find_congruent(assembly.parts, 1e-4 * tolerance_)),
      hulls_(assembly.parts.size()) {
  for (const Part& part : assembly.parts) boxes_.push_back(part.mesh->box());
  for (const InitialOverlap& overlap : assembly.overlaps)
    if (const auto region = geometry::overlap_region(assembly, overlap, tolerance_))
      regions_.emplace(std::pair(overlap.a, overlap.b), *region);
}

const std::vector<geometry::Solid>& PairSweep::solids(PartId part) const {
  return geometry::solids_of(assembly_, part, memo_, tolerance_);
}

const std::vector<Eigen::Vector3d>& PairSweep::hull(PartId part) const {
  const std::vector<Eigen::Vector3d>* known = hulls_.at(part).load(std::memory_order_acquire);
  if (known == nullptr)
    hulls_[part].store(known = &geometry::hull_of(assembly_, part, memo_), std::memory_order_release);
  return *known;
}

bool PairSweep::passes(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path,
                       double overlap) const {
  const auto swept = [](const Aabb& box, const std::vector<Pose>& poses) {
    return geometry::RelativeMotion(poses, {Pose{}}, box).swept_box();
  };
  if (!swept(boxes_[moving], path).overlaps(swept(boxes_[fixed], {fixed_at}))) return true;
  const geometry::Limits limits{overlap, tolerance_};
  return geometry::passes(solids(moving), path, solids(fixed), fixed_at, limits);
}

bool PairSweep::leaves_region(PartId moving, PartId fixed, const Pose& fixed_at, const std::vector<Pose>& path) const {
  const auto region = regions_.find(std::minmax(moving, fixed));
  if (region == regions_.end()) return false;
  const geometry::Limits elsewhere{0, tolerance_, &region->second, tolerance_};
  return geometry::refuted_by_samples(solids(moving), path, solids(fixed), fixed_at, elsewhere);
}

std::vector<geometry::PlacedHull> PairSweep::hulls(const std::vector<PlacedPart>& parts) const {
  std::vector<geometry::PlacedHull> placed;
  placed.reserve(parts.size());
  for (const PlacedPart& p : parts)
    placed.push_back({assembly_.parts[p.part].mesh.get(), &boxes_[p.part], &hull(p.part), p.pose});
  return placed;
}

double PairSweep::distance_apart(const std::vector<PlacedPart>& group, const std::vector<PlacedPart>& rest,
                                 const Eigen::Vector3d& direction, double most) const {
  return geometry::HullsApart(hulls(group), hulls(rest)).distance(direction, most, 12);
}

}  // namespace dismantle::blocking
