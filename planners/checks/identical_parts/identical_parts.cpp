#include "identical_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/geometry/congruent_parts.h"

namespace dismantle::checks {

std::vector<std::size_t> IdenticalParts::Shapes::of(std::span<const PlacedPart> parts) const {
  std::vector<std::size_t> all;
  for (const PlacedPart& p : parts) all.push_back(first.at(p.part));
  std::sort(all.begin(), all.end());
  return all;
}

std::shared_ptr<const IdenticalParts::Shapes> IdenticalParts::shapes_of(const Assembly& assembly) const {
  const auto same = [](const std::shared_ptr<const Mesh>& mesh, const Part& part) { return mesh == part.mesh; };
  const std::lock_guard lock(mutex_);
  if (known_ &&
      std::equal(known_->meshes.begin(), known_->meshes.end(), assembly.parts.begin(), assembly.parts.end(), same))
    return known_;
  auto shapes = std::make_shared<Shapes>();
  for (const Part& part : assembly.parts) shapes->meshes.push_back(part.mesh);
  for (const auto& placement : geometry::find_congruent(assembly.parts)) shapes->first.push_back(placement.original);
  return known_ = std::move(shapes);
}

StepVerdict IdenticalParts::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  StepVerdict verdict;
  if (question.previous == nullptr || question.moving.empty()) return verdict;
  const std::shared_ptr<const Shapes> shapes = shapes_of(question.assembly);
  const std::vector<std::size_t> now = shapes->of(question.moving), present = shapes->of(question.present);
  if (now == shapes->of(question.previous->moving) ||
      !std::includes(present.begin(), present.end(), now.begin(), now.end()))
    return verdict;
  verdict.cost = 1;
  const std::string& name = question.assembly.parts[question.moving.front().part].name;
  verdict.reason =
      question.moving.size() == 1
          ? fmt::format("'{}' is not put in directly after the equal part that is in place", name)
          : fmt::format("the group of '{}' is not put in directly after the equal group that is in place", name);
  return verdict;
}

}  // namespace dismantle::checks
