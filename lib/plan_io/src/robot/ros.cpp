// A plan for ROS 2: a URDF, and the steps in the fields of its message types.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "dismantle/plan_io/markup.h"
#include "dismantle/plan_io/robot_exports.h"
#include "dismantle/plan_io/verdicts.h"
#include "export/dot_text.h"
#include "json/json_text.h"
#include "json/verdicts_json.h"
#include "robot/bodies.h"
#include "steps/timeline.h"

namespace dismantle {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRoot = "assembly";

/// builtin_interfaces/Time, Duration.
Json time_json(double seconds) {
  const auto microseconds = static_cast<std::int64_t>(std::llround(1e6 * seconds));
  return {{"sec", microseconds / 1'000'000}, {"nanosec", microseconds % 1'000'000 * 1000}};
}

/// std_msgs/Header.
Json header_json() { return {{"stamp", time_json(0)}, {"frame_id", kRoot}}; }

Json vector_json(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
Json quaternion_json(const Eigen::Quaterniond& q) { return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}; }

/// geometry_msgs/Transform, Pose.
Json transform_json(const Pose& p) { return {{"translation", vector_json(p.t)}, {"rotation", quaternion_json(p.q)}}; }
Json pose_json(const Pose& p) { return {{"position", vector_json(p.t)}, {"orientation", quaternion_json(p.q)}}; }

/// geometry_msgs/TransformStamped.
Json frame_json(const std::string& link, const Pose& pose) {
  return {{"header", header_json()}, {"child_frame_id", link}, {"transform", transform_json(pose)}};
}

class RosSteps {
 public:
  RosSteps(const Plan& plan, const Assembly& assembly, const RobotFrame& frame, const std::vector<RobotBody>& bodies)
      : plan_(plan), assembly_(assembly), frame_(frame) {
    for (const RobotBody& body : bodies) link_of_.emplace(body.part, body.link);
  }

  /// `disassembly`: of these steps the plan says what they wait for.
  Json all(const std::vector<PlanStep>& steps, bool disassembly) const {
    Json out = Json::array();
    for (const StepTime& time :
         timeline(steps, assembly_, disassembly ? disassembly_ups(plan_) : assembly_ups(plan_)).steps) {
      const PlanStep& step = steps[time.index];
      Json entry = {{"step", step.step}};
      if (disassembly) entry["after"] = step.after;
      if (step.forced)
        entry["forced"] = {{"link", link_of_.at(step.forced->part)},
                           {"against", link_of_.at(step.forced->other)},
                           {"depth", frame_.metres() * step.forced->depth},
                           {"accepted", step.forced->accepted}};
      entry["trajectory"] = trajectory(step, time);
      entry["paths"] = Json::array();
      entry["frames"] = Json::array();
      for (const PlanMove& move : step.moves) {
        const std::string& link = link_of_.at(move.part);
        entry["paths"].push_back({{"link", link}, {"pose_array", pose_array(move)}});
        entry["frames"].push_back(frame_json(link, frame_.pose(move.poses.back())));
      }
      add_checks(disassembly ? step.checks : checks_of_assembly_step(plan_, step), entry);
      out.push_back(std::move(entry));
    }
    return out;
  }

 private:
  /// trajectory_msgs/MultiDOFJointTrajectory.
  Json trajectory(const PlanStep& step, const StepTime& time) const {
    Json names = Json::array(), points = Json::array();
    for (const PlanMove& move : step.moves) names.push_back(link_of_.at(move.part) + "_joint");
    for (std::size_t k = 0; k < time.pose_times.size(); ++k) {
      Json transforms = Json::array();
      for (const PlanMove& move : step.moves) transforms.push_back(transform_json(frame_.pose(move.poses[k])));
      points.push_back({{"transforms", std::move(transforms)},
                        {"velocities", Json::array()},
                        {"accelerations", Json::array()},
                        {"time_from_start", time_json(static_cast<double>(time.pose_times[k]) -
                                                      static_cast<double>(time.pose_times.front()))}});
    }
    return {{"header", header_json()}, {"joint_names", std::move(names)}, {"points", std::move(points)}};
  }

  /// geometry_msgs/PoseArray.
  Json pose_array(const PlanMove& move) const {
    Json poses = Json::array();
    for (const Pose& pose : move.poses) poses.push_back(pose_json(frame_.pose(pose)));
    return {{"header", header_json()}, {"poses", std::move(poses)}};
  }

  /// What has to be held is a note of a kind that begins with "hold".
  static void add_checks(const std::vector<PlanVerdict>& checks, Json& entry) {
    Json holds = Json::array();
    for (const PlanVerdict& check : checks)
      for (const StepNote& note : check.notes) {
        if (!note.kind.starts_with("hold")) continue;
        Json& hold = holds.emplace_back(Json{{"text", note.text}});
        if (!note.data.empty())
          hold["data"] = Json::binary(std::vector<std::uint8_t>(note.data.begin(), note.data.end()));
      }
    if (!holds.empty()) entry["holds"] = std::move(holds);
    if (!checks.empty()) entry["checks"] = verdicts_json(checks);
  }

  const Plan& plan_;
  const Assembly& assembly_;
  const RobotFrame& frame_;
  std::map<std::string, std::string> link_of_;
};

std::string link_text(const RobotBody& body) {
  const Eigen::Matrix3d& i = body.inertia;
  std::string out = fmt::format(
      "  <link name=\"{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n",
      body.link, numbers_text(body.center), number_text(body.mass), number_text(i(0, 0)), number_text(i(0, 1)),
      number_text(i(0, 2)), number_text(i(1, 1)), number_text(i(1, 2)), number_text(i(2, 2)));
  const std::string geometry =
      fmt::format("      <geometry>\n        <mesh filename=\"meshes/{}\"/>\n      </geometry>\n", body.mesh);
  out += "    <visual>\n" + geometry;
  if (body.colour)
    out += fmt::format("      <material name=\"{}_colour\">\n        <color rgba=\"{}\"/>\n      </material>\n",
                       body.link, rgba_text(*body.colour));
  out += "    </visual>\n    <collision>\n" + geometry + "    </collision>\n  </link>\n";
  return out + fmt::format(
                   "  <joint name=\"{0}_joint\" type=\"floating\">\n    <origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>\n"
                   "    <parent link=\"{1}\"/>\n    <child link=\"{0}\"/>\n  </joint>\n",
                   body.link, kRoot);
}

std::string urdf(const Plan& plan, const std::vector<RobotBody>& bodies) {
  std::string text =
      fmt::format("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<robot name=\"{}\">\n  <link name=\"{}\"/>\n",
                  escaped_markup(utf8_text(plan.assembly.source)), kRoot);
  for (const RobotBody& body : bodies) text += link_text(body);
  return text + "</robot>\n";
}

}  // namespace

std::vector<ExportedFile> to_ros(const Plan& plan, const Assembly& assembly, const InputFrame& input) {
  const RobotFrame frame(input);
  const std::vector<RobotBody> bodies = robot_bodies(plan, assembly, frame);
  Json json = {{"format", "dismantle.ros"}, {"version", 1}, {"source", plan.assembly.source}, {"root", kRoot}};
  json["unit_known"] = input.unit_known;
  Json links = Json::array(), frames = Json::array();
  for (const RobotBody& body : bodies) {
    links.push_back({{"part", body.part}, {"link", body.link}, {"joint", body.link + "_joint"}});
    frames.push_back(frame_json(body.link, Pose{}));
  }
  json["links"] = std::move(links);
  json["frames"] = std::move(frames);
  const RosSteps steps(plan, assembly, frame, bodies);
  json["disassembly"] = steps.all(plan.disassembly, true);
  json["assembly"] = steps.all(plan.assembly_steps, false);
  std::vector<ExportedFile> files = mesh_files(bodies, assembly, frame);
  files.push_back({"assembly.urdf", urdf(plan, bodies)});
  files.push_back({"motions.json", json_text(json) + "\n"});
  return files;
}

}  // namespace dismantle
