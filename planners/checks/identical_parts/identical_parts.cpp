#include "identical_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/geometry/equal_items.h"

namespace dismantle::checks {

namespace {

constexpr double kSimilarDirection = 0.995;  // cosine of 6 degrees, as the check `directions`

}  // namespace

void IdenticalPartsParameters::describe(Schema<IdenticalPartsParameters>& s) {
  s.add("another_way", &IdenticalPartsParameters::another_way,
        {.unit = "1",
         .min = 0,
         .doc = "Cost of an equal part that goes in along another direction than the one before."});
}

std::vector<std::size_t> IdenticalParts::Shapes::of(std::span<const PlacedPart> parts) const {
  std::vector<std::size_t> all;
  for (const PlacedPart& p : parts) all.push_back(first.at(p.part));
  std::sort(all.begin(), all.end());
  return all;
}

bool IdenticalParts::Shapes::includes(std::span<const PlacedPart> parts, std::vector<std::size_t> wanted) const {
  for (const PlacedPart& p : parts) {
    if (wanted.empty()) return true;
    if (const auto one = std::find(wanted.begin(), wanted.end(), first.at(p.part)); one != wanted.end())
      wanted.erase(one);
  }
  return wanted.empty();
}

const PlacedPart& IdenticalParts::Shapes::least(std::span<const PlacedPart> parts) const {
  return *std::min_element(parts.begin(), parts.end(), [&](const PlacedPart& a, const PlacedPart& b) {
    return std::pair(first.at(a.part), a.part) < std::pair(first.at(b.part), b.part);
  });
}

bool IdenticalParts::Shapes::same_way(std::span<const PlacedPart> parts, const Eigen::Vector3d& direction,
                                      std::span<const PlacedPart> others, const Eigen::Vector3d& other) const {
  if (direction.dot(other) > kSimilarDirection) return true;
  const PlacedPart &a = least(parts), &b = least(others);
  if (surface.at(a.part) != surface.at(b.part)) return false;  // no pose takes one to the other
  const auto seen = [&](const PlacedPart& from, const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return (from.pose.q * pose.at(from.part).q).conjugate() * v;
  };
  return seen(a, direction).dot(seen(b, other)) > kSimilarDirection;
}

std::shared_ptr<const IdenticalParts::Shapes> IdenticalParts::shapes_of(const Assembly& assembly) const {
  const auto kind_of = [](const Part& part) { return part.kind ? std::string_view(part.kind->kind) : ""; };
  const auto same = [&](const auto& known, const Part& part) {
    return known.first == part.mesh && known.second == kind_of(part);
  };
  const std::lock_guard lock(mutex_);
  if (known_ &&
      std::equal(known_->known.begin(), known_->known.end(), assembly.parts.begin(), assembly.parts.end(), same))
    return known_;
  auto shapes = std::make_shared<Shapes>();
  std::vector<std::string> kinds;
  for (const Part& part : assembly.parts) {
    kinds.emplace_back(kind_of(part));
    shapes->known.emplace_back(part.mesh, kinds.back());
  }
  const std::vector<geometry::ShapePlacement> placements = geometry::find_congruent(assembly.parts);
  for (const auto& placement : placements) {
    shapes->surface.push_back(placement.original);
    shapes->pose.push_back(placement.pose);
  }
  shapes->first = geometry::equal_items(assembly.parts, placements, kinds);
  return known_ = std::move(shapes);
}

StepVerdict IdenticalParts::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.previous == nullptr || question.moving.empty()) return verdict;
  const std::shared_ptr<const Shapes> shapes = shapes_of(question.assembly);
  const std::vector<std::size_t> now = shapes->of(question.moving);
  const std::string& name = question.assembly.parts[question.moving.front().part].name;
  if (now == shapes->of(question.previous->moving)) {
    const Eigen::Vector3d &direction = question.direction, &before = question.previous->direction;
    if (params_.another_way == 0 || direction.isZero() || before.isZero() ||
        shapes->same_way(question.moving, direction, question.previous->moving, before))
      return verdict;
    verdict.cost = params_.another_way;
    verdict.reason = fmt::format("'{}' goes in along another direction than the equal part before it", name);
    return verdict;
  }
  if (!shapes->includes(question.present, now)) return verdict;
  verdict.cost = 1;
  verdict.reason =
      question.moving.size() == 1
          ? fmt::format("'{}' is not put in directly after the equal part that is in place", name)
          : fmt::format("the group of '{}' is not put in directly after the equal group that is in place", name);
  return verdict;
}

}  // namespace dismantle::checks
