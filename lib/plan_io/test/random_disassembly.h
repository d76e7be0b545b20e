/// A random plan that takes every part out, and boxes to go with it.
#pragma once

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "dismantle/plan.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {

struct RandomDisassembly {
  Plan plan;
  Assembly assembly;
};

/// Takes random groups apart until every part is alone. Names have all that formats have to quote.
inline RandomDisassembly random_disassembly(std::mt19937& random, std::size_t count) {
  RandomDisassembly out;
  Plan& plan = out.plan;
  plan.assembly.source = "a|b<c>";
  plan.assembly.box = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(10, 10, 10)};
  out.assembly.input_box = plan.assembly.box;
  std::vector<std::vector<std::string>> groups(1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "p,\"" + std::to_string(i) + "\"<&|\\";
    plan.assembly.parts.push_back({static_cast<unsigned>(i), name, "x.obj", {}, {}});
    Part part;
    part.id = static_cast<PartId>(i);
    part.name = name;
    part.mesh = part.surface = std::make_shared<Mesh>(shapes::box({double(i), 0, 0}, {i + 1.0, 1, 1}));
    out.assembly.parts.push_back(part);
    groups[0].push_back(name);
  }
  std::map<std::string, Pose> now;
  while (std::ranges::any_of(groups, [](const auto& g) { return g.size() > 1; })) {
    const std::size_t g = random() % groups.size();
    if (groups[g].size() < 2) continue;
    PlanStep step;
    step.step = static_cast<unsigned>(plan.disassembly.size() + 1);
    step.layer = step.step;
    if (step.step > 1) step.after = {step.step - 1};
    std::ranges::shuffle(groups[g], random);
    const std::size_t taken = 1 + random() % (groups[g].size() - 1);
    step.separates.emplace_back(groups[g].begin(), groups[g].begin() + static_cast<std::ptrdiff_t>(taken));
    groups[g].erase(groups[g].begin(), groups[g].begin() + static_cast<std::ptrdiff_t>(taken));
    for (const std::string& name : step.separates[0]) {
      const Pose begin = now[name], end{begin.t + Eigen::Vector3d(0, 0, 2), begin.q};
      step.moves.push_back({name, {begin, end}});
      now[name] = end;
    }
    groups.push_back(step.separates[0]);
    plan.disassembly.push_back(std::move(step));
  }
  plan.status = PlanStatus::complete;
  return out;
}

}  // namespace dismantle
