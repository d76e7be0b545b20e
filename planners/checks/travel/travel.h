/// Step check: how far do parts go through slits?
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "dismantle/geometry/part_boxes.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/parameters.h"
#include "dismantle/step_check.h"

namespace dismantle::checks {

struct TravelParameters {
  double gap = 0.02;
  static void describe(Schema<TravelParameters>& s);
};

/// Costs the length of the way on which a moving part is within a small gap of the present parts, in largest edges of
/// the assembly's box. An open way costs nothing, however long it is. Without a path it costs nothing.
class Travel final : public StepCheck {
 public:
  explicit Travel(const TravelParameters& params = {}) : params_(params) {}
  StepCheckTraits traits() const noexcept override { return {.estimates = true}; }
  /// By points of the moving surfaces.
  StepVerdict judge(const StepQuestion& question, const RunContext& context) const override;
  /// By boxes: no less than judge() says, but for the spacing of the samples.
  StepVerdict estimate(const StepQuestion& question, const RunContext& context) const override;

 private:
  struct Scene {
    explicit Scene(const Assembly& assembly)
        : boxes(assembly), surfaces(assembly.parts.size()), samples(assembly.parts.size()) {}
    bool is_of(const Assembly& assembly) const { return boxes.is_of(assembly); }
    const TriangleBvh& surface(const Part& part) const;
    const std::vector<Eigen::Vector3d>& points(const Part& part) const;
    geometry::PartBoxes boxes;

   private:
    mutable std::mutex mutex;
    mutable std::vector<std::unique_ptr<const TriangleBvh>> surfaces;
    mutable std::vector<std::vector<Eigen::Vector3d>> samples;
  };
  /// Are the moving parts, at these poses, close to a present part whose box is within the gap?
  using Close = std::function<bool(const std::vector<PlacedPart>& moving, const std::vector<const PlacedPart*>& near)>;
  StepVerdict verdict_of(const StepQuestion& question, const Scene& scene, const Close& close) const;
  bool touches(const Assembly& assembly, const Scene& scene, const PlacedPart& moving, const PlacedPart& other) const;

  TravelParameters params_;
  geometry::OfLastAssembly<Scene> scenes_;
};

}  // namespace dismantle::checks
