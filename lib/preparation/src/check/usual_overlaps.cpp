#include "check/usual_overlaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "dismantle/geometry/mesh_measure.h"

namespace dismantle {
namespace {

/// Of the smallest extent of the fastener: threads are 0.11 of the diameter deep at most (ISO 68-1: 0.61 of the pitch,
/// which is at most 0.25 of the diameter from M2 on), and heads and nuts are wider than the thread.
constexpr double kThreadDepth = 0.15;
/// The same where the overlap is at one place: a screw that leans on the wall of its hole.
constexpr double kLeaning = 0.02;
/// Of the smallest extent of the smaller part.
constexpr double kSlight = 0.005;

bool is_threaded(const Part& part) {
  static const std::set<std::string> kinds = {"screw", "nut", "insert", "stand-off"};
  return part.kind && kinds.contains(part.kind->kind);
}

}  // namespace

double UsualOverlaps::smallest_extent(PartId part) {
  const auto [known, fresh] = extents_.try_emplace(part, 0);
  if (fresh) known->second = oriented_box(*assembly_.parts[part].mesh).minCoeff();
  return known->second;
}

void UsualOverlaps::excuse(const InitialOverlap& pair, const PairContact& found, Finding& finding) {
  const bool around = finding.contact == ContactClass::uniform_interference && found.place.axis.has_value();
  const double a = smallest_extent(pair.a), b = smallest_extent(pair.b);
  const auto fits = [&](PartId part, double extent) {
    return is_threaded(assembly_.parts[part]) && found.depth <= (around ? kThreadDepth : kLeaning) * extent;
  };
  if (fits(pair.a, a) || fits(pair.b, b)) {
    finding.together = "overlap as screws and nuts without modelled threads do";
    finding.advice = "nothing: a plan turns or pulls them out within this overlap";
  } else if (found.depth <= kSlight * std::min(a, b)) {
    finding.together = "overlap slightly, as parts drawn without play, press fits and rounded coordinates do";
    finding.advice = "nothing";
  } else {
    return;
  }
  finding.severity = Severity::note;
}

std::string together_text(const std::vector<const Finding*>& findings) {
  const Finding& first = *findings.front();
  const auto deepest = std::max_element(findings.begin(), findings.end(), [](const Finding* x, const Finding* y) {
    return x->depth.value_or(0) < y->depth.value_or(0);
  });
  return fmt::format("{}: {} pairs {}, by up to {:.3g} ('{}' and '{}'); -v lists them\n", to_string(first.severity),
                     findings.size(), first.together, (*deepest)->depth.value_or(0), (*deepest)->parts[0],
                     (*deepest)->parts[1]);
}

}  // namespace dismantle
