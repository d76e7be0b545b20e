#include "dismantle/statics/hold_proof.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "dismantle/statics/certificates.h"

namespace dismantle::statics {
namespace {

using Group = std::vector<std::uint32_t>;

constexpr std::size_t kPerBody = 6;
constexpr std::size_t kMostSets = 1000000;  // that are tried for the bound

bool moves(const Motion& m) { return !m.v.isZero(0) || !m.w.isZero(0); }

constexpr int kDigits = 12;     // plenty for kCertificateTolerance, as a rule
constexpr int kAllDigits = 17;  // for what gives way far: forces are small differences of large displacements

void add_motion(const Motion& m, int digits, std::vector<double>& to) {
  for (const double x : {m.v.x(), m.v.y(), m.v.z(), m.w.x(), m.w.y(), m.w.z()}) {
    const std::string text = fmt::format("{:.{}g}", x, digits);
    std::from_chars(text.data(), text.data() + text.size(), to.emplace_back());
  }
}

Motion motion_at(const std::vector<double>& from, std::size_t at) {
  return {{from[at], from[at + 1], from[at + 2]}, {from[at + 3], from[at + 4], from[at + 5]}};
}

/// Index in a list of `count` things; none: it is no such number.
std::optional<std::uint32_t> index_in(double value, std::size_t count) {
  if (!(value >= 0) || value >= static_cast<double>(count) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

Pile with_held(Pile pile, const Group& held) {
  for (const std::uint32_t i : held) pile.bodies[i].fixed = true;
  return pile;
}

/// Is there a set of at most `most` bodies that meets all groups? `tried` counts sets; none: too many.
std::optional<bool> can_be_met(const std::vector<Group>& groups, std::size_t most, Group& chosen, std::size_t& tried) {
  if (++tried > kMostSets) return std::nullopt;
  const Group* open = nullptr;
  for (const Group& g : groups) {
    const bool met = std::any_of(g.begin(), g.end(), [&](std::uint32_t i) {
      return std::find(chosen.begin(), chosen.end(), i) != chosen.end();
    });
    if (!met && (open == nullptr || g.size() < open->size())) open = &g;
  }
  if (open == nullptr) return true;
  if (chosen.size() == most) return false;
  for (const std::uint32_t i : *open) {
    chosen.push_back(i);
    const std::optional<bool> met = can_be_met(groups, most, chosen, tried);
    chosen.pop_back();
    if (met != false) return met;
  }
  return false;
}

}  // namespace

void add_hold_proof(const HoldProof& proof, const Pile& pile, const std::string& state, Numbers& numbers) {
  auto& held = numbers[state + ".held"];
  held.assign(proof.held.begin(), proof.held.end());
  const Pile rest = with_held(pile, proof.held);
  auto& displacement = numbers[state + ".displacement"];
  Motions written(rest.bodies.size());
  for (const int digits : {kDigits, kAllDigits}) {
    displacement.clear();
    for (std::size_t i = 0; i < rest.bodies.size(); ++i) {
      if (rest.bodies[i].fixed) continue;
      add_motion(proof.displacement[i], digits, displacement);
      written[i] = motion_at(displacement, displacement.size() - kPerBody);
    }
    if (check_equilibrium(rest, spring_forces(rest, written)).empty()) break;
  }
  auto& falls = numbers[state + ".falls"];
  for (const Motions& motion : proof.falls) add_fall(motion, falls);
}

void add_fall(const Motions& motion, std::vector<double>& to) {
  to.push_back(static_cast<double>(std::count_if(motion.begin(), motion.end(), moves)));
  for (std::size_t i = 0; i < motion.size(); ++i)
    if (moves(motion[i])) {
      to.push_back(static_cast<double>(i));
      add_motion(motion[i], kDigits, to);
    }
}

std::optional<Motions> fall_at(const std::vector<double>& from, std::size_t& at, std::size_t bodies) {
  if (at >= from.size()) return std::nullopt;
  const auto moving = index_in(from[at++], bodies + 1);
  if (!moving || *moving == 0 || at + *moving * (kPerBody + 1) > from.size()) return std::nullopt;
  Motions motion(bodies);
  for (std::uint32_t k = 0; k < *moving; ++k, at += kPerBody + 1) {
    const auto body = index_in(from[at], bodies);
    if (!body || moves(motion[*body])) return std::nullopt;
    motion[*body] = motion_at(from, at + 1);
  }
  return motion;
}

std::optional<HoldProof> hold_proof_in(const Numbers& numbers, const std::string& state, const Pile& pile) {
  const std::size_t count = pile.bodies.size();
  const auto of = [&](const char* name) {
    const auto found = numbers.find(state + name);
    return found == numbers.end() ? nullptr : &found->second;
  };
  const auto *held = of(".held"), *displacement = of(".displacement"), *falls = of(".falls");
  if (held == nullptr || displacement == nullptr || falls == nullptr) return std::nullopt;
  HoldProof proof;
  for (const double value : *held) {
    const auto body = index_in(value, count);
    if (!body || pile.bodies[*body].fixed || (!proof.held.empty() && *body <= proof.held.back())) return std::nullopt;
    proof.held.push_back(*body);
  }
  const Pile rest = with_held(pile, proof.held);
  std::size_t next = 0;
  for (const Body& b : rest.bodies) {
    proof.displacement.emplace_back();
    if (b.fixed) continue;
    if (next + kPerBody > displacement->size()) return std::nullopt;
    proof.displacement.back() = motion_at(*displacement, next);
    next += kPerBody;
  }
  if (next != displacement->size()) return std::nullopt;
  for (std::size_t at = 0; at < falls->size();) {
    std::optional<Motions> motion = fall_at(*falls, at, count);
    if (!motion) return std::nullopt;
    proof.falls.push_back(std::move(*motion));
  }
  return proof;
}

std::string check_hold_proof(const Pile& pile, const HoldProof& proof) {
  const Pile rest = with_held(pile, proof.held);
  if (const std::string wrong = check_equilibrium(rest, spring_forces(rest, proof.displacement)); !wrong.empty())
    return "with its holds: " + wrong;
  std::vector<Group> groups;
  for (const Motions& motion : proof.falls) {
    if (const std::string wrong = check_fall(pile, motion); !wrong.empty())
      return fmt::format("motion of falling {}: {}", groups.size() + 1, wrong);
    Group& group = groups.emplace_back();
    for (std::uint32_t i = 0; i < motion.size(); ++i)
      if (moves(motion[i])) group.push_back(i);
  }
  if (proof.held.empty()) return "";
  Group chosen;
  std::size_t tried = 0;
  const std::optional<bool> fewer = can_be_met(groups, proof.held.size() - 1, chosen, tried);
  if (!fewer) return "too many sets of holds have to be tried";
  return *fewer ? "fewer holds meet all motions of falling" : "";
}

}  // namespace dismantle::statics
