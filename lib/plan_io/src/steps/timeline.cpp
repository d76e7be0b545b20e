#include "steps/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

/// The pace of an animation, seconds: a viewer can follow it.
struct Pace {
  double before = 0.5, between = 0.3, after = 1.0;  // pauses: before the first step, between steps, after the last
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
std::vector<double> way_of(const PlanStep& step, const std::vector<Body>& bodies) {
  std::vector<double> way(step.moves.front().poses.size(), 0.0);
  for (std::size_t k = 1; k < way.size(); ++k) {
    double furthest = 0;
    for (std::size_t m = 0; m < bodies.size(); ++m) {
      const Pose &a = step.moves[m].poses[k - 1], &b = step.moves[m].poses[k];
      furthest = std::max(furthest, screw_travel(a, b, bodies[m].center, bodies[m].radius));
    }
    way[k] = way[k - 1] + furthest;
  }
  return way;
}

void append(std::vector<Key>& keys, double time, Pose pose) {
  if (!keys.empty() && keys.back().pose.q.dot(pose.q) < 0) pose.q.coeffs() *= -1;
  const auto t = static_cast<float>(time);
  if (!keys.empty() && t <= keys.back().time)
    keys.back().pose = pose;  // closer together than single precision can tell
  else
    keys.push_back({t, pose});
}

}  // namespace

Timeline timeline(const std::vector<PlanStep>& steps, const Assembly& assembly) {
  Timeline out;
  const auto known = bodies_of(assembly);
  const double size = std::max(assembly.input_box.size().maxCoeff(), 1e-300);
  std::map<PartId, Track> tracks;
  const Pace pace;
  double now = pace.before;
  for (const PlanStep& step : steps) {
    if (step.moves.empty()) continue;
    std::vector<Body> bodies;
    for (const PlanMove& move : step.moves) {
      const auto it = known.find(move.part);
      if (it == known.end()) throw InputError(move.part, "the plan moves a part that the assembly does not have");
      if (move.poses.size() != step.moves.front().poses.size() || move.poses.empty())
        throw InputError(move.part, fmt::format("step {}: moves must have the same number of poses", step.step));
      bodies.push_back(it->second);
    }
    const std::vector<double> way = way_of(step, bodies);
    const double duration = std::clamp(pace.per_size * way.back() / size, pace.shortest, pace.longest);
    std::vector<double> times;
    for (std::size_t k = 0; k < way.size(); ++k)
      times.push_back(now + duration * (way.back() > 0 ? way[k] / way.back() : double(k) / double(way.size())));
    for (std::size_t m = 0; m < bodies.size(); ++m) {
      Track& track = tracks[bodies[m].id];
      track.part = bodies[m].id;
      for (std::size_t k = 0; k < way.size(); ++k) append(track.keys, times[k], step.moves[m].poses[k]);
    }
    out.steps.push_back({step.step, static_cast<float>(now), static_cast<float>(now + duration), {}, std::move(times)});
    for (const Body& body : bodies) out.steps.back().parts.push_back(body.id);
    now += duration + pace.between;
  }
  for (auto& [id, track] : tracks) {
    append(track.keys, now - pace.between + pace.after, track.keys.back().pose);
    out.tracks.push_back(std::move(track));
  }
  return out;
}

}  // namespace dismantle
