// plan.glb, and the exploded view as glTF.
#include <map>
#include <string>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/explode.h"
#include "glb/glb_scene.h"
#include "steps/fewer_poses.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

/// When each step of an animation happens, for viewers that show steps.
GlbJson step_times(const Timeline& line, const Assembly& assembly) {
  GlbJson steps = GlbJson::array();
  for (const StepTime& s : line.steps) {
    GlbJson parts = GlbJson::array();
    for (const PartId id : s.parts) parts.push_back(assembly.parts[id].name);
    steps.push_back({{"step", s.step}, {"begin", s.begin}, {"end", s.end}, {"parts", std::move(parts)}});
  }
  return steps;
}

/// Channels that move a part along its track.
void animate(const Track& track, GlbScene& scene, std::map<std::vector<float>, std::size_t>& clocks, GlbJson& samplers,
             GlbJson& channels) {
  std::vector<float> times, translations, rotations;
  bool turns = false;
  for (const Key& key : track.keys) {
    times.push_back(key.time);
    const Pose pose = scene.node_pose(track.part, key.pose);
    const Eigen::Vector3f t = pose.t.cast<float>();
    const Eigen::Quaternionf q = pose.q.cast<float>().normalized();
    translations.insert(translations.end(), {t.x(), t.y(), t.z()});
    rotations.insert(rotations.end(), {q.x(), q.y(), q.z(), q.w()});
    turns = turns || !key.pose.q.vec().isZero(0);
  }
  GlbBuffer& buffer = scene.buffer();
  const std::size_t n = times.size();
  const auto entry = clocks.try_emplace(times, 0);
  std::size_t& clock = entry.first->second;
  if (entry.second) clock = buffer.add(times, kFloat, "SCALAR", n, kNone, true);
  const auto channel = [&](const char* path, std::size_t output) {
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", scene.node_of(track.part)}, {"path", path}}}});
    samplers.push_back({{"input", clock}, {"interpolation", "LINEAR"}, {"output", output}});
  };
  channel("translation", buffer.add(translations, kFloat, "VEC3", n, kNone, false));
  if (turns) channel("rotation", buffer.add(rotations, kFloat, "VEC4", n, kNone, false));
}

}  // namespace

std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly) {
  InputFrame frame = input_frame(assembly);
  if (!plan.objective.empty()) frame.up = plan.objective.up;
  return to_glb(plan, assembly, frame);
}

std::vector<std::uint8_t> to_glb(const Plan& plan, const Assembly& assembly, const InputFrame& frame) {
  GlbScene scene(plan, assembly, frame);
  std::map<std::vector<float>, std::size_t> clocks;
  GlbJson animations = GlbJson::array();
  const auto add_animation = [&](const char* name, const std::vector<PlanStep>& steps, const StepUps& ups) {
    GlbJson samplers = GlbJson::array(), channels = GlbJson::array();
    std::vector<PlanStep> drawn;
    drawn.reserve(steps.size());
    for (const PlanStep& step : steps) drawn.push_back(drawn_step(step));
    const Timeline line = timeline(drawn, assembly, ups);
    for (const Track& track : line.tracks) animate(track, scene, clocks, samplers, channels);
    if (channels.empty()) return;
    animations.push_back({{"name", name},
                          {"channels", std::move(channels)},
                          {"samplers", std::move(samplers)},
                          {"extras", {{"kind", name}, {"steps", step_times(line, assembly)}}}});
  };
  add_animation("disassembly", plan.disassembly, disassembly_ups(plan));
  add_animation("assembly", plan.assembly_steps, assembly_ups(plan));
  return scene.file(plan, "disassembly", std::move(animations));
}

std::vector<std::uint8_t> to_exploded_glb(const Plan& plan, const Assembly& assembly, const InputFrame& frame) {
  GlbScene scene(plan, assembly, frame);
  const std::vector<Eigen::Vector3d> offsets = exploded_offsets(plan, assembly);
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) index_of.emplace(assembly.parts[i].name, i);
  for (std::size_t i = 0; i < offsets.size(); ++i)
    scene.place(index_of.at(plan.assembly.parts[i].name), {offsets[i], Eigen::Quaterniond::Identity()});
  return scene.file(plan, "exploded", GlbJson::array());
}

}  // namespace dismantle
