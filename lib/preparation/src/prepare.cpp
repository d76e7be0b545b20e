#include "dismantle/preparation/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "assembly_steps.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/geometry/mesh_subdivide.h"
#include "dismantle/preparation/declared_overlaps.h"
#include "dismantle/preparation/flexible_parts.h"
#include "dismantle/preparation/read_input.h"
#include "measure_overlaps.h"
#include "parallel_phase.h"
#include "repair_part.h"

namespace dismantle {
namespace {

class Preparation {
 public:
  Preparation(const PrepareOptions& options, RunContext& context, PrepareReport& report)
      : options_(options), context_(context), report_(report) {}

  Assembly run(std::vector<RawPart> raw, const std::string& source, const std::string& sha256) {
    assembly_.source = source;
    assembly_.sha256 = sha256;
    assembly_.repair = {options_.weld, options_.repair, options_.max_hole};
    check_size(raw);
    std::vector<std::string> renamed;
    make_names_unique(raw, renamed);
    for (auto& text : renamed) warn(std::move(text));
    clean(raw);
    if (options_.drop_duplicates) drop(find_duplicates(parts_, context_));
    if (options_.max_overlap < 1) drop(find_overlapping(parts_, options_.max_overlap, context_));
    if (options_.min_thickness > 0) drop(find_thin(parts_, options_.min_thickness, context_));
    connect();
    if (parts_.size() < 2) refuse();
    find_unit();
    normalize();
    subdivide_parts();
    measure_overlaps();
    declare_flexible_of_files();
    if (options_.flexible == FlexibleParts::recognised)
      for (FlexiblePart& found : recognise_flexible(assembly_, context_)) report_.flexible.push_back(std::move(found));
    for (const auto& part : report_.parts)
      if (!part.kept) assembly_.excluded.push_back({part.name, part.reason, part.by_choice || part.by_meaning});
    for (const auto& warning : report_.warnings) context_.log(LogLevel::warning, warning);
    return std::move(assembly_);
  }

 private:
  /// About the assembly as a whole.
  void warn(std::string text) {
    report_.whole.push_back(text);
    report_.warnings.push_back(std::move(text));
  }

  void check_size(const std::vector<RawPart>& raw) const {
    std::uint64_t triangles = 0;
    for (const auto& part : raw) triangles += part.mesh.triangles.size();
    if (triangles > static_cast<std::uint64_t>(options_.max_triangles))
      throw InputError(assembly_.source,
                       fmt::format("{} triangles are more than the limit of {} (assembly.max_triangles): "
                                   "simplify the meshes or raise the limit",
                                   triangles, options_.max_triangles));
  }

  void clean(std::vector<RawPart>& raw) {
    report_.parts.assign(raw.size(), {});
    parallel_phase(
        raw.size(), context_, "prepare",
        [&](std::size_t i) {
          report_.parts[i].name = raw[i].name;
          report_.parts[i].file = raw[i].file;
          if (raw[i].problem.empty()) {
            repair_part(raw[i].mesh, raw[i].unit, options_, report_.parts[i], context_);
          } else {
            report_.parts[i].kept = false;
            report_.parts[i].by_meaning = raw[i].by_meaning;
            report_.parts[i].reason = raw[i].problem;
          }
        },
        [&](std::size_t i) { return raw[i].name; });
    for (std::size_t i = 0; i < raw.size(); ++i) {
      PartReport& report = report_.parts[i];
      for (const auto& action : report.actions)
        if (action.starts_with("warning: "))
          report_.warnings.push_back(fmt::format("part '{}': {}", report.name, action.substr(9)));
      if (report.by_meaning) {
        context_.log(LogLevel::info, fmt::format("'{}' is left out: {}", report.name, report.reason));
        continue;
      }
      if (!report.kept) {
        report_.warnings.push_back(fmt::format("part '{}' is left out: {}", report.name, report.reason));
        continue;
      }
      Candidate c;
      c.name = report.name;
      c.file = report.file;
      c.report = i;
      c.mesh = std::move(raw[i].mesh);
      c.colour = raw[i].colour;
      c.parents = std::move(raw[i].parents);
      c.instances = std::move(raw[i].instances);
      c.product = std::move(raw[i].product);
      c.density = raw[i].density;
      c.flexible = raw[i].flexible;
      c.unit = raw[i].unit;
      c.box = c.mesh.box();
      c.volume = report.volume;
      c.open = !report.open.empty();
      if (c.open)
        context_.log(LogLevel::info, fmt::format("'{}' is {}: its surface is a wall", report.name, report.open));
      warn_precision(c);
      parts_.push_back(std::move(c));
    }
  }

  /// Far from the origin, neighbouring coordinates are further apart than the part's own detail.
  void warn_precision(const Candidate& c) {
    const double size = c.box.size().norm();
    const double magnitude = std::max(c.box.lo.cwiseAbs().maxCoeff(), c.box.hi.cwiseAbs().maxCoeff());
    if (magnitude * 2.2e-16 > 1e-8 * size)
      warn(
          fmt::format("part '{}' of size {:.3g} lies at coordinates around {:.3g}: only {:.0f} digits of its shape are "
                      "left; move the assembly to the origin",
                      c.name, size, magnitude, std::max(0.0, std::floor(-std::log10(magnitude * 2.2e-16 / size)))));
  }

  void drop(const Dropped& dropped) {
    if (dropped.empty()) return;
    for (const auto& [i, reason] : dropped) {
      PartReport& report = report_.parts[parts_[i].report];
      report.kept = false;
      report.by_choice = true;
      report.reason = reason;
      report_.warnings.push_back(fmt::format("part '{}' is left out: {}", report.name, reason));
    }
    std::size_t next = 0, kept = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (next < dropped.size() && dropped[next].first == i)
        ++next;
      else if (kept++ != i)
        parts_[kept - 1] = std::move(parts_[i]);
    }
    parts_.resize(kept);
  }

  void connect() {
    if (parts_.size() < 2) return;
    if (options_.largest_connected) {
      const auto groups = connected_groups(parts_, 0, context_);
      Dropped dropped;
      for (std::size_t g = 1; g < groups.size(); ++g)
        for (const auto i : groups[g])
          dropped.emplace_back(i, fmt::format("its convex hull meets none of the largest connected set of {} parts "
                                              "(assembly.largest_connected)",
                                              groups[0].size()));
      std::sort(dropped.begin(), dropped.end());
      drop(dropped);
      return;
    }
    // Hulls with a gap of less than 1 % of the assembly count as connected: a clearance is no reason for a warning.
    const auto groups = connected_groups(parts_, 0.01 * box_of(parts_).size().maxCoeff(), context_);
    for (std::size_t g = 1; g < groups.size(); ++g) {
      std::string names;
      for (std::size_t k = 0; k < std::min<std::size_t>(groups[g].size(), 5); ++k)
        names += fmt::format("{}'{}'", k ? ", " : "", parts_[groups[g][k]].name);
      if (groups[g].size() > 5) names += fmt::format(" and {} more", groups[g].size() - 5);
      warn(fmt::format("{} {} apart from the rest, by more than 1 % of the assembly", names,
                       groups[g].size() == 1 ? "floats" : "float"));
    }
  }

  [[noreturn]] void refuse() const {
    std::string text = report_.parts.empty()
                           ? "there are no parts"
                           : fmt::format("{} of {} part{} can be used; an assembly needs at least two", parts_.size(),
                                         report_.parts.size(), report_.parts.size() == 1 ? "" : "s");
    std::size_t listed = 0;
    for (const auto& part : report_.parts) {
      if (part.kept) continue;
      if (++listed > 50) {
        text += "\n  ...";
        break;
      }
      text += fmt::format("\n  {}: {}", part.name, part.reason);
    }
    throw InputError(assembly_.source, text);
  }

  /// The unit that all parts with a known unit share.
  void find_unit() {
    std::map<std::string, std::string> units;  // and a part of each
    for (const auto& c : parts_)
      if (!c.unit.empty()) units.emplace(c.unit, c.name);
    if (units.size() == 1) assembly_.unit = units.begin()->first;
    if (units.empty()) assembly_.unit = unit_named(options_.unit);
    if (units.empty() && !options_.unit.empty() && assembly_.unit.empty())
      throw Error(fmt::format("assembly.unit: '{}' is no unit of length; write mm, cm, m or inch", options_.unit));
    if (units.size() == 1 && !options_.unit.empty() && unit_named(options_.unit) != assembly_.unit)
      warn(fmt::format("the files say that they are in {}; assembly.unit, {}, is for files that name no unit",
                       assembly_.unit, options_.unit));
    if (units.size() < 2) return;
    std::string text;
    for (const auto& [unit, name] : units) text += fmt::format("{}'{}' in {}", text.empty() ? "" : ", ", name, unit);
    warn("parts are given in different length units, none is converted: " + text);
  }

  void normalize() {
    assembly_.input_box = box_of(parts_);
    if (options_.normalize) {
      assembly_.normalization.center = assembly_.input_box.center();
      assembly_.normalization.scale = options_.size / assembly_.input_box.size().maxCoeff();
    }
    std::string small;
    std::size_t count = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      Mesh& mesh = parts_[i].mesh;
      for (auto& v : mesh.vertices) v = assembly_.normalization.to_internal(v);
      Part part;
      part.id = static_cast<PartId>(i);
      part.name = parts_[i].name;
      part.file = parts_[i].file;
      part.open = parts_[i].open;
      part.volume = part.open ? std::max(0.0, signed_volume(mesh)) : signed_volume(mesh);
      part.colour = parts_[i].colour;
      part.parents = parts_[i].parents;
      part.instances = parts_[i].instances;
      part.product = parts_[i].product;
      part.density = parts_[i].density;
      if (mesh.box().size().maxCoeff() < 0.002 * options_.size && count++ < 5)
        small += fmt::format("{}'{}' ({:.2g})", small.empty() ? "" : ", ", part.name, mesh.box().size().maxCoeff());
      part.mesh = std::make_shared<const Mesh>(std::move(mesh));
      assembly_.parts.push_back(std::move(part));
    }
    if (count && options_.normalize)
      warn(fmt::format("{} part{} smaller than 0.2 % of the assembly, no larger than the tolerances of planning: {}{}",
                       count, count == 1 ? " is" : "s are", small, count > 5 ? "..." : ""));
  }

  void subdivide_parts() {
    parallel_phase(
        assembly_.parts.size(), context_, "subdivide",
        [&](std::size_t i) {
          Part& part = assembly_.parts[i];
          part.surface = part.mesh;
          if (options_.subdivide <= 0 || longest_edge(*part.mesh) <= options_.subdivide) return;
          part.surface = std::make_shared<const Mesh>(
              subdivide(*part.mesh, options_.subdivide, static_cast<std::size_t>(options_.max_triangles)));
        },
        [&](std::size_t i) { return assembly_.parts[i].name; });
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Part& part = assembly_.parts[i];
      if (part.surface != part.mesh)
        report_.parts[parts_[i].report].actions.push_back(
            fmt::format("subdivided {} triangles to {} for contact points, no edge longer than {:g}",
                        part.mesh->triangles.size(), part.surface->triangles.size(), options_.subdivide));
    }
  }

  void measure_overlaps() {
    const auto& parts = assembly_.parts;
    assembly_.overlaps = dismantle::measure_overlaps(parts, context_);
    const InitialOverlap* deepest = nullptr;
    for (const InitialOverlap& pair : assembly_.overlaps)
      if (!deepest || pair.depth > deepest->depth) deepest = &pair;
    if (deepest)
      report_.warnings.push_back(fmt::format(
          "{} pair{} of parts overlap when assembled, by up to {:.4g} {} ('{}' and '{}')", assembly_.overlaps.size(),
          assembly_.overlaps.size() == 1 ? "" : "s", deepest->depth / assembly_.normalization.scale,
          assembly_.unit.empty() ? "input units" : assembly_.unit, parts[deepest->a].name, parts[deepest->b].name));
  }

  void declare_flexible_of_files() {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!parts_[i].flexible) continue;
      const Part& part = assembly_.parts[i];
      declare_flexible(assembly_, part.name);
      FlexiblePart& bends = report_.flexible.emplace_back();
      bends = {part.name, Flexible::material, flexible_depth(part), {}};
      for (const Part& other : assembly_.parts)
        if (other.id != part.id) bends.others.push_back(other.name);
    }
  }

  const PrepareOptions& options_;
  RunContext& context_;
  PrepareReport& report_;
  std::vector<Candidate> parts_;
  Assembly assembly_;
};

}  // namespace

Assembly prepare_assembly(std::vector<RawPart> raw, const std::string& source, const std::string& sha256,
                          const PrepareOptions& options, RunContext& context, PrepareReport& report) {
  report = {};
  return Preparation(options, context, report).run(std::move(raw), source, sha256);
}

}  // namespace dismantle
