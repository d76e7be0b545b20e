// Models for robots: what is written is that of the plan, in SI units.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/plan_io/robot_exports.h"
#include "random_disassembly.h"

namespace dismantle {
namespace {

using Files = std::map<std::string, std::string>;

Files by_name(const std::vector<ExportedFile>& files) {
  Files out;
  for (const ExportedFile& file : files) EXPECT_TRUE(out.emplace(file.name, file.content).second) << file.name;
  return out;
}

/// Values of an attribute in the order of the text.
std::vector<std::string> values_of(const std::string& xml, const std::string& element, const std::string& attribute) {
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = xml.find("<" + element + " ", at)) != std::string::npos; ++at) {
    const std::string tag = xml.substr(at, xml.find('>', at) - at);
    const std::size_t begin = tag.find(" " + attribute + "=\"");
    if (begin == std::string::npos) continue;
    const std::size_t value = begin + attribute.size() + 3;
    out.push_back(tag.substr(value, tag.find('"', value) - value));
  }
  return out;
}

std::vector<double> numbers_in(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> out;
  for (double x = 0; in >> x;) out.push_back(x);
  return out;
}

/// What coordinates count in: metres with Z up.
Pose in_metres(const Pose& p, const InputFrame& frame) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(frame.up, Eigen::Vector3d::UnitZ());
  return {frame.metres * (turn * p.t), turn * p.q * turn.conjugate()};
}

void turn_the_steps(Plan& plan, std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-1, 1);
  std::map<std::string, Pose> now;
  for (PlanStep& step : plan.disassembly) {
    const Pose turn{{angle(random), 3, 0}, Eigen::Quaterniond(1, angle(random), 0.2, 0.1).normalized()};
    for (PlanMove& move : step.moves) {
      Pose& pose = now[move.part];
      move.poses = {pose, turn * pose};
      pose = turn * pose;
    }
  }
}

TEST(Mjcf, AKeyframeIsTheStateAfterItsStep) {
  std::mt19937 random(5);
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0, 0.6, -0.8)}) {
    auto [plan, assembly] = random_disassembly(random, 7);
    turn_the_steps(plan, random);
    InputFrame frame = input_frame(plan.assembly);
    frame.up = up;
    frame.metres = 0.0254;
    const PlanHistory history(plan);
    const std::string xml = by_name(to_mjcf(plan, assembly, frame)).at("assembly.xml");
    const std::vector<std::string> keys = values_of(xml, "key", "qpos"), names = values_of(xml, "key", "name");
    ASSERT_EQ(keys.size(), history.steps() + 1);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      EXPECT_EQ(names[k], k == 0 ? "assembled" : "step_" + std::to_string(k));
      const std::vector<double> x = numbers_in(keys[k]);
      ASSERT_EQ(x.size(), 7 * history.parts());
      for (std::size_t i = 0; i < history.parts(); ++i) {
        const Pose p = in_metres(history.pose_of(i, k), frame);
        const double* q = &x[7 * i];
        EXPECT_LT((Eigen::Vector3d(q[0], q[1], q[2]) - p.t).norm(), 1e-12);
        EXPECT_LT(
            (Eigen::Vector4d(q[3], q[4], q[5], q[6]) - Eigen::Vector4d(p.q.w(), p.q.x(), p.q.y(), p.q.z())).norm(),
            1e-12);
      }
    }
  }
}

TEST(Mjcf, WeldsThatAreNotReleasedJoinWhatHasMovedAsOne) {
  std::mt19937 random(6);
  for (int round = 0; round < 20; ++round) {
    auto [plan, assembly] = random_disassembly(random, 3 + random() % 8);
    turn_the_steps(plan, random);
    plan.disassembly.resize(plan.disassembly.size() - random() % 2);  // some stay together
    const std::string xml = by_name(to_mjcf(plan, assembly, input_frame(plan.assembly))).at("assembly.xml");
    const std::vector<std::string> bodies = values_of(xml, "body", "name");
    const PlanHistory history(plan);
    ASSERT_EQ(bodies.size(), history.parts());
    std::map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < bodies.size(); ++i) index[bodies[i]] = i;
    const auto weld = values_of(xml, "weld", "name"), one = values_of(xml, "weld", "body1");
    for (std::size_t done = 0; done <= history.steps(); ++done) {
      std::vector<std::size_t> root(bodies.size());
      for (std::size_t i = 0; i < root.size(); ++i) root[i] = i;
      for (std::size_t w = 0; w < weld.size(); ++w) {
        const std::size_t place = xml.find("<weld name=\"" + weld[w] + "\"");
        const std::vector<std::string> two =
            values_of(xml.substr(place, xml.find('>', place) - place + 1), "weld", "body2");
        if (two.empty()) continue;  // to the world
        if (weld[w].starts_with("step_") && std::stoul(weld[w].substr(5)) <= done) continue;
        const std::size_t from = root[index.at(one[w])], to = root[index.at(two[0])];
        for (std::size_t& r : root)
          if (r == from) r = to;
      }
      for (std::size_t a = 0; a < root.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          EXPECT_EQ(root[a] == root[b], history.group_of(a, done) == history.group_of(b, done))
              << bodies[a] << " " << bodies[b] << " after step " << done;
    }
  }
}

TEST(Mjcf, APartThatIsShiftedIsReleased) {
  std::mt19937 random(9);
  auto [plan, assembly] = random_disassembly(random, 3);
  PlanStep shift = plan.disassembly[0];
  shift.separates.clear();
  const std::string part = shift.moves[0].part;
  shift.moves.resize(1);
  plan.disassembly = {shift};
  const std::string xml = by_name(to_mjcf(plan, assembly, input_frame(plan.assembly))).at("assembly.xml");
  std::size_t released = 0;
  for (const std::string& name : values_of(xml, "weld", "name")) released += name.starts_with("step_1_");
  EXPECT_EQ(released, 1u);
}

TEST(Ros, StepsHaveThePosesOfThePlan) {
  std::mt19937 random(10);
  auto [plan, assembly] = random_disassembly(random, 6);
  turn_the_steps(plan, random);
  PlanVerdict verdict{.type = "support"};
  verdict.notes = {{"hold", "Hold the lid.", R"({"force": 1.50})"}, {"turn", "Turn it over."}};
  plan.disassembly[1].checks = {verdict};
  PlanForced& forced = plan.disassembly[2].forced.emplace();
  forced.part = plan.disassembly[2].moves[0].part;
  forced.other = plan.assembly.parts[0].name;
  forced.depth = 0.5;
  const InputFrame frame = input_frame(plan.assembly);
  const Files files = by_name(to_ros(plan, assembly, frame));
  EXPECT_NE(files.at("motions.json").find(R"({"force": 1.50})"), std::string::npos) << "the data is kept byte for byte";
  const auto json = nlohmann::json::parse(files.at("motions.json"));
  std::map<std::string, std::string> part_of;
  for (const auto& link : json.at("links")) part_of[link.at("joint")] = link.at("part");
  EXPECT_EQ(part_of.size(), plan.assembly.parts.size());
  ASSERT_EQ(json.at("disassembly").size(), plan.disassembly.size());
  for (std::size_t s = 0; s < plan.disassembly.size(); ++s) {
    const auto& step = json["disassembly"][s];
    const PlanStep& expected = plan.disassembly[s];
    EXPECT_EQ(step.contains("holds"), s == 1);
    EXPECT_EQ(step.contains("forced"), s == 2);
    const auto& trajectory = step.at("trajectory");
    ASSERT_EQ(trajectory.at("joint_names").size(), expected.moves.size());
    double last = -1;
    for (std::size_t k = 0; k < expected.moves[0].poses.size(); ++k) {
      const auto& point = trajectory.at("points").at(k);
      const auto& time = point.at("time_from_start");
      const double seconds = time.at("sec").get<double>() + 1e-9 * time.at("nanosec").get<double>();
      EXPECT_GT(seconds, last);
      last = seconds;
      for (std::size_t m = 0; m < expected.moves.size(); ++m) {
        EXPECT_EQ(part_of.at(trajectory["joint_names"][m]), expected.moves[m].part);
        const Pose p = in_metres(expected.moves[m].poses[k], frame);
        const auto& t = point.at("transforms").at(m).at("translation");
        const auto& q = point["transforms"][m].at("rotation");
        const auto& pose = step.at("paths").at(m).at("pose_array").at("poses").at(k);
        EXPECT_EQ(pose.at("position"), t);
        EXPECT_EQ(pose.at("orientation"), q);
        EXPECT_LT((Eigen::Vector3d(t.at("x"), t.at("y"), t.at("z")) - p.t).norm(), 1e-12);
        EXPECT_EQ(Eigen::Vector4d(q.at("x"), q.at("y"), q.at("z"), q.at("w")), p.q.coeffs());
      }
    }
  }
  EXPECT_EQ(json["disassembly"][1]["holds"].size(), 1u);
  EXPECT_EQ(json["disassembly"][2]["forced"]["depth"], 0.5 * frame.metres);
}

TEST(Ros, MassesAreThoseOfTheSolids) {
  std::mt19937 random(11);
  auto [plan, assembly] = random_disassembly(random, 3);  // boxes of 1 x 1 x 1
  assembly.parts[1].density = 7.8;
  assembly.parts[2].open = true;
  InputFrame frame = input_frame(plan.assembly);
  frame.metres = 0.01;
  const std::string urdf = by_name(to_ros(plan, assembly, frame)).at("assembly.urdf");
  const std::vector<std::string> mass = values_of(urdf, "mass", "value"), ixx = values_of(urdf, "inertia", "ixx");
  ASSERT_EQ(mass.size(), 3u);
  EXPECT_NEAR(std::stod(mass[0]), 1e-3, 1e-12);
  EXPECT_NEAR(std::stod(ixx[0]), 1e-3 * 1e-4 / 6, 1e-16);
  EXPECT_NEAR(std::stod(mass[1]), 7.8e-3, 1e-12);
  EXPECT_GT(std::stod(mass[2]), 0) << "an open part has the mass of its surface";
  EXPECT_LT(std::stod(mass[2]), 1e-3);
  EXPECT_GT(std::stod(ixx[2]), 0);
}

TEST(Robots, NamesAreUniqueAndPlain) {
  std::mt19937 random(12);
  auto [plan, assembly] = random_disassembly(random, 5);
  const std::vector<std::string> names = {"world", "a b", "a/b", "螺丝", "螺母"};
  plan.disassembly.clear();
  for (std::size_t i = 0; i < names.size(); ++i) plan.assembly.parts[i].name = assembly.parts[i].name = names[i];
  const Files files = by_name(to_mjcf(plan, assembly, input_frame(plan.assembly)));
  const std::vector<std::string> bodies = values_of(files.at("assembly.xml"), "body", "name");
  EXPECT_EQ(std::set<std::string>(bodies.begin(), bodies.end()).size(), names.size());
  for (const std::string& body : bodies) {
    EXPECT_NE(body, "world");
    EXPECT_TRUE(files.contains("meshes/" + body + ".obj"));
    EXPECT_TRUE(std::ranges::all_of(body, [](char c) { return std::isalnum(c) || c == '_'; })) << body;
  }
  plan.assembly.parts[0].name = "no such part";
  EXPECT_THROW(to_mjcf(plan, assembly, input_frame(plan.assembly)), InputError);
  EXPECT_THROW(to_ros(plan, assembly, input_frame(plan.assembly)), InputError);
}

}  // namespace
}  // namespace dismantle
