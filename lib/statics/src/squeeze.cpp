#include "squeeze.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "dismantle/statics/balance.h"
#include "dismantle/statics/certificates.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kMoves = 1e-3;                           // of the largest motion
constexpr double kSqueezes[] = {0.1, 0.01, -0.1, -0.01};  // of the weight of the lighter body
constexpr double kMore = 2;                               // of the pressure: as much as a contact is squeezed at least

/// The largest motion of a point of the contact, a against b.
double moved_at(const Pile& pile, const Contact& c, const Motions& motion) {
  double most = 0;
  for (const Vec3& p : c.points)
    most = std::max(most,
                    (motion[c.a].at(p - pile.bodies[c.a].center) - motion[c.b].at(p - pile.bodies[c.b].center)).norm());
  return most;
}

}  // namespace

ContactForces squeezed_forces(const Pile& pile, const ContactForces& forces, const Motions& motion,
                              const std::function<bool()>& stop) {
  double most = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    most = std::max(most, motion[i].v.norm() + motion[i].w.norm() * pile.bodies[i].radius);
  std::vector<std::pair<double, std::size_t>> order;  // those that press most against their weight first
  for (std::size_t k = 0; k < pile.contacts.size(); ++k) {
    const Contact& c = pile.contacts[k];
    const double weight = lighter_weight(pile, c);
    if (c.bonded || !(weight > 0) || !(moved_at(pile, c, motion) > kMoves * most)) continue;
    order.emplace_back(-pressure_of(c, forces[k]) / weight, k);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [pressure, k] : order) {
    const Contact& c = pile.contacts[k];
    const double weight = lighter_weight(pile, c);
    std::vector<double> squeezes;
    for (const double share : kSqueezes) squeezes.push_back(share * weight);
    // The solver takes off what is squeezed where the same pressure suffices; more than that it cannot take off.
    squeezes.push_back(kMore * std::max(weight, pressure_of(c, forces[k])));
    for (const double squeeze : squeezes) {
      if (stop && stop()) return {};
      const Vec3 push = squeeze / static_cast<double>(c.points.size()) * c.normal;
      Pile squeezed = pile;
      for (const Vec3& p : c.points) {
        squeezed.pushes.push_back({c.a, p, push});
        squeezed.pushes.push_back({c.b, p, -push});
      }
      Balance found = balance(squeezed, FrictionLaw::associated, stop);
      if (!found.balanced) continue;
      for (Vec3& f : found.forces[k]) f += push;
      if (press_differently(pile, forces, found.forces) && check_equilibrium(pile, found.forces).empty())
        return std::move(found.forces);
    }
  }
  return {};
}

}  // namespace dismantle::statics
