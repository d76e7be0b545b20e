#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "solids.h"

namespace dismantle::samples {
namespace {

/// Increasing angles about the z axis, each within half a turn of the one before.
std::vector<double> unrolled_angles(const Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  std::vector<double> angles;
  for (const std::uint32_t id : loop) {
    double a = std::atan2(mesh.vertices[id].y(), mesh.vertices[id].x());
    while (!angles.empty() && a < angles.back()) a += 2 * std::numbers::pi;
    angles.push_back(a);
  }
  return angles;
}

}  // namespace

Loft& Loft::to(const Loop& loop) {
  Ids ids;
  for (const Point& p : loop) {
    ids.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
    mesh_.vertices.push_back(p);
  }
  if (first_.empty())
    first_ = ids;
  else
    join(last_, ids);
  last_ = ids;
  return *this;
}

Loft& Loft::strip(const Mesh& mesh, const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& last) {
  const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.insert(mesh_.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const Triangle& t : mesh.triangles) mesh_.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  const auto shifted = [base](Ids ids) {
    for (auto& id : ids) id += base;
    return ids;
  };
  if (first_.empty())
    first_ = shifted(first);
  else
    join(last_, shifted(first));
  last_ = shifted(last);
  return *this;
}

void Loft::join(const Ids& a, const Ids& b) {
  if (a.size() != b.size()) {
    join_by_angle(a, b);
    return;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t j = (i + 1) % a.size();
    mesh_.triangles.push_back({a[i], a[j], b[j]});
    mesh_.triangles.push_back({a[i], b[j], b[i]});
  }
}

void Loft::join_by_angle(const Ids& a, const Ids& b) {
  // Each edge of one loop is joined to the point of the other that is opposite its midpoint, so that no triangle at
  // the corner of a square crosses the circle inside it.
  const double turn = 2 * std::numbers::pi;
  const auto angle_a = unrolled_angles(mesh_, a);
  auto angle_b = unrolled_angles(mesh_, b);
  const auto away = [&](double angle) { return std::abs(std::remainder(angle - angle_a.front(), turn)); };
  std::size_t start = 0;
  for (std::size_t j = 1; j < b.size(); ++j)
    if (away(angle_b[j]) < away(angle_b[start]) - 1e-12) start = j;
  const double shift = angle_a.front() + std::remainder(angle_b[start] - angle_a.front(), turn) - angle_b[start];
  const auto at_a = [&](std::size_t i) { return angle_a[i % a.size()] + turn * static_cast<double>(i / a.size()); };
  const auto at_b = [&](std::size_t j) {
    return shift + angle_b[(start + j) % b.size()] + turn * static_cast<double>((start + j) / b.size());
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool step_a = j == b.size() || (i < a.size() && at_a(i) + at_a(i + 1) < at_b(j) + at_b(j + 1));
    const std::uint32_t from_a = a[i % a.size()], from_b = b[(start + j) % b.size()];
    if (step_a)
      mesh_.triangles.push_back({from_a, a[(++i) % a.size()], from_b});
    else
      mesh_.triangles.push_back({from_a, b[(start + ++j) % b.size()], from_b});
  }
}

void Loft::fan(const Ids& loop, bool start) {
  Point centre = Point::Zero();
  for (const std::uint32_t id : loop) centre += mesh_.vertices[id];
  centre /= static_cast<double>(loop.size());
  const auto hub = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.push_back(centre);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint32_t p = loop[i], q = loop[(i + 1) % loop.size()];
    mesh_.triangles.push_back(start ? Triangle{hub, q, p} : Triangle{hub, p, q});
  }
}

Mesh Loft::capped() {
  fan(first_, true);
  fan(last_, false);
  return std::move(mesh_);
}

Mesh Loft::ring() {
  join(last_, first_);
  return std::move(mesh_);
}

Loop circle(double r, double z, int segments) {
  Loop loop;
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * std::numbers::pi * i / segments;
    loop.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  return loop;
}

Loop rectangle(double half_x, double half_y, double z) {
  return {{half_x, half_y, z}, {-half_x, half_y, z}, {-half_x, -half_y, z}, {half_x, -half_y, z}};
}

Loop hexagon(double across_flats, double z) { return circle(across_flats / std::numbers::sqrt3, z, 6); }

Loop tube_section(double bend_radius, double r, double angle, int segments) {
  Loop loop;
  const Point outward(std::cos(angle), std::sin(angle), 0);
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * std::numbers::pi * i / segments;
    loop.push_back((bend_radius + r * std::sin(a)) * outward + r * std::cos(a) * Point::UnitZ());
  }
  return loop;
}

double around(double r, int segments) { return r / std::cos(std::numbers::pi / segments); }

Mesh reversed(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace dismantle::samples
