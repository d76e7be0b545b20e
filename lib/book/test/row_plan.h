/// Plans of boxes in a row, for tests of books and films.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/plan.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {

/// Boxes of several sizes in a row, in input units of 0.1 and away from the origin.
inline Assembly row_of(std::size_t count) {
  Assembly a;
  a.normalization = {10, {5, 6, 7}};
  for (std::size_t i = 0; i < count; ++i) {
    Part part;
    part.id = static_cast<PartId>(i);
    part.name = "p" + std::to_string(i);
    part.file = part.name + ".obj";
    const double x = 3.0 * double(i), edge = 1 + 0.25 * double(i % 3);
    part.mesh = part.surface = std::make_shared<Mesh>(shapes::box({x, 0, 0}, {x + edge, edge, edge}));
    for (const auto& v : part.mesh->vertices) a.input_box.extend(a.normalization.to_input(v));
    a.parts.push_back(part);
  }
  return a;
}

inline std::vector<Pose> path_from(const Pose& begin, const Pose& end, std::size_t n) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(screw_interpolate(begin, end, double(i) / double(n - 1)));
  return out;
}

/// A plan that takes groups apart at random: each step moves some parts of a group away as a whole, rigidly.
inline Plan random_plan(const Assembly& assembly, std::mt19937& random) {
  Plan plan;
  plan.assembly.source = "row/";
  plan.assembly.scale = assembly.normalization.scale;
  plan.assembly.center = assembly.normalization.center;
  plan.assembly.box = assembly.input_box;
  for (const Part& part : assembly.parts) plan.assembly.parts.push_back({part.id, part.name, part.file});
  std::vector<std::vector<std::size_t>> groups(1);
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) groups[0].push_back(i);
  std::map<std::size_t, Pose> now;
  std::uniform_real_distribution<double> any(-1, 1);
  while (true) {
    std::vector<std::size_t> open;
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (groups[g].size() > 1) open.push_back(g);
    if (open.empty()) break;
    auto& group = groups[open[random() % open.size()]];
    std::ranges::shuffle(group, random);
    const std::size_t count = 1 + random() % (group.size() - 1);
    const Pose away{{any(random), any(random), any(random)},
                    Eigen::Quaterniond(2, any(random), any(random), any(random)).normalized()};
    PlanStep step;
    step.step = static_cast<unsigned>(plan.disassembly.size() + 1);
    step.separates.emplace_back();
    std::vector<std::size_t> out(group.end() - static_cast<std::ptrdiff_t>(count), group.end());
    group.resize(group.size() - count);
    for (const std::size_t i : out) {
      step.separates.back().push_back(assembly.parts[i].name);
      step.moves.push_back({assembly.parts[i].name, {}});
      for (const Pose& p : path_from(Pose{}, away, 5)) step.moves.back().poses.push_back(p * now[i]);
      now[i] = step.moves.back().poses.back();
    }
    groups.push_back(std::move(out));
    plan.disassembly.push_back(std::move(step));
  }
  plan.status = PlanStatus::complete;
  return plan;
}

}  // namespace dismantle
