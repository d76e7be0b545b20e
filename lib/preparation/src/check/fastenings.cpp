#include "check/fastenings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "dismantle/fasteners/fastening.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/triangle_bvh.h"

namespace dismantle {
namespace {

using fasteners::FasteningProblem;

const char* advice_for(FasteningProblem problem) {
  switch (problem) {
    case FasteningProblem::nut_missing:
      return "add the nut to the model, or nothing, if it is bought and left out";
    case FasteningProblem::other_size:
      return "take a nut of the same thread";
    case FasteningProblem::too_short:
      return "take a longer screw, or nothing, if the model is only drawn so";
    case FasteningProblem::on_ground:
      return "take a shorter screw or drill deeper, or nothing, if the hole is only drawn as deep as its screw is long";
  }
  return "";
}

std::vector<std::string> names_of(const Assembly& assembly, const std::vector<PartId>& parts) {
  std::vector<std::string> out;
  for (const PartId part : parts) out.push_back(assembly.parts[part].name);
  return out;
}

std::string size_of(const Part& part) { return part.kind ? part.kind->size : std::string(); }

}  // namespace

void add_fastenings(const Assembly& assembly, const std::function<const TriangleBvh&(PartId)>& surface,
                    AssemblyCheck& check, const RunContext& context) {
  const auto is_screw = [](const Part& part) { return part.kind && part.kind->kind == "screw"; };
  if (std::none_of(assembly.parts.begin(), assembly.parts.end(), is_screw)) return;
  const auto shapes = fasteners::fastener_shapes(assembly, context);
  std::map<std::tuple<std::string, std::string>, std::size_t> known;  // size, words
  std::map<std::tuple<FasteningProblem, std::string, std::string>, std::size_t>
      faults;  // problem, size, size of the nut
  for (const fasteners::Fastening& f : fasteners::fastenings_of(assembly, shapes, surface, context)) {
    const Part& screw = assembly.parts[f.screw];
    const std::string text = fasteners::fastening_text(assembly, f);
    if (!text.empty()) {
      const auto [it, fresh] = known.try_emplace({size_of(screw), text}, check.fastenings.size());
      if (fresh)
        check.fastenings.push_back({{},
                                    size_of(screw),
                                    text,
                                    names_of(assembly, f.clamps),
                                    names_of(assembly, f.into),
                                    names_of(assembly, f.only)});
      check.fastenings[it->second].screws.push_back(screw.name);
    }
    for (const fasteners::FasteningFault& fault : f.faults) {
      const std::string other = fault.other ? size_of(assembly.parts[*fault.other]) : "";
      const auto [it, fresh] = faults.try_emplace({fault.problem, size_of(screw), other}, check.findings.size());
      if (fresh) {
        Finding finding;
        finding.kind = FindingKind::fastener;
        finding.severity = Severity::note;
        finding.parts = {screw.name};
        if (fault.other) finding.parts.push_back(assembly.parts[*fault.other].name);
        finding.advice = advice_for(fault.problem);
        finding.at = assembly.normalization.to_input(screw.mesh->box().center());
        check.findings.push_back(std::move(finding));
      }
      check.findings[it->second].details.push_back(fasteners::fault_text(assembly, f, fault));
    }
  }
  for (const auto& [key, index] : faults) {
    Finding& finding = check.findings[index];
    const std::size_t more = finding.details.size() - 1;
    finding.message = finding.details.front();
    if (more == 0) finding.details.clear();
    if (more > 0) finding.message += fmt::format("; the same of {} more", more);
  }
}

std::string fastenings_text(const std::vector<CheckedFastening>& fastenings) {
  std::string out;
  for (const CheckedFastening& f : fastenings)
    out += fmt::format("  {}x {}: {}: '{}'{}\n", f.screws.size(), f.size.empty() ? "screw" : f.size, f.text,
                       f.screws.front(), f.screws.size() > 1 ? ", ..." : "");
  return out.empty() ? out : "what screws hold:\n" + out;
}

}  // namespace dismantle
