#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "body.h"
#include "sizes.h"

namespace dismantle::fasteners {
namespace {

double rounded(double value, double step) { return std::round(value / step) * step; }

Shape placed(const View& view, double outer, double hole) {
  Shape s;
  s.axis = view.axis();
  s.top = view.top();
  s.height = view.height();
  s.radius = outer;
  s.shank_radius = hole;
  return s;
}

/// The washer of the tables with this hole and outside, else one with this hole.
const Thread* washer_thread(double hole, double outside) {
  for (const Thread& t : threads()) {
    if (hole < 1.02 * t.diameter || hole > 1.17 * t.diameter) continue;
    for (const double size : {t.washer_outer, t.washer_large, t.washer_small})
      if (size > 0 && std::abs(outside - size) < 0.03 * size) return &t;
  }
  for (const Thread& t : threads())
    if (!t.inch && std::abs(hole - t.washer) < 0.015 * t.washer) return &t;
  return nullptr;
}

/// How the outer radius runs along the axis.
struct Profile {
  double outer = 0, least = 0;  // over the middle four fifths
  double hole = 0, widest = 0;  // smallest and largest inner radius there
  std::size_t round = 0, through = 0, teeth = 0;
  int count = 0;       // of teeth
  bool faced = false;  // its faces have grooves between the rims
  double filled = 0;   // area of the sections, relative to the ring between hole and outside
};

Profile profile_of(const View& view) {
  Profile p;
  const std::size_t n = view.size(), from = n / 10, to = n - n / 10;
  std::map<int, std::size_t> teeth;
  double area = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Section& s = view[i];
    p.through += !s.filled && s.crossed == kRays;
    if (i < from || i >= to) continue;
    p.round += outline_of(s.outer).fold == 0;
    p.outer = std::max(p.outer, s.outer_max());
    p.least = p.least == 0 ? s.outer_max() : std::min(p.least, s.outer_max());
    const double hole = s.inner_min();
    p.hole = p.hole == 0 ? hole : std::min(p.hole, hole);
    p.widest = std::max(p.widest, hole);
    area += s.area;
    if (const int found = teeth_of(s.outer)) ++teeth[found];
  }
  for (const auto& [count, sections] : teeth)
    if (sections > p.teeth) p.teeth = sections, p.count = count;
  const double sections = static_cast<double>(to - from);
  for (const std::size_t end : {std::size_t{0}, n - 1})
    p.faced = p.faced || (view[end].area < 0.85 * view[n / 2].area && view[end].outer_max() > 0.97 * p.outer &&
                          view[end].inner_min() < 1.05 * p.hole);
  p.filled = area / (sections * std::numbers::pi * (p.outer * p.outer - p.hole * p.hole));
  return p;
}

std::optional<Shape> plain_ring(const View& view, const Profile& p) {
  const double mm = view.mm(), hole = 2 * p.hole * mm, outside = 2 * p.outer * mm, high = view.height() * mm;
  const double wall = (outside - hole) / 2;
  Shape s = placed(view, p.outer, p.hole);
  s.length = rounded(high, 0.01);
  const std::string dimensions =
      fmt::format("{}x{}x{}", number(rounded(outside, 0.01)), number(rounded(hole, 0.01)), number(rounded(high, 0.01)));
  s.reason = fmt::format("plain ring of {} mm", dimensions);
  s.size = dimensions;
  if (high < 0.8 * wall) {
    const Thread* thread = washer_thread(hole, outside);
    if (thread != nullptr) s.size = thread->name;
    if (thread == nullptr && (outside > 5 * hole || outside > 120 || high > 0.2 * outside || high < 0.02 * outside))
      return std::nullopt;
    s.kind = Kind::washer;
    s.confidence = thread != nullptr ? 0.9 : 0.75;
    if (thread != nullptr) s.reason += fmt::format(", as a washer for {}", thread->name);
    return s;
  }
  if (outside > 120 || wall < 0.02 * outside) return std::nullopt;
  s.kind = Kind::spacer;
  s.confidence = high < 10 * outside ? 0.7 : 0.4;
  return s;
}

}  // namespace

int teeth_of(const Radii& radii) {
  const double largest = *std::max_element(radii.begin(), radii.end());
  double smallest = largest;
  for (const double r : radii) smallest = std::min(smallest, r);
  if (smallest <= 0 || largest - smallest < 0.025 * largest) return 0;
  const double level = (largest + smallest) / 2;
  std::vector<std::size_t> rises;
  for (std::size_t k = 0; k < kRays; ++k)
    if (radii[k] <= level && radii[(k + 1) % kRays] > level) rises.push_back(k);
  if (rises.size() < 10) return 0;
  const double step = static_cast<double>(kRays) / static_cast<double>(rises.size());
  for (std::size_t i = 0; i < rises.size(); ++i) {
    const std::size_t next = rises[(i + 1) % rises.size()];
    const double gap = static_cast<double>((next + kRays - rises[i]) % kRays);
    if (std::abs(gap - step) > 1.5 + 0.2 * step) return 0;
  }
  return static_cast<int>(rises.size());
}

std::optional<Shape> nut_of(const Body& body) {
  const View view(body, false);
  const std::size_t n = view.size();
  // Sections with one hexagon or square, and a hole.
  std::size_t hexes = 0, squares = 0, open = 0, filled = 0;
  double flats = 0, hole = 0;
  std::vector<double> holes;
  for (std::size_t i = 0; i < n; ++i) {
    const DriveFound grip = grip_of(view[i], body.mm);
    open += !view[i].filled && view[i].crossed == kRays;
    filled += view[i].filled;
    if (grip.drive == Drive::none) continue;
    (grip.drive == Drive::outer_hex ? hexes : squares) += 1;
    flats = std::max(flats, grip.size);
    if (!view[i].filled) holes.push_back(2 * view[i].inner_min() * body.mm);
  }
  const bool square = squares > hexes;
  if (std::max(hexes, squares) < n / 4 || holes.size() < n / 4) return std::nullopt;
  const bool cap = filled > 0;
  if (cap && (filled > n / 2 || (view[0].filled && view[n - 1].filled))) return std::nullopt;
  std::nth_element(holes.begin(), holes.begin() + static_cast<long>(holes.size() / 2), holes.end());
  hole = holes[holes.size() / 2];
  double outer = 0;
  for (std::size_t i = 0; i < n; ++i) outer = std::max(outer, view[i].outer_max());
  Shape s = placed(cap && view[0].filled ? View(body, true) : view, outer, hole / 2 / body.mm);
  double pitch = 0;
  for (const double share : {0.5, 0.4, 0.6})
    if (pitch == 0) pitch = pitch_at(view, share * view.height(), hole / 2 / body.mm, true);
  s.threaded = pitch > 0;
  const Outline bore = outline_of(view[n / 2].inner);
  if (!s.threaded && !cap && bore.ratio() > 1.12) return std::nullopt;  // its hole is not about its axis
  const Thread* thread = internal_thread(hole, flats, square);
  const double high = view.height() * body.mm, diameter = thread != nullptr ? thread->diameter : hole;
  s.drive = square ? Drive::square : Drive::outer_hex;
  s.drive_size = flats;
  s.length = rounded(high, 0.01);
  if (thread != nullptr) s.size = thread->name;
  s.reason = fmt::format("{} of {} mm with a hole of {} mm{}", square ? "square" : "hexagon",
                         number(rounded(flats, 0.01)), number(rounded(hole, 0.01)), s.threaded ? ", thread" : "");
  if (flats > 4 * hole) return std::nullopt;  // a block with a hole
  if (high > 2.2 * diameter) {
    s.kind = Kind::standoff;
    s.confidence = 0.8;
    return s;
  }
  if (flats < 1.25 * hole || (square && thread == nullptr)) return std::nullopt;
  s.kind = Kind::nut;
  s.confidence = thread != nullptr || s.threaded ? 0.95 : 0.6;
  if (thread == nullptr) s.reason += "; no size of the tables fits";
  return s;
}

std::optional<Shape> nut_form(const Body& body) {
  const View view(body, false);
  const Profile p = profile_of(view);
  const std::size_t n = view.size(), middle = n - 2 * (n / 10);
  // A round one is the ring in a lock nut, or turned by hand.
  if (p.through < n * 9 / 10 || !(p.hole > 0) || p.round > middle / 2) return std::nullopt;
  if (outline_of(view[n / 2].inner).ratio() > 1.12) return std::nullopt;  // its hole is not about its axis
  Shape s = placed(view, p.outer, p.hole);
  s.kind = Kind::nut;
  s.reason = "hole of no known size";
  return s;
}

std::optional<Shape> ring_of(const Body& body) {
  const View view(body, false);
  const Profile p = profile_of(view);
  const std::size_t n = view.size(), middle = n - 2 * (n / 10);
  if (p.through < n * 9 / 10 || !(p.hole > 0)) return std::nullopt;
  const double mm = body.mm, hole = 2 * p.hole * mm, outside = 2 * p.outer * mm, high = view.height() * mm;
  Shape s = placed(view, p.outer, p.hole);
  if (p.teeth > middle / 4) {
    const bool flanged = p.teeth < middle * 8 / 10;
    s.kind = flanged ? Kind::pulley : Kind::gear;
    s.confidence = 0.7;
    s.size = fmt::format("{} teeth", p.count);
    s.reason = fmt::format("{} teeth on a circle of {} mm{}", p.count, number(rounded(outside, 0.1)),
                           flanged ? ", flanges" : "");
    return s;
  }
  if (p.round < middle * 9 / 10) return std::nullopt;
  const bool straight = p.least > 0.96 * p.outer, bored = p.widest < 1.04 * p.hole;
  const BearingSize* bearing = bearing_of(hole, outside, high);
  if (straight && bearing != nullptr && (p.faced || p.filled < 0.97 || body.shells > 1 || !bored)) {
    s.kind = Kind::bearing;
    s.confidence = 0.85;
    s.size = fmt::format("{}x{}x{}", number(bearing->bore), number(bearing->outside), number(rounded(high, 0.1)));
    s.reason = fmt::format("grooved ring with the bore, outside and width of bearing {}", bearing->name);
    return s;
  }
  if (straight && bored && p.filled > 0.9) return plain_ring(view, p);
  if (!straight && p.least < 0.9 * p.outer && p.least > 1.2 * p.hole && outside < 150) {
    const double ends = std::min(view[n / 8].outer_max(), view[n - 1 - n / 8].outer_max());
    const double mid = view[n / 2].outer_max();
    if (mid < 0.93 * ends || mid > 1.08 * ends) {
      s.kind = mid < ends ? Kind::pulley : Kind::wheel;
      s.confidence = 0.4;
      s.reason = mid < ends ? "ring with a groove around it" : "ring with a rim";
      return s;
    }
  }
  return std::nullopt;
}

}  // namespace dismantle::fasteners
