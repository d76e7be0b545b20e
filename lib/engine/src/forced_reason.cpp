#include "forced_reason.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/slippage.h"

namespace dismantle {

namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kBends = 0.1;       // of the diagonal of the smaller part: more does not bend out of the way
constexpr double kParallel = 0.999;  // cosine
constexpr double kOpening = 1.05;    // points within this factor of the least radius are its rim
constexpr std::size_t kSectors = 8, kSurrounds = 6;

enum class Kind { pressed, snap, deep };

double diagonal(const Part& part) { return part.mesh->box().size().norm(); }

/// Four times the volume divided by the surface: the diameter of a wire.
double thickness(const Part& part) { return 4 * std::abs(part.volume) / surface_area(*part.mesh); }

bool one_in_the_other(const InitialOverlap* overlap) {
  return overlap != nullptr && overlap->place &&
         (overlap->place->contact == ContactClass::inside || overlap->place->contact == ContactClass::duplicate);
}

Kind kind_of(const Assembly& assembly, const MotionDepth& deepest, double tolerance) {
  const InitialOverlap* overlap = assembly.overlap_of(deepest.part, deepest.other);
  const double assembled = overlap == nullptr ? 0 : overlap->depth;
  if (assembled > tolerance && deepest.depth <= 2 * assembled && !one_in_the_other(overlap)) return Kind::pressed;
  const double smaller = std::min(diagonal(assembly.parts[deepest.part]), diagonal(assembly.parts[deepest.other]));
  return deepest.excess() <= kBends * smaller && !one_in_the_other(overlap) ? Kind::snap : Kind::deep;
}

struct Fit {
  double radius = 0, opening = 0;
};

/// A round part about the direction of its motion, and the rim of an opening around that axis, too small for it.
std::optional<Fit> too_large(const Mesh& round, const Pose& pose, const Mesh& around, const Pose& there,
                             const Vec3& along) {
  const Vec3 center = pose * round.box().center();
  const auto turns_about_it = [&](const geometry::Twist& t) {
    return !t.angular.isZero() && std::abs((pose.q * t.angular).normalized().dot(along)) > kParallel &&
           t.linear.norm() <= (1 - kParallel) * t.angular.norm() * round.box().size().norm();
  };
  const auto motions = geometry::slippable_motions(round, round.box().center());
  if (std::none_of(motions.begin(), motions.end(), turns_about_it)) return std::nullopt;
  const auto off_axis = [&](const Vec3& x) { return Vec3(x - center - along.dot(x - center) * along); };
  Fit fit{0, std::numeric_limits<double>::infinity()};
  for (const Vec3& v : round.vertices) fit.radius = std::max(fit.radius, off_axis(pose * v).norm());
  for (const Vec3& v : around.vertices) fit.opening = std::min(fit.opening, off_axis(there * v).norm());
  if (!(fit.opening > 0) || fit.opening >= fit.radius) return std::nullopt;
  const Vec3 u = along.unitOrthogonal(), w = along.cross(u);
  std::array<bool, kSectors> filled{};
  for (const Vec3& v : around.vertices) {
    const Vec3 r = off_axis(there * v);
    if (r.norm() > kOpening * fit.opening) continue;
    const double turn = std::atan2(w.dot(r), u.dot(r)) / (2 * std::numbers::pi) + 0.5;
    filled[std::min(kSectors - 1, static_cast<std::size_t>(turn * kSectors))] = true;
  }
  if (std::count(filled.begin(), filled.end(), true) < static_cast<std::ptrdiff_t>(kSurrounds)) return std::nullopt;
  return fit;
}

/// One slide without a turn, whatever the number of poses.
bool is_one_slide(const std::vector<Pose>& path) {
  constexpr double kOnLine = 1e-6;  // of the travel, and radians
  const Vec3 travel = path.back().t - path.front().t, along = travel.normalized();
  return std::all_of(path.begin(), path.end(), [&](const Pose& pose) {
    const Vec3 gone = pose.t - path.front().t;
    return (gone - along.dot(gone) * along).norm() <= kOnLine * travel.norm() &&
           angle_between(pose.q, path.front().q) <= kOnLine;
  });
}

std::string quoted(const std::string& name) {
  std::string out = "'";
  for (const char c : name) out += c == '\'' ? "''" : std::string(1, c);
  return out + "'";
}

/// Two digits, not less than `x`.
std::string at_least(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return fmt::format("{:.4g}", std::ceil(x / unit * 1.001) * unit);
}

}  // namespace

std::string hindrance_text(const Assembly& assembly, const MotionDepth& deepest, const std::vector<Pose>& path,
                           const PlacedPart& other, double tolerance) {
  const Part &moves = assembly.parts[deepest.part], &stays = assembly.parts[deepest.other];
  const double to_input = 1 / assembly.normalization.scale;
  const Vec3 travel = path.back().t - path.front().t;
  const double excess = deepest.excess() * to_input;
  if (deepest.excess() <= tolerance)
    return fmt::format("no proof that '{}' stays out of '{}' was found within the budget, and no point deeper than {}",
                       moves.name, stays.name,
                       deepest.allowed > 0 ? "allowed" : fmt::format("{:.2g}", tolerance * to_input));
  if (kind_of(assembly, deepest, tolerance) == Kind::pressed)
    return fmt::format("pressed: '{}' and '{}' are in each other by {:.2g} when assembled, and by {:.2g} on the way",
                       moves.name, stays.name, assembly.overlap_of(deepest.part, deepest.other)->depth * to_input,
                       deepest.depth * to_input);
  if (travel.norm() > tolerance && is_one_slide(path)) {
    const Vec3 along = travel.normalized();
    const auto says = [&](const Fit& fit, const Part& round, const Part& eye) {
      return fmt::format("'{}', of radius {:.3g} about the way out, does not pass the opening of radius {:.3g} of '{}'",
                         round.name, fit.radius * to_input, fit.opening * to_input, eye.name);
    };
    if (const auto fit = too_large(*moves.mesh, path.front(), *stays.mesh, other.pose, along))
      return says(*fit, moves, stays);
    if (const auto fit = too_large(*stays.mesh, other.pose, *moves.mesh, path.front(), along))
      return says(*fit, stays, moves);
  }
  if (kind_of(assembly, deepest, tolerance) == Kind::snap)
    return fmt::format("snap: '{}' or '{}' would have to bend by {:.2g} on the way", moves.name, stays.name, excess);
  return fmt::format("'{}' would have to go {:.2g} deep through '{}'", moves.name, excess, stays.name);
}

std::string suggestion_text(const Assembly& assembly, const MotionDepth& deepest, double tolerance) {
  const Part &a = assembly.parts[deepest.part], &b = assembly.parts[deepest.other];
  const std::string depth = at_least(deepest.depth / assembly.normalization.scale);
  if (one_in_the_other(assembly.overlap_of(deepest.part, deepest.other)) || deepest.excess() <= tolerance) return {};
  const auto accept = [&](const char* as) {
    return fmt::format("constraints: {{accept: [{{part: {}, against: {}, as: {}, depth: {}}}]}}", quoted(a.name),
                       quoted(b.name), as, depth);
  };
  switch (kind_of(assembly, deepest, tolerance)) {
    case Kind::pressed:
      return fmt::format("constraints: {{overlap: [{{parts: [{}, {}], depth: {}}}]}}", quoted(a.name), quoted(b.name),
                         depth);
    case Kind::snap:
      return accept("snap");
    case Kind::deep:
      for (const Part* part : {&a, &b})
        if (!part->open && thickness(*part) <= kBends * diagonal(*part) && deepest.depth <= thickness(*part))
          return fmt::format("constraints: {{flexible: [{}]}}", quoted(part->name));
      return {};
  }
  return {};
}

}  // namespace dismantle
