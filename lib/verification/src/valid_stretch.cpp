#include "dismantle/verification/valid_stretch.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dismantle {
namespace {

std::size_t segment_of(const Path& path, double place) {
  if (path.size() < 2) throw std::invalid_argument("a path needs two instants at least");
  return std::min(static_cast<std::size_t>(std::max(0.0, place)), path.size() - 2);
}

/// Bound of the travel of any point of the moving parts between two places of one segment.
double travel(const Assembly& assembly, const std::vector<PartId>& moving, const Path& path, double from, double to) {
  const std::vector<Pose> a = instant_at(path, from), b = instant_at(path, to);
  double most = 0;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Aabb box = assembly.parts[moving[i]].mesh->box();
    most = std::max(most, screw_travel(a[i], b[i], box.center(), box.size().norm() / 2));
  }
  return most;
}

}  // namespace

std::vector<Pose> instant_at(const Path& path, double place) {
  const std::size_t k = segment_of(path, place);
  const double u = std::clamp(place - static_cast<double>(k), 0.0, 1.0);
  std::vector<Pose> out;
  for (std::size_t i = 0; i < path[k].size(); ++i)
    out.push_back(u <= 0 ? path[k][i] : u >= 1 ? path[k + 1][i] : screw_interpolate(path[k][i], path[k + 1][i], u));
  return out;
}

Path up_to(const Path& path, double place) {
  const std::size_t k = segment_of(path, place);
  Path out(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(k) + 1);
  out.push_back(instant_at(path, place));
  return out;
}

std::optional<double> valid_until(const Assembly& assembly, const Verifier& verifier, const std::vector<PartId>& moving,
                                  const std::vector<PlacedPart>& fixed, const Path& path, const RunContext& context) {
  const double last = static_cast<double>(path.size()) - 1, resolution = verifier.options().max_penetration;
  double valid = 0, invalid = last;
  // A beginning is valid whenever a longer one is. First the instants, then within a segment.
  const auto holds = [&](double place) {
    const MotionCheck check = verifier.check_motion(moving, fixed, up_to(path, place), context);
    if (check.valid) {
      valid = place;
      return true;
    }
    invalid = place;
    if (check.violation && !check.violation->uncertain)  // a point is too deep there, which may be before `place`
      invalid = std::clamp(static_cast<double>(check.violation->segment) + check.violation->u, valid, place);
    return false;
  };
  if (holds(last)) return last;
  while (!context.should_stop() && invalid > valid) {
    const double next = std::floor(valid) + 1;  // the next instant
    if (next < invalid) {
      holds(std::max(next, std::floor(0.5 * (valid + invalid))));
    } else {
      // What does not come that far at first may be valid for less: rule (b) allows a depth of that travel.
      if (travel(assembly, moving, path, valid, invalid) <= (valid > 0 ? resolution : resolution / 64)) break;
      holds(0.5 * (valid + invalid));
    }
  }
  if (context.should_stop()) return std::nullopt;
  return valid;
}

Path divided_where_valid(const Assembly& assembly, const Verifier& verifier, const std::vector<PartId>& moving,
                         const std::vector<PlacedPart>& fixed, Path path, const RunContext& context) {
  const auto place = valid_until(assembly, verifier, moving, fixed, path, context);
  if (!place || *place == std::floor(*place)) return path;
  std::vector<Pose> there = instant_at(path, *place);
  path.insert(path.begin() + static_cast<std::ptrdiff_t>(std::floor(*place)) + 1, std::move(there));
  return path;
}

std::size_t last_valid_instant(const Verifier& verifier, const std::vector<PartId>& moving,
                               const std::vector<PlacedPart>& fixed, const Path& path, const RunContext& context) {
  std::size_t valid = 0, invalid = path.size();
  while (invalid - valid > 1 && !context.should_stop()) {
    const std::size_t middle = (valid + invalid) / 2;
    const Path beginning(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(middle) + 1);
    (verifier.check_motion(moving, fixed, beginning, context).valid ? valid : invalid) = middle;
  }
  return context.should_stop() ? 0 : valid;
}

}  // namespace dismantle
