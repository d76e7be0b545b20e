/// Removes waypoints between two waypoints that a direct motion joins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "dismantle/run_context.h"

namespace dismantle::path {

/// From each kept waypoint, tries a direct motion to the last one and halves the
/// number of waypoints in between until it is free. `direct(a, b)`: true if the
/// motion between these waypoints is free.
template <class Waypoint, class Direct>
std::vector<Waypoint> shortcut_by_halving(const std::vector<Waypoint>& waypoints, const Direct& direct) {
  std::vector<Waypoint> kept;
  if (waypoints.empty()) return kept;
  kept.push_back(waypoints.front());
  for (std::size_t at = 0; at + 1 < waypoints.size();) {
    std::size_t to = waypoints.size() - 1;
    while (to > at + 1 && !direct(waypoints[at], waypoints[to])) to = at + (to - at + 1) / 2;
    kept.push_back(waypoints[to]);
    at = to;
  }
  return kept;
}

/// Tries pieces of half of the waypoints first, then of a quarter, and so on.
/// `stop()`: true to end early.
template <class Waypoint, class Direct, class Stop>
void shortcut_pieces(std::vector<Waypoint>& waypoints, const Direct& direct, const Stop& stop) {
  for (std::size_t piece = waypoints.size() / 2; piece > 1 && !stop(); piece /= 2)
    for (std::size_t k = 0; k + piece < waypoints.size() && !stop(); ++k)
      if (direct(waypoints[k], waypoints[k + piece]))
        waypoints.erase(waypoints.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                        waypoints.begin() + static_cast<std::ptrdiff_t>(k + piece));
      else
        k += piece - 1;
}

/// Tries `tries` random pairs of waypoints (Geraerts and Overmars 2007, section
/// 3.2). `direct(a, b, between)`, with indices a + 1 < b: returns true if they
/// can be joined, and sets the new waypoints between them.
template <class Waypoint, class Direct, class Stop>
void shortcut_at_random(std::vector<Waypoint>& waypoints, std::int64_t tries, Rng& rng, const Direct& direct,
                        const Stop& stop) {
  for (std::int64_t k = 0; k < tries && waypoints.size() > 2 && !stop(); ++k) {
    auto a = static_cast<std::size_t>(rng.below(waypoints.size()));
    auto b = static_cast<std::size_t>(rng.below(waypoints.size()));
    if (a > b) std::swap(a, b);
    if (b - a < 2) continue;
    std::vector<Waypoint> between;
    if (!direct(a, b, between)) continue;
    std::vector<Waypoint> shorter(waypoints.begin(), waypoints.begin() + static_cast<std::ptrdiff_t>(a) + 1);
    shorter.insert(shorter.end(), between.begin(), between.end());
    shorter.insert(shorter.end(), waypoints.begin() + static_cast<std::ptrdiff_t>(b), waypoints.end());
    waypoints = std::move(shorter);
  }
}

}  // namespace dismantle::path
