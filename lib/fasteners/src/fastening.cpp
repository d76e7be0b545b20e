#include "dismantle/fasteners/fastening.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/executor.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/box_index.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/stop_if_asked.h"
#include "sizes.h"

namespace dismantle::fasteners {
namespace {

constexpr double kTight = 0.97;    // of the thread's diameter: a narrower bore is threaded
constexpr double kNoPlay = 1.005;  // of the thread's diameter: a narrower bore may be a thread drawn at its diameter
constexpr double kPlay = 1.02;     // of the thread's diameter: a wider bore has play
constexpr double kGap = 0.25;      // diameters between parts that count as lying on each other
constexpr int kPairs = 12;         // directions across the axis, each with its opposite
constexpr int kAround = 8, kBeside = 2;  // of them, those that meet the part: a hole, a slot

/// The kind that counts: what the assembly says, else the shape.
Kind kind_of(const Part& part, const Shape& shape) {
  if (part.kind) return kind_from_string(part.kind->kind).value_or(Kind::other);
  return shape.kind;
}

/// "M3" of "M3x10".
std::string thread_name(const Part& part, const Shape& shape) {
  const std::string size = part.kind && !part.kind->size.empty() ? part.kind->size : shape.size;
  return size.substr(0, size.find('x'));
}

const Thread* thread_named(const std::string& name) {
  for (const Thread& t : threads())
    if (name == t.name) return &t;
  return nullptr;
}

/// A stretch of the screw's axis that a part surrounds. Distances from the head's underside to the tip.
struct Stretch {
  PartId part;
  double from, to;
  double bore;  // least radius; 0: the axis is in solid material
  bool around;  // on all sides; false: beside it, as a slot is
  bool threads = false;
};

class Screw {
 public:
  Screw(const Assembly& assembly, const geometry::BoxIndex& boxes, std::span<const Shape> shapes,
        const SurfaceOf& surface, PartId id, double mm)
      : assembly_(assembly), boxes_(boxes), shapes_(shapes), surface_(surface), id_(id), shape_(shapes[id]), mm_(mm) {
    const Thread* thread = thread_named(thread_name(assembly.parts[id], shape_));
    known_ = thread != nullptr;
    diameter_ = thread != nullptr ? thread->diameter / mm : 2 * shape_.shank_radius;
    length_ = shape_.height - shape_.head_height;
    headed_ = shape_.head_height > 0;
    seat_ = shape_.top - shape_.head_height * shape_.axis;
    across_ = shape_.axis.unitOrthogonal();
    step_ = std::max(0.1 * diameter_, (length_ + shape_.head_height + 2 * diameter_) / 240);
  }

  Fastening fastening() {
    const double widest = headed_ ? 0.98 * shape_.radius : 1.2 * radius();
    const double first = -shape_.head_height, end = length_ + 2 * diameter_;
    Aabb around;
    around.extend(at(first));
    around.extend(at(end));
    around.inflate(widest);
    for (const std::size_t part : boxes_.overlapping(around)) look_at(assembly_.parts[part], first, end, widest);
    std::stable_sort(stretches_.begin(), stretches_.end(),
                     [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    out_.screw = id_;
    find_thread();
    find_clamped();
    find_faults();
    return std::move(out_);
  }

 private:
  Eigen::Vector3d at(double t) const { return seat_ - t * shape_.axis; }
  double radius() const { return diameter_ / 2; }
  Kind kind(PartId part) const { return kind_of(assembly_.parts[part], shapes_[part]); }
  bool is_nut(PartId part) const {
    const Kind k = kind(part);
    return k == Kind::nut || k == Kind::insert || k == Kind::standoff;
  }
  bool is_hexagon(PartId part) const {
    const Drive drive = shapes_[part].drive;
    return kind(part) == Kind::nut && shapes_[part].kind == Kind::nut &&
           (drive == Drive::outer_hex || drive == Drive::square);
  }
  bool contains(const std::vector<PartId>& list, PartId part) const {
    return std::find(list.begin(), list.end(), part) != list.end();
  }

  /// Along the axis from `first` to `end`, up to `widest` from it.
  void look_at(const Part& part, double first, double end, double widest) {
    const Kind k = kind(part.id);
    if (part.id == id_ || part.open || k == Kind::screw || k == Kind::spring) return;
    const TriangleBvh& surface = surface_(part.id);
    bool open = false;
    const auto count = static_cast<int>(std::ceil((end - first) / step_));
    for (int i = 0; i < count; ++i) {
      const double t = first + (i + 0.5) * step_;
      const auto found = around_at(surface, t, widest);
      const Stretch* last = open ? &stretches_.back() : nullptr;
      if (found && last != nullptr && last->around == found->around && (last->bore > 0) == (found->bore > 0)) {
        stretches_.back().to = t + step_ / 2;
        stretches_.back().bore = std::min(stretches_.back().bore, found->bore);
      } else if (found) {
        stretches_.push_back({part.id, t - step_ / 2, t + step_ / 2, found->bore, found->around});
      }
      open = found.has_value();
    }
  }

  struct Around {
    double bore;
    bool around;
  };
  std::optional<Around> around_at(const TriangleBvh& surface, double t, double widest) const {
    const Eigen::Vector3d center = at(t), other = shape_.axis.cross(across_);
    const auto inside = [&](double radius, double angle) {
      return surface.inside(center + radius * (std::cos(angle) * across_ + std::sin(angle) * other));
    };
    const ClosestPoint near = surface.closest(center, widest);
    if (!(near.distance < widest) && !surface.inside(center)) return std::nullopt;
    double bore = near.distance;
    if (surface.inside(center)) {
      bore = 0;
    } else if (std::abs((near.point - center).dot(shape_.axis)) > 0.3 * near.distance) {
      // The ground of a hole, or an edge, is nearer than the wall.
      const auto wall = [&](double radius) {
        return inside(radius, 0.1) || inside(radius, 1.7) || inside(radius, 3.3) || inside(radius, 4.9);
      };
      while (bore < widest && !wall(bore)) bore += 0.02 * diameter_;
      if (!(bore < widest)) return std::nullopt;
    }
    const double ring = std::max(bore + 0.05 * diameter_, 1.08 * radius());
    int pairs = 0;
    for (int k = 0; k < kPairs; ++k) {
      const double angle = std::numbers::pi * (k + 0.25) / kPairs;
      pairs += inside(ring, angle) && inside(ring, angle + std::numbers::pi);
    }
    if (pairs < kBeside) return std::nullopt;
    return Around{bore, pairs >= kAround};
  }

  /// The bore is a thread that is drawn at its diameter: nothing else can hold the screw.
  bool may_be_thread(const Stretch& s) const {
    return s.around && s.bore <= kNoPlay * radius() && s.to - s.from >= 0.9 * diameter_ &&
           length_ <= s.to + 0.3 * diameter_;
  }

  void find_thread() {
    for (Stretch& s : stretches_)
      s.threads = s.around && kind(s.part) != Kind::washer &&
                  (is_hexagon(s.part) || s.bore < (is_nut(s.part) ? 1.1 : kTight) * radius());
    const auto reached = [&](const Stretch& s) { return s.from < length_ - 0.5 * step_; };
    const auto deepest = [&](const auto& is) -> const Stretch* {
      const Stretch* found = nullptr;
      for (const Stretch& s : stretches_)
        if (reached(s) && is(s) && kind(s.part) != Kind::washer) found = &s;
      return found;
    };
    const auto nut = std::find_if(stretches_.begin(), stretches_.end(),
                                  [&](const Stretch& s) { return s.threads && is_nut(s.part) && reached(s); });
    if (nut != stretches_.end()) {
      out_.nut = true;
      thread_ = *nut;
      for (const Stretch& s : stretches_)
        if (s.threads && reached(s) && s.from >= nut->from && !contains(out_.into, s.part)) out_.into.push_back(s.part);
      return;
    }
    const Stretch* last = deepest([](const Stretch& s) { return s.threads; });
    if (last != nullptr) {
      thread_ = *last;
      for (const Stretch& s : stretches_)
        if (s.threads && reached(s) && !contains(out_.into, s.part)) out_.into.push_back(s.part);
      return;
    }
    last = deepest([](const Stretch& s) { return s.around; });
    if (last == nullptr || !may_be_thread(*last)) return;
    for (const Stretch& s : stretches_)  // another bore without play is as likely to be the thread
      if (s.part != last->part && reached(s) && kind(s.part) != Kind::washer && s.bore < kPlay * radius()) {
        out_.possible_thread = last->part;
        return;
      }
    thread_ = *last;
    out_.into.push_back(last->part);
  }

  void find_clamped() {
    if (!headed_) return;
    const double end = thread_ ? thread_->from : length_, gap = kGap * diameter_ + step_;
    double reach = 0;
    bool whole = true;
    for (const Stretch& s : stretches_) {
      if (s.from >= end || contains(out_.into, s.part)) continue;
      whole = whole && s.from <= reach + gap;
      reach = std::max(reach, s.to);
      if (!contains(stack_, s.part)) stack_.push_back(s.part);
    }
    lies_ = whole && !stack_.empty() && (!thread_ || thread_->from <= reach + gap);
    stack_end_ = reach;
    const bool threaded_twice = !out_.nut && out_.into.size() > 1;
    if (lies_ && thread_ && !threaded_twice) out_.clamps = stack_;
  }

  void find_faults() {
    if (!headed_) return;
    if (thread_)
      look_at_thread();
    else
      look_for_thread();
  }

  void look_at_thread() {
    const PartId other = out_.into.front();
    const Shape& nut = shapes_[other];
    if (out_.nut && is_hexagon(other)) {
      const Thread* mine = thread_named(thread_name(assembly_.parts[id_], shape_));
      const Thread* its = thread_named(thread_name(assembly_.parts[other], nut));
      // Nuts are drawn with holes of any diameter of their thread.
      const auto fits = [&](double hole) { return hole > 0.95 * mine->root() && hole < 1.06 * mine->diameter; };
      if (mine != nullptr && its != nullptr && mine != its && !fits(2 * thread_->bore * mm_))
        out_.faults.push_back({FasteningProblem::other_size, other});
      const double one = (seat_ - nut.top).dot(shape_.axis);
      const double two = one + nut.axis.dot(shape_.axis) * nut.height;
      if (length_ < std::min(one, two) + 0.75 * nut.height) out_.faults.push_back({FasteningProblem::too_short, other});
      return;
    }
    if (kind(other) == Kind::nut || !known_) return;
    const bool ends_inside = length_ < thread_->to - 0.5 * step_;
    if (!out_.clamps.empty() && ends_inside && length_ - thread_->from < 0.5 * diameter_)
      out_.faults.push_back({FasteningProblem::too_short, other});
    const TriangleBvh& surface = surface_(other);
    const double margin = 0.02 * diameter_;
    if (thread_->bore > 0.5 * radius() && !surface.inside(at(length_ - 0.5 * diameter_)) &&
        surface.inside(at(length_ + margin)))
      out_.faults.push_back({FasteningProblem::on_ground, other});
  }

  void look_for_thread() {
    if (!known_ || !lies_) return;
    const bool play = std::all_of(stretches_.begin(), stretches_.end(),
                                  [&](const Stretch& s) { return s.from >= length_ || s.bore > kPlay * radius(); });
    if (!play) return;
    for (const Stretch& s : stretches_)
      if (s.threads && s.bore > 0.5 * radius() && s.from >= length_ - step_ &&
          s.from < std::max(stack_end_, length_) + kGap * diameter_ + step_) {
        out_.faults.push_back({FasteningProblem::too_short, s.part});
        return;
      }
    if (length_ < stack_end_ + 0.5 * diameter_) return;
    Aabb around;
    around.extend(at(stack_end_));
    around.extend(at(length_ + 0.5 * diameter_));
    around.inflate(diameter_);
    for (const std::size_t part : boxes_.overlapping(around)) {
      if (part == id_ || contains(stack_, static_cast<PartId>(part))) continue;
      for (double t = stack_end_ + 0.2 * diameter_; t < length_ + 0.5 * diameter_; t += 0.2 * diameter_) {
        if (boxes_.box(part).squared_distance(at(t)) > diameter_ * diameter_) continue;
        const TriangleBvh& surface = surface_(static_cast<PartId>(part));
        if (surface.closest(at(t), 0.75 * diameter_).distance < 0.75 * diameter_ || surface.inside(at(t))) return;
      }
    }
    out_.faults.push_back({FasteningProblem::nut_missing, std::nullopt});
  }

  const Assembly& assembly_;
  const geometry::BoxIndex& boxes_;
  std::span<const Shape> shapes_;
  const SurfaceOf& surface_;
  PartId id_;
  const Shape& shape_;
  double mm_, diameter_ = 0, length_ = 0, step_ = 0;
  bool known_ = false, headed_ = false;
  Eigen::Vector3d seat_, across_;
  std::vector<Stretch> stretches_;
  std::optional<Stretch> thread_{};
  std::vector<PartId> stack_;  // what it goes through before its thread
  double stack_end_ = 0;
  bool lies_ = false;  // the stack is without gaps
  Fastening out_;
};

/// What only one screw holds.
void find_only(const Assembly& assembly, std::vector<Fastening>& all) {
  std::vector<int> held(assembly.parts.size());
  for (const Fastening& f : all) {
    for (const PartId part : f.clamps) ++held[part];
    for (const PartId part : f.into) ++held[part];
  }
  for (Fastening& f : all)
    for (const PartId part : f.clamps)
      if (held[part] == 1) f.only.push_back(part);
}

std::string names_of(const Assembly& assembly, const std::vector<PartId>& parts, const char* last) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += (i == 0 ? "" : i + 1 == parts.size() ? last : ", ") + ("'" + assembly.parts[parts[i]].name + "'");
  return out;
}

/// Washers belong to their screw; they are named where there is nothing else.
std::vector<PartId> without_washers(const Assembly& assembly, std::vector<PartId> parts) {
  std::erase_if(parts, [&](PartId id) {
    const auto& kind = assembly.parts[id].kind;
    return kind && kind->kind == "washer";
  });
  return parts;
}

}  // namespace

std::vector<Fastening> fastenings_of(const Assembly& assembly, std::span<const Shape> shapes, const SurfaceOf& surface,
                                     const RunContext& context) {
  const double mm = millimetres_per_unit(assembly);
  std::vector<PartId> screws;
  for (const Part& part : assembly.parts)
    if (!part.open && shapes[part.id].kind == Kind::screw && kind_of(part, shapes[part.id]) == Kind::screw)
      screws.push_back(part.id);
  std::vector<Fastening> out(screws.size());
  const geometry::BoxIndex boxes = geometry::index_of_parts(assembly);
  parallel_for(
      screws.size(), context,
      [&](std::size_t i) { out[i] = Screw(assembly, boxes, shapes, surface, screws[i], mm).fastening(); },
      [&] { return context.should_stop(); });
  stop_if_asked(context, "finding what screws clamp");
  find_only(assembly, out);
  return out;
}

std::string fastening_text(const Assembly& assembly, const Fastening& f) {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : "; ") + text; };
  const std::vector<PartId> clamped = without_washers(assembly, f.clamps);
  if (!clamped.empty()) {
    if (!f.nut)
      add("clamps " + names_of(assembly, clamped, " and ") + " to " + names_of(assembly, {f.into.front()}, ""));
    else if (clamped.size() == 1)
      add("clamps " + names_of(assembly, clamped, ""));
    else
      add("clamps " + names_of(assembly, clamped, " and ") + " together");
  }
  if (!f.into.empty()) add("driven into " + names_of(assembly, f.nut ? std::vector{f.into.front()} : f.into, " and "));
  const std::vector<PartId> only = without_washers(assembly, f.only);
  if (!only.empty()) add("no other screw holds " + names_of(assembly, only, " or "));
  return out;
}

std::string fault_text(const Assembly& assembly, const Fastening& f, const FasteningFault& fault) {
  const std::string screw = "'" + assembly.parts[f.screw].name + "'";
  const std::string other = fault.other ? "'" + assembly.parts[*fault.other].name + "'" : "";
  const auto size = [&](PartId part) {
    const auto& kind = assembly.parts[part].kind;
    return kind && !kind->size.empty() ? " (" + kind->size + ")" : std::string();
  };
  switch (fault.problem) {
    case FasteningProblem::nut_missing:
      return screw + " goes through all its parts with play, sticks out, and has no nut";
    case FasteningProblem::other_size:
      return screw + size(f.screw) + " and its nut " + other + size(*fault.other) + " have different threads";
    case FasteningProblem::too_short:
      return screw + size(f.screw) + " is too short for the thread of " + other;
    case FasteningProblem::on_ground:
      return screw + " stands on the ground of its hole in " + other;
  }
  return {};
}

}  // namespace dismantle::fasteners
