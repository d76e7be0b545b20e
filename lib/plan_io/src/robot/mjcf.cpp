// A plan as a model of MuJoCo.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "dismantle/plan_io/markup.h"
#include "dismantle/plan_io/plan_history.h"
#include "dismantle/plan_io/robot_exports.h"
#include "export/dot_text.h"
#include "json/json_text.h"
#include "robot/bodies.h"

namespace dismantle {
namespace {

using PartList = std::vector<std::size_t>;

/// Holds two bodies together as assembled until a step moves one against the other.
struct Weld {
  std::string name;
  std::size_t body = 0;
  std::optional<std::size_t> other{};  // none: the world
};

/// Sets of parts that have moved as one since the beginning: each step splits some of them, and each piece that comes
/// off was welded to what stays.
class Welds {
 public:
  Welds(const Plan& plan, const PlanHistory& history, const std::vector<RobotBody>& bodies)
      : plan_(plan), history_(history), bodies_(bodies), moves_(history.parts()) {}

  std::vector<Weld> all() {
    std::vector<PartList> sets(1);
    for (std::size_t i = 0; i < history_.parts(); ++i) sets[0].push_back(i);
    std::vector<bool> moved(history_.parts());
    for (std::size_t s = 0; s < history_.steps(); ++s) {
      moves_.assign(history_.parts(), nullptr);
      for (const PlanMove& move : plan_.disassembly[s].moves) {
        moves_[history_.index_of(move.part)] = &move.poses;
        moved[history_.index_of(move.part)] = true;
      }
      const std::size_t before = sets.size();
      for (std::size_t k = 0; k < before; ++k) split(s, k, sets);
    }
    for (const PartList& set : sets) {
      for (std::size_t i = 1; i < set.size(); ++i) welds_.push_back({"stay_" + link(set[i]), set[i], set[0]});
      if (!moved[set[0]]) welds_.push_back({"base_" + link(set[0]), set[0], {}});
    }
    return std::move(welds_);
  }

 private:
  const std::string& link(std::size_t part) const { return bodies_[part].link; }

  bool together(std::size_t a, std::size_t b, std::size_t step) const {
    const bool same = moves_[a] == nullptr || moves_[b] == nullptr ? moves_[a] == moves_[b] : *moves_[a] == *moves_[b];
    return same && history_.group_of(a, step + 1) == history_.group_of(b, step + 1);
  }

  void split(std::size_t step, std::size_t k, std::vector<PartList>& sets) {
    std::vector<PartList> pieces;
    for (const std::size_t i : sets[k]) {
      const auto piece = std::ranges::find_if(pieces, [&](const PartList& p) { return together(p[0], i, step); });
      if (piece == pieces.end())
        pieces.push_back({i});
      else
        piece->push_back(i);
    }
    // What does not move stays; if all moves, the largest piece.
    std::ranges::stable_sort(pieces, [&](const PartList& a, const PartList& b) {
      return std::pair(moves_[a[0]] != nullptr, b.size()) < std::pair(moves_[b[0]] != nullptr, a.size());
    });
    for (std::size_t p = 1; p < pieces.size(); ++p) {
      const std::size_t first = pieces[p][0];
      welds_.push_back({fmt::format("step_{}_{}", plan_.disassembly[step].step, link(first)), first, pieces[0][0]});
      sets.push_back(std::move(pieces[p]));
    }
    sets[k] = std::move(pieces[0]);
  }

  const Plan& plan_;
  const PlanHistory& history_;
  const std::vector<RobotBody>& bodies_;
  std::vector<const std::vector<Pose>*> moves_;  // in the present step
  std::vector<Weld> welds_;
};

std::string body_text(const RobotBody& body) {
  const Eigen::Matrix3d& i = body.inertia;
  Eigen::Matrix<double, 6, 1> full;
  full << i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2);
  return fmt::format(
      "    <body name=\"{0}\" pos=\"0 0 0\" quat=\"1 0 0 0\">\n"
      "      <freejoint name=\"{0}_joint\"/>\n"
      "      <inertial pos=\"{1}\" mass=\"{2}\" fullinertia=\"{3}\"/>\n"
      "      <geom name=\"{0}_geom\" class=\"part\" mesh=\"{0}\"{4}/>\n"
      "    </body>\n",
      body.link, numbers_text(body.center), number_text(body.mass), numbers_text(full),
      body.colour ? fmt::format(" rgba=\"{}\"", rgba_text(*body.colour)) : "");
}

/// The poses of all parts after some steps: x y z qw qx qy qz each.
std::string key_text(const std::string& name, const PlanHistory& history, std::size_t done, const RobotFrame& frame) {
  Eigen::VectorXd qpos(7 * history.parts());
  for (std::size_t i = 0; i < history.parts(); ++i) {
    const Pose pose = frame.pose(history.pose_of(i, done));
    qpos.segment<7>(static_cast<Eigen::Index>(7 * i)) << pose.t, pose.q.w(), pose.q.vec();
  }
  return fmt::format("    <key name=\"{}\" qpos=\"{}\"/>\n", name, numbers_text(qpos));
}

/// Names of parts that a body's name does not spell.
std::string names_text(const std::vector<RobotBody>& bodies) {
  std::string out;
  for (const RobotBody& body : bodies)
    if (body.part != body.link)
      out += fmt::format("    <text name=\"{}\" data=\"{}\"/>\n", body.link, escaped_markup(utf8_text(body.part)));
  return out.empty() ? out : "  <custom>\n" + out + "  </custom>\n";
}

}  // namespace

std::vector<ExportedFile> to_mjcf(const Plan& plan, const Assembly& assembly, const InputFrame& input) {
  const RobotFrame frame(input);
  const std::vector<RobotBody> bodies = robot_bodies(plan, assembly, frame);
  const PlanHistory history(plan);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
      "<mujoco model=\"{}\">\n"
      "  <compiler angle=\"radian\" meshdir=\"meshes\" balanceinertia=\"true\" boundmass=\"1e-12\""
      " boundinertia=\"1e-14\"/>\n"
      "  <option timestep=\"0.002\" gravity=\"0 0 -9.81\"/>\n"
      "  <default>\n"
      "    <default class=\"part\">\n"
      "      <geom type=\"mesh\" contype=\"0\" conaffinity=\"0\"/>\n"
      "    </default>\n"
      "  </default>\n",
      escaped_markup(utf8_text(plan.assembly.source)));
  text += names_text(bodies) + "  <asset>\n";
  for (const RobotBody& body : bodies)
    text += fmt::format("    <mesh name=\"{}\" file=\"{}\"{}/>\n", body.link, body.mesh,
                        body.open ? " inertia=\"shell\"" : "");
  text += "  </asset>\n  <worldbody>\n    <light pos=\"0 0 10\" dir=\"0 0 -1\" directional=\"true\"/>\n";
  for (const RobotBody& body : bodies) text += body_text(body);
  text += "  </worldbody>\n  <equality>\n";
  for (const Weld& weld : Welds(plan, history, bodies).all())
    text += fmt::format("    <weld name=\"{}\" body1=\"{}\"{}/>\n", weld.name, bodies[weld.body].link,
                        weld.other ? fmt::format(" body2=\"{}\"", bodies[*weld.other].link) : "");
  text += "  </equality>\n  <keyframe>\n" + key_text("assembled", history, 0, frame);
  for (std::size_t s = 0; s < history.steps(); ++s)
    text += key_text(fmt::format("step_{}", plan.disassembly[s].step), history, s + 1, frame);
  text += "  </keyframe>\n</mujoco>\n";
  std::vector<ExportedFile> files = mesh_files(bodies, assembly, frame);
  files.push_back({"assembly.xml", std::move(text)});
  return files;
}

}  // namespace dismantle
