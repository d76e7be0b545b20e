#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "body.h"
#include "sizes.h"

namespace dismantle::fasteners {

double View::rise(double low, double high, double radius) const {
  for (int k = 0; k < 14; ++k) {
    const double middle = (low + high) / 2;
    (cut(middle).outer_max() > radius ? high : low) = middle;
  }
  return high;
}

DriveFound grip_of(const Section& section, double mm) {
  const Outline o = outline_of(section.outer);
  if (section.crossed < kRays) return {};
  if (o.fold == 6 && o.ratio() > 1.1 && o.ratio() < 1.18) return {Drive::outer_hex, 2 * o.smallest * mm};
  if (o.fold == 4 && o.ratio() > 1.33 && o.ratio() < 1.45) return {Drive::square, 2 * o.smallest * mm};
  return {};
}

static DriveFound recess_at(const Section& section, double mm) {
  const Outline o = outline_of(section.inner);
  const double ratio = o.ratio();
  if (o.fold == 0 || o.fold == 1) return {};
  // An open slot meets nothing along its direction.
  if (section.crossed < kRays * 11 / 20) return {};
  if (section.crossed < kRays) return {o.fold == 2 ? Drive::slot : Drive::cross, 2 * o.smallest * mm};
  if (o.fold == 6 && ratio > 1.1 && ratio < 1.19) return {Drive::hex_socket, 2 * o.smallest * mm};
  if (o.fold == 6 && ratio >= 1.19 && ratio < 1.7) return {Drive::torx, double(torx_number(2 * o.largest * mm))};
  if (o.fold == 4 && ratio > 1.33 && ratio < 1.46) return {Drive::square, 2 * o.smallest * mm};
  if (o.fold == 4 && ratio >= 1.46) return {Drive::cross, 2 * o.largest * mm};
  if (o.fold == 2 && ratio >= 1.5) return {Drive::slot, 2 * o.smallest * mm};
  return {};
}

DriveFound recess_of(const View& view) {
  std::size_t deep = 0;  // sections of the recess
  while (deep < view.size() && !view[view.size() - 1 - deep].filled) ++deep;
  if (deep == 0 || deep >= view.size() * 4 / 5) return {};
  const double depth = view.height() - (view.z(view.size() - deep) + view.z(view.size() - deep - 1)) / 2;
  DriveFound best;
  // A chamfer at its mouth and a cone at its bottom have other outlines.
  for (const double share : {0.5, 0.35, 0.65, 0.8, 0.2}) {
    best = recess_at(view.cut(view.height() - share * depth), view.mm());
    if (best.drive != Drive::none) break;
  }
  best.depth = depth;
  return best;
}

double pitch_at(const View& view, double z, double radius, bool internal) {
  constexpr int kCuts = 24;
  const double step = radius / 20;
  if (z - kCuts / 2 * step < 0 || z + kCuts / 2 * step > view.height()) return 0;
  double turned = 0, before = 0;
  int steps = 0, against = 0;
  for (int i = 0; i < kCuts; ++i) {
    const Section s = view.cut(z + (i - kCuts / 2) * step);
    const Radii& radii = internal ? s.inner : s.outer;
    std::complex<double> wave = 0;
    for (std::size_t k = 0; k < kRays; ++k)
      wave += std::polar(radii[k], 2 * std::numbers::pi * static_cast<double>(k) / kRays);
    if (2 * std::abs(wave) / kRays < 0.01 * radius) return 0;
    const double phase = std::arg(wave);
    if (i > 0) {
      const double d = std::remainder(phase - before, 2 * std::numbers::pi);
      turned += d;
      ++steps;
      against += turned * d < 0;
    }
    before = phase;
  }
  if (against > 2 || std::abs(turned) < 1) return 0;
  const double pitch = 2 * std::numbers::pi * steps * step / std::abs(turned);
  return pitch < radius ? pitch : 0;
}

static double off(double a, double b) { return b > 0 ? std::abs(a - b) / b : 1; }

const Thread* external_thread(double diameter, const ThreadClues& clues) {
  const Thread* best = nullptr;
  double least = 0.1;
  for (const Thread& t : threads()) {
    // Drawn at its nominal diameter, or at the pitch diameter or the root.
    double cost = off(diameter, t.diameter);
    if (cost > 0.03) {
      if (diameter > t.diameter || diameter < 0.97 * t.root()) continue;
      cost = 0.06 + 0.2 * std::min(off(diameter, t.root()), off(diameter, t.diameter - 0.6495 * t.pitch));
    }
    if (t.inch) cost += 0.01;
    if (clues.pitch > 0) cost += off(clues.pitch, t.pitch) < 0.08 ? -0.03 : 0.01;
    if (clues.head > 0)
      for (const double head : {t.cap, t.button, t.flat, t.pan, t.knurl_high, t.knurl_flat, t.nut})
        if (off(clues.head, head) < 0.03) {
          cost -= 0.03;
          break;
        }
    if (clues.key > 0 && clues.drive == Drive::hex_socket)
      for (const double key : {t.key, t.button_key, t.set_key})
        if (off(clues.key, key) < 0.06) {
          cost -= 0.03;
          break;
        }
    if (clues.key > 0 && clues.drive == Drive::outer_hex &&
        std::min(off(clues.key, t.nut), off(clues.key, t.nut_old)) < 0.03)
      cost -= 0.04;
    if (cost < least) best = &t, least = cost;
  }
  return best;
}

const Thread* internal_thread(double hole, double across_flats, bool square) {
  const Thread* best = nullptr;
  double least = 0.2;
  for (const Thread& t : threads()) {
    if (hole < 0.94 * t.minor() || hole > 1.09 * t.diameter) continue;
    // Square nuts of DIN 557 and 562 are as wide as hexagon nuts. Other makers' hexagons differ by some tenths.
    double cost = std::min(off(across_flats, t.nut), off(across_flats, t.nut_old)) + (square ? 0.02 : 0);
    cost += 0.3 * std::min(off(hole, t.diameter), off(hole, t.minor())) + (t.inch ? 0.01 : 0);
    if (cost < least) best = &t, least = cost;
  }
  return best;
}

}  // namespace dismantle::fasteners
