#include "dismantle/fasteners/pattern.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "dismantle/fasteners/recognise.h"

namespace dismantle::fasteners {
namespace {

std::string size_of(const Part& part, const Shape& shape) {
  if (part.kind) return part.kind->size;
  return size_text(Kind::screw, shape.size, shape.length);
}

/// The clamped parts that screws may share.
std::vector<PartId> shared(const Assembly& assembly, std::span<const Shape> shapes, const Fastening& f) {
  std::vector<PartId> out;
  for (const PartId part : f.clamps) {
    const auto& known = assembly.parts[part].kind;
    const Kind kind = known ? kind_from_string(known->kind).value_or(Kind::other) : shapes[part].kind;
    if (kind != Kind::washer && kind != Kind::spacer) out.push_back(part);
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Puts the screws in order around their middle; false: they are in a line, or not side by side.
bool lie_around(std::span<const Shape> shapes, std::vector<PartId>& screws) {
  const Eigen::Vector3d axis = shapes[screws.front()].axis, u = axis.unitOrthogonal(), v = axis.cross(u);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  const auto flat = [&](PartId id) { return Eigen::Vector2d(u.dot(shapes[id].top), v.dot(shapes[id].top)); };
  for (const PartId id : screws) middle += flat(id) / static_cast<double>(screws.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const PartId id : screws) {
    if (shapes[id].axis.dot(axis) < 0.999) return false;
    const Eigen::Vector2d d = flat(id) - middle;
    spread += d * d.transpose();
  }
  const double half = spread.trace() / 2, root = std::sqrt(std::max(0.0, half * half - spread.determinant()));
  if (half - root < 0.04 * (half + root)) return false;  // a fifth as wide as long
  const auto angle = [&](PartId id) {
    const Eigen::Vector2d d = flat(id) - middle;
    // Begins beside the first screw, so that rounding does not decide which one is first.
    const Eigen::Vector2d first = flat(screws.front()) - middle;
    const double turn = std::atan2(d.y(), d.x()) - std::atan2(first.y(), first.x()) + 0.01;
    return turn - 2 * std::numbers::pi * std::floor(turn / (2 * std::numbers::pi));
  };
  std::map<PartId, double> angles;
  for (const PartId id : screws) angles[id] = angle(id);
  std::stable_sort(screws.begin(), screws.end(), [&](PartId a, PartId b) { return angles[a] < angles[b]; });
  return true;
}

/// From the order around: 1, 3, 2, 4 of four; 1, 4, 2, 5, 3, 6 of six; 1, 3, 5, 2, 4 of five.
std::vector<PartId> crossed(const std::vector<PartId>& around) {
  const std::size_t n = around.size();
  std::vector<PartId> out;
  if (n % 2 == 0)
    for (std::size_t i = 0; i < n; ++i) out.push_back(around[i / 2 + (i % 2) * n / 2]);
  else
    for (std::size_t i = 0; i < n; ++i) out.push_back(around[i * (n / 2) % n]);
  return out;
}

}  // namespace

std::vector<Pattern> patterns_of(const Assembly& assembly, std::span<const Fastening> fastenings,
                                 std::span<const Shape> shapes) {
  // Size, clamped parts, the part with the thread where it is no nut.
  std::map<std::tuple<std::string, std::vector<PartId>, std::vector<PartId>>, std::vector<PartId>> alike;
  for (const Fastening& f : fastenings) {
    const std::string size = size_of(assembly.parts[f.screw], shapes[f.screw]);
    std::vector<PartId> clamps = shared(assembly, shapes, f);
    if (!clamps.empty() && !size.empty() && size.front() != '?')
      alike[{size, std::move(clamps), f.nut ? std::vector<PartId>{} : f.into}].push_back(f.screw);
  }
  std::vector<Pattern> out;
  for (auto& [key, screws] : alike) {
    if (screws.size() < 4 || !lie_around(shapes, screws)) continue;
    out.push_back({crossed(screws), std::get<1>(key), std::get<0>(key)});
  }
  return out;
}

}  // namespace dismantle::fasteners
