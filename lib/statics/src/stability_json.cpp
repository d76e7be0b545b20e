#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "dismantle/errors.h"
#include "dismantle/statics/describe.h"
#include "dismantle/statics/flips.h"
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

Json forces_json(const std::vector<Vec3>& forces) {
  Json all = Json::array();
  for (const Vec3& f : forces) all.push_back(json_of(f));
  return all;
}

Json judgement_json(const Pile& pile, const Judgement& judgement) {
  Json json = {{"contacts", Json::array()}};
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    Json contact = {{"a", c.a},
                    {"b", c.b},
                    {"normal", json_of(c.normal)},
                    {"friction", c.friction},
                    {"bonded", c.bonded},
                    {"points", forces_json(c.points)}};
    if (!judgement.forces.empty()) contact["forces"] = forces_json(judgement.forces[k]);
    if (!judgement.others.empty()) contact["others"] = forces_json(judgement.others[k]);
    json["contacts"].push_back(std::move(contact));
  }
  if (!judgement.displacement.empty()) json["displacement"] = motions_json(judgement.displacement);
  if (judgement.verdict == Verdict::falls) json["motion"] = motions_json(judgement.motion);
  if (!judgement.slide.empty()) json["slide"] = motions_json(judgement.slide);
  return json;
}

Json variant_json(const Variant& v) {
  Json json = {{"touching", v.touching}, {"friction", v.friction}, {"verdict", to_string(v.judgement.verdict)}};
  if (v.tilt != 0) json["tilt"] = {{"axis", json_of(v.axis)}, {"angle", v.tilt}};
  return json;
}

Verdict verdict_in(const Json& json) {
  const std::string name = json.at("verdict");
  for (const Verdict v : {Verdict::stands, Verdict::falls, Verdict::pressed_in, Verdict::uncertain})
    if (name == to_string(v)) return v;
  throw InputError("", fmt::format("the stability file states an unknown verdict '{}'", name));
}

constexpr double kSame = 1e-9;  // of a size

bool is_same(const Json& json, const Vec3& v, double size) { return (vector_in(json) - v).norm() <= kSame * size; }

bool is_same(const Json& json, double value) { return std::abs(json.get<double>() - value) <= kSame * std::abs(value); }

/// What differs from the contacts that were found again; empty: nothing.
std::string other_contacts(const Json& certificate, const Pile& pile) {
  const Json& contacts = certificate.at("contacts");
  if (contacts.size() != pile.contacts.size()) return "the assembly has other contacts than the file states";
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    const Json &json = contacts[k], &points = json.at("points");
    if (json.at("a") != c.a || json.at("b") != c.b)
      return fmt::format("contact {} is between other parts than the file states", k);
    bool same = is_same(json.at("normal"), c.normal, 1) && is_same(json.at("friction"), c.friction) &&
                json.at("bonded") == c.bonded && points.size() == c.points.size();
    for (std::size_t p = 0; same && p < c.points.size(); ++p)
      same = is_same(points[p], c.points[p], c.points[p].norm() + pile.bodies[c.a].radius);
    if (!same) return fmt::format("contact {} is another one than the file states", k);
  }
  return "";
}

/// What differs from the bodies of the pile; empty: nothing.
std::string other_bodies(const Json& certificate, const Pile& pile) {
  const Json& bodies = certificate.at("bodies");
  if (bodies.size() != pile.bodies.size()) return "the assembly has other bodies than the file states";
  if (!is_same(certificate.at("down"), pile.down, 1)) return "the file states another direction of gravity";
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const Body& b = pile.bodies[i];
    if (!is_same(bodies[i].at("newton"), b.weight) || bodies[i].at("fixed") != b.fixed ||
        !is_same(bodies[i].at("center"), b.center, b.center.norm() + b.radius))
      return fmt::format("body {} is another one than the file states", i);
  }
  return "";
}

/// What the certificate of this verdict consists of.
Judgement judgement_in(const Json& json, Verdict verdict) {
  Judgement judgement;
  judgement.verdict = verdict;
  const auto forces = [&](const char* name) {
    ContactForces all;
    for (const Json& c : json.at("contacts"))
      for (auto& at = all.emplace_back(); const Json& f : c.at(name)) at.push_back(vector_in(f));
    return all;
  };
  if (verdict == Verdict::falls) judgement.motion = motions_in(json.at("motion"));
  if (verdict == Verdict::stands || verdict == Verdict::pressed_in) judgement.forces = forces("forces");
  if (verdict == Verdict::stands) judgement.displacement = motions_in(json.at("displacement"));
  if (verdict == Verdict::pressed_in) {
    judgement.others = forces("others");
    judgement.slide = motions_in(json.at("slide"));
  }
  return judgement;
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
  for (const char* tilts : {"critical_tilt_degrees", "critical_tilt_bounds_degrees"}) json[tilts] = Json::object();
  for (std::size_t i = 0; i < kTiltAxes.size(); ++i) {
    const TiltLimit& tilt = report.tilts[i];
    const std::string axis(kTiltAxes[i]);
    json["critical_tilt_degrees"][axis] = degrees(tilt.angle);
    json["critical_tilt_bounds_degrees"][axis] = {{"stands", degrees(tilt.stands)}, {"falls", degrees(tilt.falls)}};
  }
  json["least_push"] = Json::array();
  for (const LeastPush& p : report.pushes)
    json["least_push"].push_back({{"part", name_of(p.body, assembly)},
                                  {"newton", p.force},
                                  {"share_of_weight", p.force / report.pile.bodies[p.body].weight},
                                  {"direction", json_of(p.direction)},
                                  {"how", how(p, report.pile)},
                                  {"exact", p.exact}});
  json["friction"] = pile.options().friction;
  json["by_friction"] = Json::array();
  for (const auto& [friction, verdict] : report.by_friction)
    json["by_friction"].push_back(
        {{"friction", friction}, {"verdict", verdict ? Json(to_string(*verdict)) : Json(nullptr)}});
  json["by_contact_tolerance"] = Json::array();
  for (std::size_t k = 0; k < report.at_tolerances.size(); ++k)
    json["by_contact_tolerance"].push_back(
        {{"factor", 0.5 * static_cast<double>(1 << k)}, {"verdict", to_string(report.at_tolerances[k])}});
  if (report.judgement.verdict == Verdict::uncertain) {
    json["flips"] = Json::array();
    for (const Variant& v : report.variants) json["flips"].push_back(variant_json(v));
    json["flips_text"] = flips_text(report.variants);
  }
  json["contacts"] = report.pile.contacts.size();
  json["assumed"] = {{"unit", pile.unit_known() ? assembly.unit : "mm"},
                     {"touching", pile.options().touching},
                     {"table", pile.options().table}};
  json["not_checked"] = Json::array();
  for (const std::string& what : report.not_computed) json["not_checked"].push_back(what + ": not computed (budget)");
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
  Json json = {{"down", json_of(pile.down)}, {"bodies", Json::array()}};
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const Body& b = pile.bodies[i];
    json["bodies"].push_back({{"name", name_of(static_cast<std::uint32_t>(i), assembly)},
                              {"newton", b.weight},
                              {"center", json_of(b.center)},
                              {"fixed", b.fixed}});
  }
  if (report.judgement.verdict != Verdict::uncertain) json.update(judgement_json(pile, report.judgement));
  json["variants"] = Json::array();
  for (const Variant& v : report.variants) {
    Json variant = variant_json(v);
    variant.update(judgement_json(v.pile, v.judgement));
    json["variants"].push_back(std::move(variant));
  }
  return json.dump();
}

std::string check_stability_json(const std::string& text, const AssemblyPile& assembly) {
  try {
    const Json json = Json::parse(text);
    const Json& certificate = json.at("certificate");
    const Verdict verdict = verdict_in(json);
    const Pile pile = assembly.pile();
    if (std::string wrong = other_bodies(certificate, pile); !wrong.empty()) return wrong;
    std::vector<Variant> variants;
    for (const Json& v : certificate.at("variants")) {
      Variant& variant = variants.emplace_back();
      variant.touching = v.at("touching");
      variant.friction = v.at("friction");
      if (v.contains("tilt")) {
        variant.axis = vector_in(v.at("tilt").at("axis"));
        variant.tilt = v.at("tilt").at("angle");
      }
      if (variant.touching != 0.5 && variant.touching != 1 && variant.touching != 2)
        return "a variant has another tolerance of contacts";
      variant.pile = varied(assembly.pile(variant.touching), variant);
      if (std::string wrong = other_contacts(v, variant.pile); !wrong.empty()) return wrong;
      variant.judgement = judgement_in(v, verdict_in(v));
    }
    if (verdict == Verdict::uncertain) return check_flips(variants);
    for (const double factor : {0.5, 2.0}) {
      const auto at = std::ranges::find_if(variants, [&](const Variant& v) {
        return v.touching == factor && v.friction == 1 && v.tilt == 0 && v.judgement.verdict == verdict;
      });
      if (at == variants.end()) return fmt::format("it is not stated at {} times the tolerance of contacts", factor);
      if (std::string wrong = check_judgement(at->pile, at->judgement); !wrong.empty())
        return fmt::format("at {} times the tolerance of contacts: {}", factor, wrong);
    }
    if (std::string wrong = other_contacts(certificate, pile); !wrong.empty()) return wrong;
    return check_judgement(pile, judgement_in(certificate, verdict));
  } catch (const nlohmann::json::exception& e) {
    throw InputError("", fmt::format("the stability file cannot be read: {}", e.what()));
  }
}

}  // namespace dismantle::statics
