#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body.h"
#include "sizes.h"

namespace dismantle::fasteners {
namespace {

/// Where the shank of a body ends and its head begins.
struct Split {
  double shank = 0;       // radius
  double head = 0;        // radius; 0: there is none
  double under_head = 0;  // height from the tip
  bool countersunk = false;
};

std::optional<Split> split_of(const View& view) {
  const std::size_t n = view.size();
  Split out;
  for (std::size_t i = n / 20; i < n / 4; ++i) out.shank = std::max(out.shank, view[i].outer_max());
  if (!(out.shank > 0)) return std::nullopt;
  // The shank is solid and round; a modelled thread is off its circle by a tenth.
  std::size_t bad = 0;
  for (std::size_t i = n / 20; i < n / 4; ++i) {
    const Outline o = outline_of(view[i].outer);
    bad += !view[i].filled || view[i].crossed < kRays || o.ratio() > 1.35 || (o.fold > 1 && o.ratio() > 1.06);
  }
  if (bad > n / 40) return std::nullopt;
  std::size_t first = n / 4;
  while (first < n && view[first].outer_max() <= 1.15 * out.shank) ++first;
  // A head may be lower than the distance of the sections.
  out.head = view.cut(0.999 * view.height()).outer_max();
  for (std::size_t i = first; i < n; ++i) out.head = std::max(out.head, view[i].outer_max());
  if (out.head <= 1.15 * out.shank) {
    out.head = 0;
    out.under_head = view.height();
    return out;
  }
  if (out.head > 6 * out.shank || out.head < 1.2 * out.shank) return std::nullopt;
  const double grown = out.head - out.shank;
  const auto passes = [&](double radius) {
    std::size_t i = std::min(first, n - 1);
    while (i < n && view[i].outer_max() <= radius) ++i;
    return view.rise(view.z(i - 1), i < n ? view.z(i) : view.height(), radius);
  };
  const double begin = passes(out.shank + 0.2 * grown), end = passes(out.shank + 0.9 * grown);
  const double slope = (end - begin) / (0.7 * grown);
  out.countersunk = slope > 0.5 && slope < 2 && view.cut(view.height() - 0.03 * grown).outer_max() > 0.85 * out.head &&
                    view.height() - end < 0.4 * (end - begin) + 0.1 * out.shank;
  out.under_head = out.countersunk ? begin - 0.2 * grown * slope : begin;
  return out;
}

/// How a screw is known: by its drive, its thread or the sizes of its head.
struct Evidence {
  DriveFound drive;
  double pitch = 0;
  const Thread* thread = nullptr;
  double confidence = 0;
  std::string reason;
};

Evidence evidence_of(const View& view, const Split& split) {
  Evidence e;
  const double mm = view.mm(), head_height = view.height() - split.under_head;
  e.drive = recess_of(view);
  const bool hole = e.drive.depth > 0 && e.drive.drive == Drive::none;
  if (e.drive.drive == Drive::none && split.head > 0) {
    const double depth = e.drive.depth;
    for (const double share : {0.5, 0.7, 0.3, 0.85})
      if (e.drive.drive == Drive::none) e.drive = grip_of(view.cut(split.under_head + share * head_height), mm);
    e.drive.depth = depth;
  }
  e.pitch = pitch_at(view, 0.5 * split.under_head, split.shank, false);
  if (e.pitch == 0) e.pitch = pitch_at(view, 0.3 * split.under_head, split.shank, false);
  const double head = e.drive.drive == Drive::outer_hex ? 0 : 2 * split.head * mm;
  e.thread = external_thread(2 * split.shank * mm, {e.pitch * mm, head, e.drive.size, e.drive.drive});
  if (hole && (e.drive.drive == Drive::outer_hex || e.drive.drive == Drive::square)) return e;  // a stand-off
  if (e.drive.drive != Drive::none) {
    e.confidence = 0.95;
    e.reason = e.drive.drive == Drive::torx ? fmt::format("Torx {:g}", e.drive.size)
               : e.drive.drive == Drive::cross
                   ? "cross recess"
                   : fmt::format("{} {}", to_string(e.drive.drive), number(std::round(e.drive.size * 20) / 20));
  } else if (e.pitch > 0) {
    e.confidence = 0.9;
  } else if (e.thread != nullptr && split.head > 0 &&
             std::abs(2 * split.shank * mm - e.thread->diameter) < 0.03 * e.thread->diameter) {
    const auto fits = [&](double size) { return size > 0 && std::abs(head - size) < 0.03 * size; };
    const Thread& t = *e.thread;
    const double high = head_height * mm;
    if (fits(t.knurl_high) || fits(t.knurl_flat)) {
      e.drive.drive = Drive::knurl;
      e.drive.size = head;
      e.confidence = 0.85;
      e.reason = fmt::format("head of {} mm as of a knurled screw", number(head));
    } else if ((fits(t.cap) && high < 1.1 * t.diameter) ||
               ((fits(t.button) || fits(t.pan)) && high < 0.8 * t.diameter) || (fits(t.flat) && split.countersunk)) {
      e.confidence = 0.75;
      e.reason = fmt::format("head of {} mm on a shank of {} mm, as in the tables", number(head), number(t.diameter));
    }
  }
  if (e.pitch > 0)
    e.reason += fmt::format("{}thread of pitch {} mm", e.reason.empty() ? "" : ", ",
                            number(std::round(e.pitch * mm * 100) / 100));
  return e;
}

Shape shape_of(const View& view, const Split& split) {
  Shape s;
  s.axis = view.axis();
  s.top = view.top();
  s.height = view.height();
  s.radius = std::max(split.head, split.shank);
  s.shank_radius = split.shank;
  s.head_height = view.height() - split.under_head;
  return s;
}

std::optional<Shape> screw_in(const View& view) {
  const auto split = split_of(view);
  if (!split) return std::nullopt;
  const double mm = view.mm(), diameter = 2 * split->shank * mm;
  const Evidence e = evidence_of(view, *split);
  Shape s = shape_of(view, *split);
  s.threaded = e.pitch > 0;
  s.drive = e.drive.drive;
  s.drive_size = e.drive.size;
  s.recess_depth = e.drive.depth;
  const double head_height = s.head_height * mm;
  const bool grip = e.drive.drive == Drive::outer_hex || e.drive.drive == Drive::square;
  if (split->head > 0 && grip && (e.confidence == 0 || head_height > 1.7 * diameter) &&
      split->shank < 0.8 * split->head) {
    if (e.thread == nullptr || diameter > 13 || e.drive.drive != Drive::outer_hex) return std::nullopt;
    s.kind = Kind::standoff;
    s.confidence = 0.7;
    s.length = std::round(head_height * 100) / 100;
    s.size = e.thread->name;
    s.reason = fmt::format("hexagon of {} mm with a stud", number(e.drive.size));
    return s;
  }
  if (e.confidence == 0) return std::nullopt;
  if (split->head == 0) {  // a set screw, or a threaded rod
    std::size_t even = 0;
    for (std::size_t i = 0; i < view.size(); ++i) even += view[i].outer_max() > 0.85 * split->shank;
    if (even < view.size() * 7 / 10 || view.height() < 1.3 * split->shank) return std::nullopt;
    if (e.drive.drive == Drive::none && view.height() > 40 * split->shank) return std::nullopt;
  } else if (head_height > 3.2 * diameter) {
    return std::nullopt;
  }
  s.kind = Kind::screw;
  s.confidence = e.confidence;
  const double length = mm * (split->countersunk ? view.height() : split->under_head);
  s.length = nominal_length(length, e.thread != nullptr && e.thread->inch);
  if (e.thread != nullptr) s.size = e.thread->name;
  s.reason = fmt::format("{}, {}{}", e.reason,
                         split->head == 0     ? "no head"
                         : split->countersunk ? "countersunk head"
                                              : "head",
                         e.thread != nullptr ? fmt::format(", shank of {} mm", number(diameter))
                                             : fmt::format("; its shank of {} mm is in no table", number(diameter)));
  return s;
}

}  // namespace

std::optional<Shape> screw_of(const Body& body) {
  std::optional<Shape> best;
  for (const bool flipped : {false, true}) {
    auto s = screw_in(View(body, flipped));
    if (s && (!best || s->confidence > best->confidence)) best = std::move(s);
  }
  return best;
}

std::optional<Shape> screw_form(const Body& body) {
  std::optional<Shape> best;
  for (const bool flipped : {false, true}) {
    const View view(body, flipped);
    const auto split = split_of(view);
    if (!split || split->head == 0) continue;  // without a head, either end may be the tip
    if (best && best->shank_radius <= split->shank) continue;
    best = shape_of(view, *split);
    best->kind = Kind::screw;
    best->reason = "head and shank of no known size";
  }
  return best;
}

std::optional<Shape> bar_of(const Body& body) {
  const View view(body, false);
  double largest = 0;
  for (std::size_t i = 0; i < view.size(); ++i) largest = std::max(largest, view[i].outer_max());
  std::size_t full = 0, solid = 0, round = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    full += view[i].outer_max() > 0.97 * largest;
    solid += view[i].filled;
    round += outline_of(view[i].outer).fold == 0;
  }
  const std::size_t n = view.size();
  const double slender = view.height() / (2 * largest);
  if (solid < n * 17 / 20 || round < n * 9 / 10 || slender < 1.2) return std::nullopt;
  Shape s;
  s.axis = view.axis();
  s.top = view.top();
  s.height = view.height();
  s.radius = s.shank_radius = largest;
  const double diameter = 2 * largest * body.mm, pin = pin_diameter(diameter);
  s.length = std::round(view.height() * body.mm * 10) / 10;
  s.size = number(pin > 0 ? pin : std::round(diameter * 100) / 100);
  const bool plain = full > n * 8 / 10;
  s.kind = plain && slender <= 12 && pin > 0 ? Kind::pin : slender > 3 ? Kind::shaft : Kind::other;
  s.confidence = s.kind == Kind::pin ? 0.8 : s.kind == Kind::shaft ? (plain ? 0.7 : 0.5) : 0;
  s.reason = fmt::format("{} of {} mm, {} mm long", plain ? "plain cylinder" : "turned part", s.size, number(s.length));
  if (s.kind == Kind::other) return std::nullopt;
  return s;
}

}  // namespace dismantle::fasteners
