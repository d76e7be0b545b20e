/// Models that the benchmarks share.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/run_context.h"
#include "dismantle/samples/samples.h"

namespace dismantle::bench {

using Eigen::Vector3d;

/// Closed surface over a grid of nx x ny nodes: bottom z = low(i, j), top z = high(i, j), straight sides.
template <class Low, class High>
Mesh slab(int nx, int ny, double dx, double dy, const Low& low, const High& high) {
  Mesh m;
  for (int side = 0; side < 2; ++side)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        m.vertices.emplace_back((i - 0.5 * (nx - 1)) * dx, (j - 0.5 * (ny - 1)) * dy,
                                side == 0 ? low(i, j) : high(i, j));
  const auto at = [&](int side, int i, int j) { return static_cast<std::uint32_t>((side * ny + j) * nx + i); };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      quad(at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j));
      quad(at(1, i, j), at(1, i + 1, j), at(1, i + 1, j + 1), at(1, i, j + 1));
    }
  for (int i = 0; i + 1 < nx; ++i) {
    quad(at(0, i, 0), at(0, i + 1, 0), at(1, i + 1, 0), at(1, i, 0));
    quad(at(0, i + 1, ny - 1), at(0, i, ny - 1), at(1, i, ny - 1), at(1, i + 1, ny - 1));
  }
  for (int j = 0; j + 1 < ny; ++j) {
    quad(at(0, 0, j + 1), at(0, 0, j), at(1, 0, j), at(1, 0, j + 1));
    quad(at(0, nx - 1, j), at(0, nx - 1, j + 1), at(1, nx - 1, j + 1), at(1, nx - 1, j));
  }
  return m;
}

inline Assembly assembly_of(std::vector<Mesh> meshes) {
  Assembly a;
  for (auto& mesh : meshes) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = "part" + std::to_string(part.id);
    part.mesh = part.surface = std::make_shared<const Mesh>(std::move(mesh));
    a.input_box.extend(part.mesh->box());
    a.parts.push_back(std::move(part));
  }
  return a;
}

/// A sample as `dismantle plan` prepares it: largest edge 10.
inline Assembly sample(const std::string& name, const ParamSet& given = {}) {
  RunContext context;
  PrepareReport report;
  return prepare_assembly(samples::make(name, given), name, "", PrepareOptions{}, context, report);
}

inline PartId part_called(const Assembly& assembly, const std::string& name) {
  for (const auto& p : assembly.parts)
    if (p.name == name) return p.id;
  return 0;
}

/// A torus about z: round all over.
inline Mesh torus(double big, double small, int around, int across) {
  Mesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = big + small * std::cos(b);
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), small * std::sin(b));
    }
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      m.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      m.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return m;
}

}  // namespace dismantle::bench
