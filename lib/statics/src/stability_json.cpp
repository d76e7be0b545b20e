#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/statics/certificates.h"
#include "dismantle/statics/describe.h"
#include "dismantle/statics/stability.h"

namespace dismantle::statics {
namespace {

using Json = nlohmann::ordered_json;
using Vec3 = Eigen::Vector3d;

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json degrees(const std::optional<double>& angle) {
  return angle ? Json(std::round(*angle * 180 / M_PI * 1e4) / 1e4) : Json(nullptr);
}

std::string name_of(std::uint32_t body, const Assembly& assembly) {
  return body < assembly.parts.size() ? assembly.parts[body].name : "table";
}

/// "tips" if turning moves the body more than its centre moves along the table.
std::string_view how(const LeastPush& push, const Pile& pile) {
  const Motion& m = push.motion[push.body];
  return m.w.norm() * pile.bodies[push.body].radius > 0.2 * m.v.norm() ? "tips" : "slides";
}

Vec3 vector_in(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Motions motions_in(const Json& json) {
  Motions motion;
  for (const Json& m : json) motion.push_back({vector_in(m.at("v")), vector_in(m.at("w"))});
  return motion;
}

Json motions_json(const Motions& motion) {
  Json all = Json::array();
  for (const Motion& m : motion) all.push_back({{"v", json_of(m.v)}, {"w", json_of(m.w)}});
  return all;
}

}  // namespace

std::string report_json(const StabilityReport& report, const Assembly& assembly, const AssemblyPile& pile) {
  Json json = {{"verdict", to_string(report.judgement.verdict)}};
  json["holds"] = Json::array();
  for (const std::uint32_t i : report.holds.held) json["holds"].push_back(name_of(i, assembly));
  json["holds_proved"] = report.holds.found && report.holds.proved;
  json["moves"] = Json::array();
  for (const PartMove& m : report.moves)
    json["moves"].push_back({{"part", name_of(m.part, assembly)}, {"direction", json_of(m.direction)}});
  json["why"] = report.why;
  json["critical_tilt_degrees"] = {{"x", degrees(report.tilt_x)},
                                   {"y", degrees(report.tilt_y)},
                                   {"-x", degrees(report.tilt_back_x)},
                                   {"-y", degrees(report.tilt_back_y)}};
  json["least_push"] = Json::array();
  for (const LeastPush& p : report.pushes)
    json["least_push"].push_back({{"part", name_of(p.body, assembly)},
                                  {"newton", p.force},
                                  {"share_of_weight", p.force / report.pile.bodies[p.body].weight},
                                  {"direction", json_of(p.direction)},
                                  {"how", how(p, report.pile)}});
  json["friction"] = pile.options().friction;
  json["by_friction"] = Json::array();
  for (const auto& [friction, verdict] : report.by_friction)
    json["by_friction"].push_back({{"friction", friction}, {"verdict", to_string(verdict)}});
  json["by_contact_tolerance"] = Json::array();
  for (std::size_t k = 0; k < report.at_tolerances.size(); ++k)
    json["by_contact_tolerance"].push_back(
        {{"factor", 0.5 * static_cast<double>(1 << k)}, {"verdict", to_string(report.at_tolerances[k])}});
  json["contacts"] = report.pile.contacts.size();
  json["assumed"] = {{"unit", pile.unit_known() ? assembly.unit : "mm"},
                     {"touching", pile.options().touching},
                     {"table", pile.options().table}};
  json["not_checked"] = Json::array();
  if (report.pushes_left_out) json["not_checked"].push_back("least_push: too many parts");
  return json.dump();
}

std::string picture_of(const StabilityReport& report, const Assembly& assembly) {
  const Pile& pile = report.pile;
  const bool stands = report.judgement.verdict == Verdict::stands;
  std::vector<std::uint32_t> of = report.holds.held;
  if (stands)
    for (std::uint32_t i = 0; i < assembly.parts.size(); ++i)
      if (!pile.bodies[i].fixed) of.push_back(i);
  PictureFrame frame;
  frame.place = [](const Vec3& p) { return p; };
  frame.names = [&](std::uint32_t body) {
    return body < assembly.parts.size() ? std::vector{assembly.parts[body].name} : std::vector<std::string>();
  };
  return picture_json(pile, report.falling, stands ? report.judgement.forces : report.holds.forces, of,
                      report.holds.held, frame);
}

std::string certificate_json(const StabilityReport& report, const Assembly& assembly) {
  const Pile& pile = report.pile;
  Json json = {{"down", json_of(pile.down)}, {"bodies", Json::array()}, {"contacts", Json::array()}};
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const Body& b = pile.bodies[i];
    json["bodies"].push_back({{"name", name_of(static_cast<std::uint32_t>(i), assembly)},
                              {"newton", b.weight},
                              {"center", json_of(b.center)},
                              {"fixed", b.fixed}});
  }
  const ContactForces& forces = report.judgement.forces;
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    Json contact = {{"a", c.a},
                    {"b", c.b},
                    {"normal", json_of(c.normal)},
                    {"friction", c.friction},
                    {"bonded", c.bonded},
                    {"points", Json::array()}};
    for (const Vec3& p : c.points) contact["points"].push_back(json_of(p));
    if (!forces.empty()) {
      contact["forces"] = Json::array();
      for (const Vec3& f : forces[k]) contact["forces"].push_back(json_of(f));
    }
    json["contacts"].push_back(std::move(contact));
  }
  if (!report.judgement.displacement.empty()) json["displacement"] = motions_json(report.judgement.displacement);
  if (!report.judgement.motion.empty()) json["motion"] = motions_json(report.judgement.motion);
  return json.dump();
}

std::string check_stability_json(const std::string& text, const AssemblyPile& assembly) {
  try {
    const Json json = Json::parse(text);
    const Json& certificate = json.at("certificate");
    const std::string verdict = json.at("verdict").get<std::string>();
    const Pile pile = assembly.pile();
    const Json& contacts = certificate.at("contacts");
    if (contacts.size() != pile.contacts.size()) return "the assembly has other contacts than the file states";
    ContactForces forces;
    for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
      const Json& c = contacts[k];
      if (c.at("a") != pile.contacts[k].a || c.at("b") != pile.contacts[k].b)
        return fmt::format("contact {} is between other parts than the file states", k);
      auto& at = forces.emplace_back();
      if (c.contains("forces"))
        for (const Json& f : c.at("forces")) at.push_back(vector_in(f));
    }
    if (verdict == "falls") return check_fall(pile, motions_in(certificate.at("motion")));
    if (verdict != "stands" && verdict != "pressed_in") return "nothing is certified: the verdict is " + verdict;
    std::string wrong = check_equilibrium(pile, forces);
    if (wrong.empty() && verdict == "stands")
      wrong = check_created(pile, forces, motions_in(certificate.at("displacement")));
    return wrong;
  } catch (const nlohmann::json::exception& e) {
    throw InputError("", fmt::format("the stability file cannot be read: {}", e.what()));
  }
}

}  // namespace dismantle::statics
