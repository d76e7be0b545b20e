#include "dismantle/statics/describe.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

/// "+x", or the two largest of its axes, "+x and -z".
std::string axis_text(const Vec3& direction) {
  constexpr double kNoticed = 0.38;  // the sine of 22.5 degrees
  const Vec3 unit = direction.normalized();
  std::string text;
  for (int k = 0; k < 3; ++k)
    if (std::abs(unit[k]) > kNoticed)
      text += fmt::format("{}{}{}", text.empty() ? "" : " and ", unit[k] > 0 ? '+' : '-', "xyz"[k]);
  return text;
}

constexpr double kCarries = 0.3;  // cosine: a contact that carries weight; otherwise it lies along gravity

double speed(const Body& body, const Motion& motion) { return motion.v.norm() + motion.w.norm() * body.radius; }

/// Where the upper end of the body goes by turning, without its way up or down.
Vec3 sideways(const Body& body, const Motion& motion, const Vec3& down) {
  const Vec3 top = motion.w.cross(-body.radius * down);
  return top - top.dot(down) * down;
}

}  // namespace

std::string motion_text(const Body& body, const Motion& motion, const Vec3& down) {
  // A body that turns moves its upper end sideways; the speed of that end against the speed of its centre.
  const Vec3 tips = sideways(body, motion, down);
  if (tips.norm() > 0.5 * motion.v.norm()) return "tips towards " + axis_text(tips);
  if (motion.v.dot(down) > 0.8 * motion.v.norm()) return "falls down";
  const Vec3 level = motion.v - motion.v.dot(down) * down;
  return level.norm() > 0 ? "slides towards " + axis_text(level) : "turns";
}

std::string missing_text(const Pile& pile, std::uint32_t body, const Motions& motions) {
  const Body& own = pile.bodies[body];
  const Motion& motion = motions[body];
  const Vec3 tips = sideways(own, motion, pile.down), side = tips.normalized();
  const bool tipping = tips.norm() > 0.5 * motion.v.norm();
  bool carried = false, gives_way = false;
  double reach = -std::numeric_limits<double>::infinity();  // of what is under it, towards where it tips
  for (const Contact& c : pile.contacts) {
    if (c.a != body && c.b != body) continue;
    const Vec3 into = c.a == body ? c.normal : Vec3(-c.normal);
    if (-into.dot(pile.down) < kCarries) continue;
    const std::uint32_t under = c.a == body ? c.b : c.a;
    carried = true;
    gives_way = gives_way || speed(pile.bodies[under], motions[under]) > 0;
    for (const Vec3& p : c.points) reach = std::max(reach, side.dot(p - own.center));
  }
  if (!carried) return "nothing is under it";
  if (tipping && reach < 1e-3 * own.radius) return fmt::format("nothing is under its half towards {}", axis_text(tips));
  if (gives_way) return kGivesWay;
  const Vec3 level = motion.v - motion.v.dot(pile.down) * pile.down;
  return !tipping && level.norm() > 0.2 * motion.v.norm() ? "nothing stops it there" : "";
}

std::string picture_json(const Pile& pile, const Motions& motions, const ContactForces& forces,
                         const std::vector<std::uint32_t>& of, const std::vector<std::uint32_t>& held,
                         const PictureFrame& frame) {
  using Json = nlohmann::ordered_json;
  const auto rounded = [](double x) { return std::stod(fmt::format("{:.5g}", x)) + 0.0; };
  const auto json = [&](const Vec3& v) { return Json{rounded(v.x()), rounded(v.y()), rounded(v.z())}; };
  Json falls = Json::array(), arrows = Json::array();
  double most = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) most = std::max(most, speed(pile.bodies[i], motions[i]));
  for (std::uint32_t i = 0; i < motions.size(); ++i) {
    if (!(speed(pile.bodies[i], motions[i]) > 1e-6 * most)) continue;
    falls.push_back({{"parts", frame.names(i)},
                     {"center", json(frame.place(pile.bodies[i].center))},
                     {"v", json(motions[i].v / most)},
                     {"w", json(motions[i].w / (frame.scale * most))}});
  }
  for (const std::uint32_t i : of) {
    const Body& body = pile.bodies[i];
    const std::vector<std::string> names = frame.names(i);
    if (names.empty() || forces.empty()) continue;
    const auto arrow = [&](const char* kind, const Vec3& at, const Vec3& force) {
      if (force.norm() > 1e-3 * body.weight)
        arrows.push_back(
            {{"kind", kind}, {"part", names.front()}, {"at", json(frame.place(at))}, {"force", json(force)}});
    };
    const Vec3 weight = body.weight * pile.down;
    Vec3 sum = weight;
    arrow("weight", body.center, weight);
    for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
      const Contact& c = pile.contacts[k];
      if (c.a != i && c.b != i) continue;
      Vec3 whole = Vec3::Zero(), middle = Vec3::Zero();
      double all = 0;
      for (std::size_t p = 0; p < c.points.size(); ++p) {
        whole += c.a == i ? forces[k][p] : Vec3(-forces[k][p]);
        middle += forces[k][p].norm() * c.points[p];
        all += forces[k][p].norm();
      }
      sum += whole;
      if (all > 0) arrow("contact", middle / all, whole);
    }
    if (std::ranges::find(held, i) != held.end()) arrow("hold", body.center, -sum);
  }
  return Json{{"falls", std::move(falls)}, {"arrows", std::move(arrows)}}.dump(-1, ' ', false,
                                                                               Json::error_handler_t::replace);
}

}  // namespace dismantle::statics
