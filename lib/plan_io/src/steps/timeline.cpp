#include "steps/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

/// The pace of an animation, seconds: a viewer can follow it.
struct Pace {
  double before = 0.5, between = 0.3, after = 1.0;  // pauses: before the first step, between steps, after the last
  double turning = 1.2;                             // pause in which the assembly is turned
  double shortest = 1.0, longest = 3.0;             // duration of a step
  double per_size = 1.5;                            // duration of a path as long as the assembly
};

struct Body {
  PartId id = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // input units
  double radius = 0;
};

std::map<std::string, Body> bodies_of(const Assembly& assembly) {
  std::map<std::string, Body> out;
  for (const Part& part : assembly.parts) {
    const Aabb box = part.mesh->box();
    out[part.name] = {part.id, assembly.normalization.to_input(box.center()),
                      0.5 * box.size().norm() / assembly.normalization.scale};
  }
  return out;
}

/// Travel of the part that moves furthest, from the begin of the step to each instant.
std::vector<double> lengths_of(const PlanStep& step, const std::vector<Body>& bodies) {
  std::vector<double> lengths(step.moves.front().poses.size(), 0.0);
  for (std::size_t k = 1; k < lengths.size(); ++k) {
    double furthest = 0;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
      const Pose &a = step.moves[m].poses[k - 1], &b = step.moves[m].poses[k];
      furthest = std::max(furthest, screw_travel(a, b, bodies[m].center, bodies[m].radius));
    }
    lengths[k] = lengths[k - 1] + furthest;
  }
  return lengths;
}

/// When a step that begins at `begin` reaches each of its poses. Single precision, in which glTF has times, may not
/// tell two of them apart; then the second is the next number.
std::vector<float> pose_times(double begin, double duration, const std::vector<double>& lengths) {
  std::vector<float> out;
  const std::size_t last = lengths.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const double share = lengths[last] > 0 ? lengths[k] / lengths[last] : last > 0 ? double(k) / double(last) : 0.0;
    const auto time = static_cast<float>(begin + duration * share);
    out.push_back(k == 0 ? time : std::max(time, std::nextafter(out.back(), std::numeric_limits<float>::max())));
  }
  return out;
}

void append(std::vector<Key>& keys, float time, Pose pose) {
  if (!keys.empty() && keys.back().pose.q.dot(pose.q) < 0) pose.q.coeffs() *= -1;
  keys.push_back({time, pose});
}

}  // namespace

StepUps disassembly_ups(const Plan& plan) {
  StepUps out;
  for (const PlanStep& step : plan.disassembly) out.push_back(step.up);
  return out;
}

StepUps assembly_ups(const Plan& plan) {
  StepUps out;
  const std::size_t n = plan.disassembly.size();
  for (const PlanStep& step : plan.assembly_steps) {
    out.push_back(step.up);
    if (!step.up && step.step >= 1 && step.step <= n) out.back() = plan.disassembly[n - step.step].up;
  }
  return out;
}

Timeline timeline(const std::vector<PlanStep>& steps, const Assembly& assembly, const StepUps& ups) {
  Timeline out;
  const auto known = bodies_of(assembly);
  const double size = std::max(assembly.input_box.size().maxCoeff(), 1e-300);
  std::map<PartId, Track> tracks;
  const Pace pace;
  double now = pace.before;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const PlanStep& step = steps[s];
    if (step.moves.empty()) continue;
    std::vector<Body> bodies;
    for (const PlanMove& move : step.moves) {
      const auto it = known.find(move.part);
      if (it == known.end()) throw InputError(move.part, "the plan moves a part that the assembly does not have");
      if (move.poses.size() != step.moves.front().poses.size() || move.poses.empty())
        throw InputError(move.part, fmt::format("step {}: moves must have the same number of poses", step.step));
      bodies.push_back(it->second);
    }
    const std::vector<double> lengths = lengths_of(step, bodies);
    const double duration = std::clamp(pace.per_size * lengths.back() / size, pace.shortest, pace.longest);
    if (!out.steps.empty() && ups.at(s) != ups.at(out.steps.back().index)) now += pace.turning - pace.between;
    std::vector<float> times = pose_times(now, duration, lengths);
    for (std::size_t m = 0; m < bodies.size(); ++m) {
      Track& track = tracks[bodies[m].id];
      track.part = bodies[m].id;
      for (std::size_t k = 0; k < lengths.size(); ++k) append(track.keys, times[k], step.moves[m].poses[k]);
    }
    now = static_cast<double>(times.back()) + pace.between;
    out.steps.push_back({s, step.step, times.front(), times.back(), {}, std::move(times)});
    for (const Body& body : bodies) out.steps.back().parts.push_back(body.id);
  }
  if (out.steps.empty()) return out;
  out.duration = static_cast<float>(static_cast<double>(out.steps.back().end) + pace.after);
  for (auto& [id, track] : tracks) {
    append(track.keys, out.duration, track.keys.back().pose);
    out.tracks.push_back(std::move(track));
  }
  return out;
}

}  // namespace dismantle
