#include "repair_part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_repair.h"
#include "dismantle/stop_if_asked.h"

namespace dismantle {
namespace {

std::string text(const Eigen::Vector3d& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z()); }

/// "1 edge", "2 edges", "3 vertices".
std::string counted(std::size_t n, std::string what) {
  if (n != 1 && what.ends_with("ex"))
    what.replace(what.size() - 2, 2, "ices");
  else if (n != 1)
    what += 's';
  return fmt::format("{} {}", n, what);
}

class PartRepair {
 public:
  PartRepair(Mesh& mesh, const std::string& unit, const PrepareOptions& options, PartReport& report,
             const RunContext& context)
      : mesh_(mesh), unit_(unit), options_(options), report_(report), context_(context) {}

  void run() {
    if (!sound()) return finish();
    diagonal_ = mesh_.box().size().norm();
    if (!(diagonal_ > 1e-75 && diagonal_ < 1e75)) {
      reject(fmt::format("its size is {:g}: beyond what can be computed with", diagonal_));
      return finish();
    }
    weld_part();
    go_on();
    EdgeUse use = edge_use(mesh_);
    go_on();
    const bool trusted = use.inconsistent == 0;
    if (!use.closed() && !mesh_.empty()) use = close(use);
    go_on();
    drop_flat_shells();
    go_on();
    const bool flat = mesh_.empty() || coplanar();
    if ((flat || !use.closed()) && before_closing_ && options_.open == OpenSurfaces::wall) {
      make_walls();
    } else if (flat) {
      reject("no volume: its triangles lie flat on each other or have no area");
    } else if (!use.closed()) {
      reject(open_text(use));
    } else {
      turn_shells(trusted);
      go_on();
      if (!has_volume() || signed_volume(mesh_) < 0)
        reject("no volume");
      else
        look_for_crossings();
    }
    go_on();
    finish();
  }

 private:
  /// Called between two steps: each takes seconds for millions of triangles.
  void go_on() const { stop_if_asked(context_, "repairing parts"); }

  template <class... Args>
  void did(fmt::format_string<Args...> format, Args&&... args) {
    report_.actions.push_back(fmt::format(format, std::forward<Args>(args)...));
    report_.summary.push_back(report_.actions.back());
  }

  void reject(std::string reason) {
    report_.kept = false;
    report_.reason = std::move(reason);
  }

  bool sound() {
    if (mesh_.triangles.empty()) {
      reject("no triangles");
      return false;
    }
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i)
      if (!mesh_.vertices[i].allFinite()) {
        reject(fmt::format("vertex {} is not a finite number", i + 1));
        return false;
      }
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (const auto v : mesh_.triangles[i])
        if (v >= mesh_.vertices.size()) {
          reject(fmt::format("triangle {} names vertex {} of {}", i + 1, v + 1, mesh_.vertices.size()));
          return false;
        }
    return true;
  }

  /// True if the volume exceeds what rounding gives a flat surface.
  bool has_volume() const { return std::abs(signed_volume(mesh_)) > 1e-12 * std::pow(surface_area(mesh_), 1.5); }

  double tolerance() const { return options_.weld * diagonal_; }

  /// All vertices lie in the plane of the largest triangle.
  bool coplanar() const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Eigen::Vector3d& a = mesh_.vertex(t, 0);
      const Eigen::Vector3d n = (mesh_.vertex(t, 1) - a).cross(mesh_.vertex(t, 2) - a);
      if (n.squaredNorm() > normal.squaredNorm()) {
        normal = n;
        origin = a;
      }
    }
    normal.normalize();
    return std::all_of(mesh_.vertices.begin(), mesh_.vertices.end(),
                       [&](const auto& v) { return std::abs(normal.dot(v - origin)) <= 1e-12 * diagonal_; });
  }

  void weld_part() {
    const std::size_t before = mesh_.vertices.size();
    const WeldResult r = weld(mesh_, tolerance());
    if (r.merged) did("welded {} to {}", counted(before, "vertex"), mesh_.vertices.size());
    if (r.unused) did("dropped {} that no triangle uses", counted(r.unused, "vertex"));
    if (r.degenerate) did("dropped {} without area", counted(r.degenerate, "triangle"));
    go_on();
    const DuplicateFaces d = drop_duplicate_faces(mesh_);
    if (d.double_sided)
      did("every face came with both senses: kept one of each, dropped {}", counted(d.repeated, "triangle"));
    else if (d.repeated)
      did("dropped {} that were there twice", counted(d.repeated, "triangle"));
    if (d.cancelled) did("dropped {} back to back: walls without thickness", counted(d.cancelled, "triangle"));
  }

  void orient() {
    const OrientResult o = orient_outward(mesh_);
    if (o.flipped) did("turned {} that faced the wrong way", counted(o.flipped, "triangle"));
    if (o.membranes) did("dropped {} of inner walls or loose sheets", counted(o.membranes, "triangle"));
    if (o.one_sided) did("part of the surface has only one side, like a Moebius strip");
  }

  /// Tries to close the mesh; returns the use of its edges afterwards.
  EdgeUse close(EdgeUse use) {
    if (options_.repair && use.open) {
      if (const std::size_t n = close_t_junctions(mesh_, std::max(tolerance(), 1e-9 * diagonal_))) {
        did("split {} where a vertex lay on an open edge", counted(n, "triangle"));
        drop_duplicate_faces(mesh_);
        use = edge_use(mesh_);
      }
    }
    if (use.open) before_closing_ = Before{mesh_, report_.actions.size(), report_.summary.size()};
    if (use.inconsistent) {
      orient();
      use = edge_use(mesh_);
    }
    if (options_.repair && use.open) {
      HoleLimits limits;
      limits.max_area_share = options_.max_hole;
      const std::vector<Hole> holes = fill_holes(mesh_, limits);
      for (const Hole& h : holes)
        report_.actions.push_back(
            h.filled ? fmt::format("closed a hole of {} near {}, area {}{}", counted(h.edges, "edge"), text(h.center),
                                   area(h.area),
                                   h.slit   ? ": split the triangle at its longest edge"
                                   : h.flat ? ""
                                            : ", with the smallest surface on its rim, which is not flat")
                     : fmt::format("left a hole of {} near {}, area {}, open: {}", counted(h.edges, "edge"),
                                   text(h.center), area(h.area), h.why_not));
      sum_up(holes, true);
      sum_up(holes, false);
      if (const std::size_t n = drop_duplicate_faces(mesh_).cancelled)
        did("dropped {} back to back with a filling: walls without thickness", counted(n, "triangle"));
      use = edge_use(mesh_);
      if (use.inconsistent) {
        orient();
        use = edge_use(mesh_);
      }
    }
    return use;
  }

  std::string area(double a) const { return fmt::format("{:.4g}{}", a, unit_.empty() ? "" : " " + unit_ + "2"); }

  void sum_up(const std::vector<Hole>& holes, bool filled) {
    const Hole* largest = nullptr;
    std::size_t count = 0;
    for (const Hole& h : holes)
      if (h.filled == filled && (++count == 1 || h.area > largest->area)) largest = &h;
    if (count == 0) return;
    report_.summary.push_back(fmt::format("{} {}{} {} at {}{}", filled ? "closed" : "left open", counted(count, "hole"),
                                          count > 1 ? ", the largest" : ", area", area(largest->area),
                                          text(largest->center), filled ? "" : ": " + largest->why_not));
  }

  std::string open_text(const EdgeUse& use) const {
    std::string s = "not watertight";
    if (options_.repair) s += " even after repair";
    if (use.open) s += fmt::format(": {}, the first near {}", counted(use.open, "open edge"), text(use.where));
    if (use.inconsistent)
      s += fmt::format("{} {} between triangles of opposite sense{}", use.open ? "," : ":",
                       counted(use.inconsistent, "edge"), use.open ? "" : ", the first near " + text(use.where));
    return s;
  }

  void drop_flat_shells() {
    std::size_t count = 0;
    const auto shell = shells_of(mesh_, count);
    if (count < 2) return;
    std::vector<double> volume(count, 0), area(count, 0);
    std::vector<const Eigen::Vector3d*> origin(count, nullptr);
    for (std::size_t t = 0; t < shell.size(); ++t) {
      auto& o = origin[shell[t]];
      if (!o) o = &mesh_.vertex(t, 0);
      const Eigen::Vector3d a = mesh_.vertex(t, 0) - *o, b = mesh_.vertex(t, 1) - *o, c = mesh_.vertex(t, 2) - *o;
      volume[shell[t]] += a.dot(b.cross(c)) / 6;
      area[shell[t]] += (b - a).cross(c - a).norm() / 2;
    }
    std::size_t kept = 0, dropped = 0;
    std::vector<char> flat(count, 0);
    for (std::size_t s = 0; s < count; ++s) {
      flat[s] = std::abs(volume[s]) <= 1e-12 * std::pow(area[s], 1.5);
      dropped += static_cast<std::size_t>(flat[s]);
    }
    if (dropped == 0) return;
    for (std::size_t t = 0; t < shell.size(); ++t)
      if (!flat[shell[t]]) mesh_.triangles[kept++] = mesh_.triangles[t];
    mesh_.triangles.resize(kept);
    weld(mesh_, 0);
    did("dropped {} without volume", counted(dropped, "shell"));
  }

  /// Undoes the attempts to close the surface: walls are what the file has, no more and no less.
  void make_walls() {
    mesh_ = std::move(before_closing_->mesh);
    report_.actions.resize(before_closing_->actions);
    report_.summary.resize(before_closing_->summary);
    EdgeUse use = edge_use(mesh_);
    if (surface_area(mesh_) <= 1e-12 * diagonal_ * diagonal_) return reject("its triangles have no area");
    if (use.inconsistent) {
      Mesh oriented = mesh_;
      const OrientResult o = orient_outward(oriented);
      if (o.membranes == 0 && o.flipped > 0) {
        mesh_ = std::move(oriented);
        did("turned {} that faced the wrong way", counted(o.flipped, "triangle"));
        use = edge_use(mesh_);
      }
    }
    if (signed_volume(mesh_) < 0) {
      for (Triangle& t : mesh_.triangles) std::swap(t[1], t[2]);
      did("turned the whole surface: it faced inward");
    }
    report_.open = open_text(use);
  }

  void turn_shells(bool trusted) {
    const ShellResult s = orient_shells(mesh_, trusted);
    if (s.turned) did("turned {} of {} inside out", counted(s.turned, "shell"), s.shells);
    if (s.voids) did("{} inside the solid {} empty", counted(s.voids, "void"), s.voids == 1 ? "is" : "are");
    if (s.inner_solids)
      did("{} inside another faces outward: taken as solid, as the file says", counted(s.inner_solids, "shell"));
  }

  void look_for_crossings() {
    const auto crossings = self_crossings(mesh_, 1000);
    if (crossings.empty()) return;
    std::size_t count = 0, own = 0;
    const auto shell = shells_of(mesh_, count);
    Eigen::Vector3d where = mesh_.vertex(crossings.front().first, 0);
    for (const auto& [a, b] : crossings)
      if (shell[a] == shell[b] && own++ == 0)
        where = (mesh_.vertex(a, 0) + mesh_.vertex(a, 1) + mesh_.vertex(a, 2)) / 3;
    if (own)
      did("warning: the surface crosses itself at {}{}, the first near {}; kept as it is",
          crossings.size() == 1000 ? "more than " : "", counted(own, "place"), text(where));
    if (own < crossings.size()) did("shells of this part overlap: taken as their union");
  }

  void finish() {
    report_.vertices = mesh_.vertices.size();
    report_.triangles = mesh_.triangles.size();
    if (!report_.kept) return;
    shells_of(mesh_, report_.shells);
    report_.volume = signed_volume(mesh_);
    report_.watertight = edge_use(mesh_).closed();
    if (!report_.open.empty()) report_.volume = std::max(0.0, report_.volume);
  }

  Mesh& mesh_;
  const std::string& unit_;
  const PrepareOptions& options_;
  PartReport& report_;
  const RunContext& context_;
  double diagonal_ = 0;
  struct Before {
    Mesh mesh;
    std::size_t actions = 0, summary = 0;
  };
  std::optional<Before> before_closing_;  // of a mesh that was open then
};

}  // namespace

void repair_part(Mesh& mesh, const std::string& unit, const PrepareOptions& options, PartReport& report,
                 const RunContext& context) {
  PartRepair(mesh, unit, options, report, context).run();
}

}  // namespace dismantle
