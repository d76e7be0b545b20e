#include "dismantle/plan_io/drawn_tools.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

namespace dismantle {
namespace {

using nlohmann::json;

constexpr int kCorners = 24;  // of a round outline

Eigen::Vector2d on_circle(double radius, double angle) {
  return radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

/// Half circles about both ends.
std::vector<Eigen::Vector2d> obround(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius) {
  std::vector<Eigen::Vector2d> out;
  const double along = from == to ? 0 : std::atan2(to.y() - from.y(), to.x() - from.x());
  for (int half = 0; half < 2; ++half)
    for (int k = 0; k <= kCorners / 2; ++k) {
      const double angle = along - std::numbers::pi / 2 + 2 * std::numbers::pi * k / kCorners + half * std::numbers::pi;
      out.push_back((half == 0 ? to : from) + on_circle(radius, angle));
    }
  return out;
}

/// Throws json::exception where the data has another form.
std::vector<ToolPrism> prisms_of(const json& volumes) {
  const auto pair = [](const json& j) { return Eigen::Vector2d(j.at(0).get<double>(), j.at(1).get<double>()); };
  std::vector<ToolPrism> out;
  for (const json& volume : volumes) {
    ToolPrism prism;
    const json& body = volume.is_object() && volume.size() == 1 ? volume.begin().value() : json::object();
    if (volume.contains("tube")) {
      const double radius = body.at("radius");
      for (int k = 0; k < kCorners; ++k)
        prism.outline.push_back(on_circle(radius, 2 * std::numbers::pi * k / kCorners));
      prism.inner = body.at("inner");
      if (!(radius > 0) || !(prism.inner >= 0) || !(prism.inner < radius)) continue;
    } else if (volume.contains("box")) {
      const Eigen::Vector2d x = pair(body.at("x")), y = pair(body.at("y"));
      prism.outline = {{x[0], y[0]}, {x[1], y[0]}, {x[1], y[1]}, {x[0], y[1]}};
    } else {
      prism.outline = obround(pair(body.at("from")), pair(body.at("to")), body.at("radius"));
    }
    const Eigen::Vector2d z = pair(body.at("z"));
    prism.low = z[0];
    prism.high = z[1];
    out.push_back(std::move(prism));
  }
  return out;
}

Eigen::Vector3d vector_of(const json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

std::optional<DrawnTool> tool_of(const json& place, const json& part, bool turns) {
  try {
    const json& picture = place.at("picture");
    DrawnTool out;
    out.part = part.get<std::string>();
    out.name = place.at("name");
    out.turns = turns;
    out.origin = vector_of(picture.at("origin"));
    out.axis = vector_of(place.at("from"));
    out.x = vector_of(place.at("handle"));
    out.mm = picture.at("mm");
    out.swing = place.value("swing", 0.0);
    out.travel = picture.at("travel");
    out.tool = prisms_of(picture.at("tool"));
    if (picture.contains("hand")) out.hand = prisms_of(picture.at("hand"));
    const bool unit = std::abs(out.axis.norm() - 1) < 1e-3 && std::abs(out.x.norm() - 1) < 1e-3;
    if (!unit || std::abs(out.axis.dot(out.x)) > 1e-3 || !(out.mm > 0)) return std::nullopt;
    return out;
  } catch (const json::exception&) {
    return std::nullopt;  // the note of another check, or of an older version: it has no picture
  }
}

}  // namespace

std::vector<DrawnTool> drawn_tools(const std::vector<PlanVerdict>& checks) {
  std::vector<DrawnTool> out;
  const auto add = [&](std::optional<DrawnTool> tool) {
    if (tool) out.push_back(std::move(*tool));
  };
  for (const PlanVerdict& verdict : checks)
    for (const StepNote& note : verdict.notes) {
      if (note.kind != "tool_access.tool") continue;
      const json data = json::parse(note.data, nullptr, false);
      if (!data.is_object()) continue;
      add(tool_of(data, data.contains("turned") ? data["turned"] : data.value("part", json()), true));
      if (data.contains("hold") && data["hold"].is_object())
        add(tool_of(data["hold"], data["hold"].value("part", json()), false));
    }
  return out;
}

Mesh mesh_of(const DrawnTool& tool, const std::vector<ToolPrism>& prisms) {
  Mesh mesh;
  const Eigen::Vector3d y = tool.axis.cross(tool.x);
  const auto vertex = [&](const Eigen::Vector2d& p, double z) {
    mesh.vertices.push_back(tool.origin + (p.x() * tool.x + p.y() * y + z * tool.axis) / tool.mm);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (const ToolPrism& prism : prisms) {
    const auto n = static_cast<std::uint32_t>(prism.outline.size());
    // Four rings: outside below and above, inside above and below; without a hole the inside is a point.
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto ring = [&](double inner, double z) {
      for (const Eigen::Vector2d& p : prism.outline) {
        const Eigen::Vector2d middle = prism.outline.front() / 2 + prism.outline[n / 2] / 2;
        vertex(inner < 0 ? p : inner > 0 ? Eigen::Vector2d(inner * p.normalized()) : middle, z);
      }
    };
    ring(-1, prism.low), ring(-1, prism.high), ring(prism.inner, prism.high), ring(prism.inner, prism.low);
    const std::uint32_t rings = prism.inner > 0 ? 4 : 3;
    for (std::uint32_t r = 0; r < 4; ++r)
      for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t a = first + r * n + k, b = first + r * n + (k + 1) % n;
        const std::uint32_t next = (r + 1) % 4, c = first + next * n + k, d = first + next * n + (k + 1) % n;
        if (rings == 3 && r == 2) continue;  // from point to point
        if (rings == 4 || r != 3) mesh.triangles.push_back({a, b, d});
        if (rings == 4 || r != 1) mesh.triangles.push_back({a, d, c});
      }
  }
  return mesh;
}

}  // namespace dismantle
