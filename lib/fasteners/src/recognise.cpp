#include "dismantle/fasteners/recognise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "dismantle/executor.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/stop_if_asked.h"
#include "sizes.h"

namespace dismantle::fasteners {
namespace {

/// Kinds that one shape may be: there the name decides.
bool alike(Kind shape, Kind name) {
  using enum Kind;
  const auto both = [&](std::initializer_list<Kind> kinds) {
    return std::find(kinds.begin(), kinds.end(), shape) != kinds.end() &&
           std::find(kinds.begin(), kinds.end(), name) != kinds.end();
  };
  return both({washer, spacer, ring}) || both({spacer, bearing, collar, insert, wheel, pulley, coupling}) ||
         both({pin, shaft}) || both({pulley, gear, wheel}) || both({ring, belt, spring}) ||
         both({plate, board, housing, rail}) || both({nut, insert, standoff, spacer}) || both({screw, insert});
}

/// Kinds whose outline is round, whatever else is on them.
bool is_round(Kind kind) {
  using enum Kind;
  return kind == bearing || kind == gear || kind == pulley || kind == wheel || kind == insert;
}

/// Between a square and a hexagon.
constexpr double kRound = 0.8;

std::string said(Kind kind, const std::string& size, double length) {
  const std::string text = size_text(kind, size, length);
  return text.empty() ? std::string(to_string(kind)) : fmt::format("{} {}", to_string(kind), text);
}

PartKind made(Kind kind, std::string size, double confidence, std::string reason) {
  return {std::string(to_string(kind)), std::move(size), std::round(confidence * 100) / 100, std::move(reason)};
}

/// Both name the same kind: whose size?
PartKind agreed(Kind kind, const Shape& shape, const NameSays& name) {
  const bool size_differs =
      !name.thread.empty() && !shape.size.empty() && name.thread != shape.size && shape.kind == kind;
  const bool length_differs = name.length > 0 && shape.length > 0 && kind == Kind::screw &&
                              std::abs(name.length - shape.length) > std::max(0.3, 0.03 * name.length);
  const std::string by_shape = size_text(kind, shape.size, kind == Kind::screw ? shape.length : 0);
  const std::string by_name = size_text(kind, name.thread, kind == Kind::screw ? name.length : 0);
  if ((size_differs && (kind == Kind::screw || kind == Kind::nut)) || length_differs)
    return made(kind, by_shape, 0.6,
                fmt::format("shape: {}; the name ('{}') says {}: they disagree", shape.reason, name.reason, by_name));
  std::string size = shape.size.empty() ? size_text(kind, name.thread, name.length) : by_shape;
  if (kind == Kind::washer && !name.thread.empty()) size = name.thread;
  return made(kind, std::move(size), std::min(0.99, std::max(shape.confidence, name.confidence) + 0.05),
              fmt::format("shape: {}; name: '{}'", shape.reason, name.reason));
}

}  // namespace

std::string size_text(Kind kind, const std::string& size, double length) {
  if (kind != Kind::screw || !(length > 0)) return size;
  return fmt::format("{}x{}", size.empty() ? "?" : size, number(length));
}

PartKind combined(const Shape& shape, const NameSays& name) {
  if (!name.kind)
    return made(shape.kind, size_text(shape.kind, shape.size, shape.length), shape.confidence,
                fmt::format("shape: {}", shape.reason));
  const Kind named = *name.kind;
  if (shape.kind == named) return agreed(named, shape, name);
  if (shape.kind == Kind::other && is_round(named) && shape.roundness < kRound)
    return made(Kind::other, "", 0,
                fmt::format("the name ('{}') says {}, and the shape is not round", name.reason, to_string(named)));
  if (shape.kind == Kind::other)
    return made(named, size_text(named, name.thread, name.length), 0.75 * name.confidence,
                fmt::format("name: '{}'; shape: {}", name.reason, shape.reason));
  if (alike(shape.kind, named)) {
    std::string size =
        name.thread.empty() && named != Kind::screw ? shape.size : size_text(named, name.thread, name.length);
    return made(named, std::move(size), name.confidence,
                fmt::format("name: '{}'; shape: {}", name.reason, shape.reason));
  }
  const std::string by_name = said(named, name.thread, name.length);
  const std::string by_shape = said(shape.kind, shape.size, shape.length);
  if (shape.confidence >= 0.85)
    return made(shape.kind, size_text(shape.kind, shape.size, shape.length), 0.5,
                fmt::format("shape: {}; the name ('{}') says {}: they disagree", shape.reason, name.reason, by_name));
  return made(named, size_text(named, name.thread, name.length), 0.5,
              fmt::format("name: '{}'; the shape ({}) says {}: they disagree", name.reason, shape.reason, by_shape));
}

double pitch_of(std::string_view size) {
  const std::string_view name = size.substr(0, size.find('x'));
  const std::span<const Thread> all = threads();
  const auto thread = std::find_if(all.begin(), all.end(), [&](const Thread& t) { return name == t.name; });
  if (thread == all.end()) return 0;
  // Two numbers after the diameter are pitch and length; a single small one is the pitch of a fine thread (name.cpp).
  double stated = 0;
  if (name.size() < size.size() && !thread->inch) {
    const std::string rest(size.substr(name.size() + 1));
    const double first = std::strtod(rest.c_str(), nullptr);
    if (first > 0 && (rest.find('x') != std::string::npos || first <= 0.3 * thread->diameter)) stated = first;
  }
  return stated > 0 ? stated : thread->pitch;
}

double millimetres_per_unit(const Assembly& assembly) {
  const double metres = assembly.unit.empty() ? 1e-3 : metres_in(assembly.unit);
  return 1000 * metres / assembly.normalization.scale;
}

/// A ring inside a nut is the nut's.
static void join_lock_nuts(const Assembly& assembly, std::vector<Shape>& shapes) {
  const std::vector<Shape> alone = shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Shape& ring = alone[i];
    const bool may_be = ring.kind == Kind::washer || ring.kind == Kind::spacer || ring.kind == Kind::wheel ||
                        ring.kind == Kind::pulley || ring.kind == Kind::ring;
    if (!may_be || ring.height <= 0) continue;
    for (std::size_t j = 0; j < shapes.size(); ++j) {
      const Shape& nut = alone[j];
      if (nut.kind != Kind::nut || ring.radius > nut.radius || ring.height > nut.height) continue;
      if (std::abs(nut.axis.dot(ring.axis)) < 0.999) continue;
      const Eigen::Vector3d middle = ring.top - ring.axis * ring.height / 2 - nut.top;
      const double along = -middle.dot(nut.axis), across = (middle + along * nut.axis).norm();
      if (across > 0.05 * nut.radius || along < ring.height / 2 - 0.02 * nut.height ||
          along > nut.height - ring.height / 2 + 0.02 * nut.height)
        continue;
      shapes[i] = nut;
      shapes[i].confidence = 0.8;
      shapes[i].reason = fmt::format("ring inside nut '{}'", assembly.parts[j].name);
      break;
    }
  }
}

/// The shapes of the parts for which `wanted` is true, and of what is congruent with one of them.
template <class Wanted>
static std::vector<Shape> shapes_where(const Assembly& assembly, const Wanted& wanted, const RunContext& context) {
  const auto placements = geometry::find_congruent(assembly.parts);
  std::vector<bool> asked(placements.size(), false);
  for (std::size_t i = 0; i < placements.size(); ++i)
    if (wanted(assembly.parts[i])) asked[placements[i].original] = true;
  std::vector<std::size_t> originals;
  for (std::size_t i = 0; i < placements.size(); ++i)
    if (asked[i]) originals.push_back(i);
  const double mm = millimetres_per_unit(assembly);
  std::vector<Shape> found(originals.size());
  const auto look = [&](std::size_t k) {
    const Part& part = assembly.parts[originals[k]];
    if (part.open)
      found[k].reason = "its surface is open";
    else
      found[k] = recognise_shape(*part.mesh, mm);
  };
  parallel_for(originals.size(), context, look, [&] { return context.should_stop(); });
  stop_if_asked(context, "recognising kinds of parts");
  std::vector<Shape> out;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (!asked[placements[i].original]) {
      out.emplace_back().reason = "not looked at";
      continue;
    }
    const auto at = std::lower_bound(originals.begin(), originals.end(), placements[i].original) - originals.begin();
    Shape shape = found[static_cast<std::size_t>(at)];
    shape.axis = placements[i].pose.q * shape.axis;
    shape.top = placements[i].pose.q * shape.top + placements[i].pose.t;
    out.push_back(std::move(shape));
  }
  join_lock_nuts(assembly, out);
  for (const Part& part : assembly.parts) {
    const auto kind = part.kind && !part.open ? kind_from_string(part.kind->kind) : std::nullopt;
    if (!kind || *kind == out[part.id].kind) continue;
    if (auto as_stated = shape_as(*kind, *part.mesh, mm)) out[part.id] = std::move(*as_stated);
  }
  return out;
}

std::vector<Shape> shapes_of(const Assembly& assembly, const RunContext& context) {
  return shapes_where(
      assembly, [](const Part&) { return true; }, context);
}

std::vector<Shape> fastener_shapes(const Assembly& assembly, const RunContext& context) {
  const auto may_fasten = [](const Part& part) {
    if (!part.kind) return true;
    const auto kind = kind_from_string(part.kind->kind);
    return !kind || *kind == Kind::screw || *kind == Kind::nut;
  };
  return shapes_where(assembly, may_fasten, context);
}

/// The volume of the largest body of each use of a product that has several, by the id of that use.
static std::map<std::string, double> largest_bodies(const Assembly& assembly) {
  std::map<std::string, double> largest;
  std::map<std::string, std::size_t> bodies;
  for (const Part& part : assembly.parts) {
    if (part.instances.empty()) continue;
    double& volume = largest[part.instances.back()];
    volume = std::max(volume, part.volume);
    ++bodies[part.instances.back()];
  }
  std::erase_if(largest, [&](const auto& use) { return bodies[use.first] < 2; });
  return largest;
}

void recognise_kinds(Assembly& assembly, const RunContext& context, const KindOptions& options) {
  const std::vector<Shape> shapes = shapes_of(assembly, context);
  const auto largest = largest_bodies(assembly);
  // A motor is a machine: of a product of that name, the largest body is it, and the others are parts of it.
  const auto is_part_of_motor = [&](const Part& part, const NameSays& name) {
    if (name.kind != Kind::motor || part.instances.empty()) return false;
    const auto use = largest.find(part.instances.back());
    return use != largest.end() && part.volume < 0.999 * use->second;
  };
  for (Part& part : assembly.parts) {
    if (part.kind) continue;
    NameSays name;
    if (options.names) {
      if (!part.product.empty()) name = recognise_name(part.product);
      const bool inside = is_part_of_motor(part, name);
      if (!name.kind) name = recognise_name(part.name);
      if (inside) {
        part.kind = combined(shapes[part.id], NameSays{});
        part.kind->reason += fmt::format("; a body of '{}'", part.product);
        continue;
      }
    }
    part.kind = combined(shapes[part.id], name);
  }
}

}  // namespace dismantle::fasteners
