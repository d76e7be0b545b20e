#include "dismantle/statics/certificates.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kPresses = 1e-9;    // of the largest motion: above rounding, below what long chains give way
constexpr double kDifferent = 1e-3;  // of a weight: pressures; far above rounding

Vec3 relative(const Pile& pile, const Contact& c, const Vec3& at, const Motions& motion) {
  return motion[c.a].at(at - pile.bodies[c.a].center) - motion[c.b].at(at - pile.bodies[c.b].center);
}

double largest(const Pile& pile, const Motions& motion) {
  double most = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    most = std::max(most, motion[i].v.norm() + motion[i].w.norm() * pile.bodies[i].radius);
  return most;
}

std::string malformed(const Pile& pile, const Motions& motion) {
  if (motion.size() != pile.bodies.size()) return "the motion does not have one entry for each body";
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (!motion[i].v.allFinite() || !motion[i].w.allFinite()) return "the motion is not finite";
    if (pile.bodies[i].fixed && (motion[i].v.norm() > 0 || motion[i].w.norm() > 0))
      return fmt::format("body {} is fixed and moves", i);
  }
  return "";
}

std::string malformed(const Pile& pile, const ContactForces& forces) {
  if (forces.size() != pile.contacts.size()) return "the forces do not have one entry for each contact";
  for (std::size_t k = 0; k < forces.size(); ++k)
    if (forces[k].size() != pile.contacts[k].points.size())
      return fmt::format("contact {} does not have one force for each point", k);
  return "";
}

}  // namespace

Pile without_friction(Pile pile) {
  for (Contact& c : pile.contacts) c.friction = 0;
  return pile;
}

std::string check_equilibrium(const Pile& pile, const ContactForces& forces) {
  if (auto wrong = malformed(pile, forces); !wrong.empty()) return wrong;
  const std::size_t n = pile.bodies.size();
  std::vector<Vec3> sum(n, Vec3::Zero()), turn(n, Vec3::Zero());
  std::vector<double> carried(n, 0.0);
  const auto add = [&](std::uint32_t i, const Vec3& at, const Vec3& force) {
    sum[i] += force;
    turn[i] += (at - pile.bodies[i].center).cross(force);
    carried[i] += force.norm();
  };
  for (std::size_t i = 0; i < n; ++i)
    add(static_cast<std::uint32_t>(i), pile.bodies[i].center, pile.bodies[i].weight * pile.down);
  for (const Push& push : pile.pushes) add(push.body, push.at, push.force);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Contact& c = pile.contacts[k];
    for (std::size_t p = 0; p < forces[k].size(); ++p) {
      const Vec3& f = forces[k][p];
      if (!f.allFinite()) return fmt::format("a force of contact {} is not finite", k);
      const double normal = f.dot(c.normal), along = (f - normal * c.normal).norm();
      const double slack =
          kCertificateTolerance * (f.norm() + std::min(pile.bodies[c.a].weight, pile.bodies[c.b].weight));
      if (!c.bonded && !(along <= c.friction * normal + slack))
        return fmt::format("a force of contact {} lies outside of its friction cone", k);
      add(c.a, c.points[p], f);
      add(c.b, c.points[p], -f);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (pile.bodies[i].fixed) continue;
    const double slack = kCertificateTolerance * carried[i];
    if (!(sum[i].norm() <= slack)) return fmt::format("the forces on body {} do not add up to zero", i);
    if (!(turn[i].norm() <= slack * pile.bodies[i].radius))
      return fmt::format("the torques on body {} do not add up to zero", i);
  }
  return "";
}

std::string check_created(const Pile& pile, const ContactForces& forces, const Motions& motion) {
  if (auto wrong = malformed(pile, forces); !wrong.empty()) return wrong;
  if (auto wrong = malformed(pile, motion); !wrong.empty()) return wrong;
  const double most = largest(pile, motion), slack = kCertificateTolerance * most;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const Contact& c = pile.contacts[k];
    if (c.bonded) continue;
    for (std::size_t p = 0; p < forces[k].size(); ++p) {
      const Vec3& f = forces[k][p];
      const Vec3 moved = relative(pile, c, c.points[p], motion);
      const double depth = -moved.dot(c.normal), normal = f.dot(c.normal);
      const double light = kCertificateTolerance * std::max(pile.bodies[c.a].weight, pile.bodies[c.b].weight);
      if (f.norm() > light && !(depth > kPresses * most))
        return fmt::format("a force of contact {} acts where nothing presses", k);
      const Vec3 sliding = moved + depth * c.normal, friction = f - normal * c.normal;
      // Opposite directions: what is left of the friction after its part against the sliding.
      const double length = sliding.norm();
      const Vec3 against = length > 0 ? Vec3(-sliding / length) : Vec3(Vec3::Zero());
      const Vec3 rest = friction - std::max(0.0, friction.dot(against)) * against;
      if (length > slack && !(rest.norm() <= 1e-3 * f.norm() + light))
        return fmt::format("friction of contact {} does not oppose the sliding", k);
    }
  }
  return "";
}

std::string check_fall(const Pile& pile, const Motions& motion) {
  if (auto wrong = malformed(pile, motion); !wrong.empty()) return wrong;
  double work = 0, possible = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (pile.bodies[i].fixed) continue;
    work += pile.bodies[i].weight * motion[i].v.dot(pile.down);
    possible += pile.bodies[i].weight * (motion[i].v.norm() + motion[i].w.norm() * pile.bodies[i].radius);
  }
  for (const Push& push : pile.pushes) {
    if (pile.bodies[push.body].fixed) continue;
    const Vec3 moved = motion[push.body].at(push.at - pile.bodies[push.body].center);
    work += moved.dot(push.force);
    possible += moved.norm() * push.force.norm();
  }
  if (!(work > 0)) return "the load does no work in the motion";
  // Forces can be larger than weights by the share to which the motion violates a contact; it must be far below the
  // share of the work.
  const double slack = kCertificateTolerance * largest(pile, motion) * std::min(1.0, 1e2 * work / possible);
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    for (const Vec3& p : c.points) {
      const Vec3 moved = relative(pile, c, p, motion);
      const double apart = moved.dot(c.normal);
      const double sliding = (moved - apart * c.normal).norm();
      if (c.bonded ? !(moved.norm() <= slack) : !(apart >= c.friction * sliding - slack))
        return fmt::format("contact {} can do work against the motion", k);
    }
  }
  return "";
}

double lighter_weight(const Pile& pile, const Contact& contact) {
  const Body &a = pile.bodies[contact.a], &b = pile.bodies[contact.b];
  if (a.fixed && b.fixed) return 0;
  return a.fixed ? b.weight : b.fixed ? a.weight : std::min(a.weight, b.weight);
}

double pressure_of(const Contact& contact, const std::vector<Vec3>& forces) {
  double sum = 0;
  for (const Vec3& f : forces) sum += f.dot(contact.normal);
  return sum;
}

bool press_differently(const Pile& pile, const ContactForces& forces, const ContactForces& others) {
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    const double weight = lighter_weight(pile, c);
    if (!c.bonded && weight > 0 &&
        std::abs(pressure_of(c, forces[k]) - pressure_of(c, others[k])) > kDifferent * weight)
      return true;
  }
  return false;
}

std::string check_pressed_in(const Pile& pile, const ContactForces& forces, const ContactForces& others,
                             const Motions& slide) {
  for (const ContactForces* balanced : {&forces, &others})
    if (auto wrong = check_equilibrium(pile, *balanced); !wrong.empty()) return wrong;
  if (auto wrong = check_fall(without_friction(pile), slide); !wrong.empty()) return "without friction: " + wrong;
  return press_differently(pile, forces, others) ? "" : "both sets of forces press alike";
}

ContactForces spring_forces(const Pile& pile, const Motions& displacement) {
  ContactForces forces;
  if (displacement.size() != pile.bodies.size()) return forces;
  for (const Contact& c : pile.contacts) {
    const double stiffness = lighter_weight(pile, c);
    auto& at = forces.emplace_back();
    for (const Vec3& p : c.points) {
      const Vec3 elastic = -stiffness * relative(pile, c, p, displacement);
      const double normal = elastic.dot(c.normal);
      const Vec3 along = elastic - normal * c.normal;
      if (c.bonded || (normal >= 0 && along.norm() <= c.friction * normal)) {
        at.push_back(elastic);
        continue;
      }
      const double press = (normal + c.friction * along.norm()) / (1 + c.friction * c.friction);
      at.push_back(press > 0 ? Vec3(press * (c.normal + c.friction * along.stableNormalized())) : Vec3(Vec3::Zero()));
    }
  }
  return forces;
}

}  // namespace dismantle::statics
