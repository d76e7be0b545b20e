// write_cases FOLDER: pages and glTF files of random plans of the samples, and what C++ computes for them.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/page.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/samples/samples.h"
#include "random_plan.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

using CaseJson = nlohmann::json;
namespace fs = std::filesystem;

CaseJson pose_json(const Pose& p) { return {p.t.x(), p.t.y(), p.t.z(), p.q.w(), p.q.x(), p.q.y(), p.q.z()}; }

Pose pose_at(const Track& track, double time) {
  const auto after = std::ranges::upper_bound(track.keys, time, {}, [](const Key& k) { return double{k.time}; });
  if (after == track.keys.begin()) return track.keys.front().pose;
  if (after == track.keys.end()) return track.keys.back().pose;
  const Key &a = *std::prev(after), &b = *after;
  return screw_interpolate(a.pose, b.pose, (time - double{a.time}) / (double{b.time} - double{a.time}));
}

/// Poses at random times of both animations.
CaseJson poses_json(const Plan& plan, const Assembly& assembly, Rng& rng) {
  CaseJson out = CaseJson::array();
  for (const bool apart : {true, false}) {
    const Timeline line = apart ? timeline(plan.disassembly, assembly, disassembly_ups(plan))
                                : timeline(plan.assembly_steps, assembly, assembly_ups(plan));
    for (const Track& track : line.tracks)
      for (int n = 0; n < 20; ++n) {
        const double time = rng.uniform(-1, double{line.duration} + 1);
        out.push_back({{"mode", apart ? "disassembly" : "assembly"},
                       {"part", assembly.parts[track.part].name},
                       {"time", time},
                       {"pose", pose_json(pose_at(track, time))}});
      }
  }
  return out;
}

/// Screw motions of all sizes, also those where the closed forms cancel.
CaseJson screws_json(Rng& rng) {
  CaseJson out = CaseJson::array();
  const auto any = [&](double size) {
    return Eigen::Vector3d(rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size));
  };
  for (int n = 0; n < 2000; ++n) {
    const double angle = n % 4 == 0 ? std::pow(10, rng.uniform(-12, -1)) : rng.uniform(0, 0.99 * std::numbers::pi);
    const Pose a{any(20), rotation_from_vector(any(1.8))};
    const Pose b{any(20), (rotation_from_vector(angle * any(1).normalized()) * a.q).normalized()};
    const double u = rng.uniform();
    out.push_back(
        {{"a", pose_json(a)}, {"b", pose_json(b)}, {"u", u}, {"pose", pose_json(screw_interpolate(a, b, u))}});
  }
  return out;
}

Assembly sample_assembly(const std::string& name, Rng& rng) {
  std::vector<std::pair<std::string, Mesh>> meshes;
  Aabb box;
  for (RawPart& part : samples::make(name)) {
    for (const auto& v : part.mesh.vertices) box.extend(v);
    meshes.emplace_back(part.name, std::move(part.mesh));
  }
  const double scale = 10 / box.size().maxCoeff();
  const Normalization units{scale, rng.uniform() < 0.2 ? Eigen::Vector3d(1e6, -1e6, 3e5) : box.center()};
  for (auto& [part, mesh] : meshes)
    for (auto& v : mesh.vertices) v = scale * (v - box.center());
  return assembly_of_meshes(meshes, units.scale, units.center);
}

void write_cases(const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  Rng rng(1);
  write_file(folder / "screws.json", screws_json(rng).dump());
  for (const samples::Sample& sample : samples::list())
    for (int trial = 0; trial < 4; ++trial) {
      const Assembly assembly = sample_assembly(sample.name, rng);
      const RandomPlan made = random_plan(assembly, rng);
      const fs::path to = folder / (sample.name + "_" + std::to_string(trial));
      fs::create_directory(to);
      const auto bytes = [](const std::vector<std::uint8_t>& file) { return std::string(file.begin(), file.end()); };
      write_file(to / "page.json", to_page(made.plan, assembly, "@DISMANTLE_DATA@"));
      write_file(to / "plan.glb", bytes(to_glb(made.plan, assembly)));
      write_file(to / "exploded.glb", bytes(to_exploded_glb(made.plan, assembly, input_frame(assembly))));
      write_file(to / "poses.json", poses_json(made.plan, assembly, rng).dump());
    }
}

}  // namespace
}  // namespace dismantle

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: viewer_cases FOLDER");
  dismantle::write_cases(argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "viewer_cases: " << error.what() << '\n';
  return 1;
}
