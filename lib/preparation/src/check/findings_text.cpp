// Findings in words and as JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "dismantle/preparation/check_assembly.h"

namespace dismantle {

std::string_view to_string(FindingKind kind) {
  switch (kind) {
    case FindingKind::unusable:
      return "unusable";
    case FindingKind::repaired:
      return "repaired";
    case FindingKind::suspect:
      return "suspect";
    case FindingKind::duplicate:
      return "duplicate";
    case FindingKind::overlap:
      return "overlap";
    case FindingKind::enclosed:
      return "enclosed";
    case FindingKind::isolated:
      return "isolated";
  }
  return "unknown";
}

std::string_view to_string(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "unknown";
}

std::string findings_text(const AssemblyCheck& check, const std::string& source) {
  std::string out = fmt::format("{}: {} part{}, {} usable\n", source, check.parts, check.parts == 1 ? "" : "s",
                                check.usable);
  for (const Finding& f : check.findings) {
    out += fmt::format("{}: {}", to_string(f.severity), f.message);
    if (f.at) out += fmt::format(", at ({:.6g}, {:.6g}, {:.6g})", f.at->x(), f.at->y(), f.at->z());
    if (!f.picture.empty()) out += fmt::format(", picture {}", f.picture);
    out += fmt::format("\n    next: {}\n", f.advice);
  }
  const auto errors = check.count(Severity::error), warnings = check.count(Severity::warning);
  if (errors + warnings == 0) return out + "No problem was found.\n";
  return out + fmt::format("{} error{}, {} warning{}\n", errors, errors == 1 ? "" : "s", warnings,
                           warnings == 1 ? "" : "s");
}

std::string findings_json(const AssemblyCheck& check) {
  nlohmann::ordered_json json = {{"parts", check.parts},
                                 {"usable", check.usable},
                                 {"errors", check.count(Severity::error)},
                                 {"warnings", check.count(Severity::warning)},
                                 {"findings", nlohmann::ordered_json::array()}};
  for (const Finding& f : check.findings) {
    nlohmann::ordered_json item = {{"kind", to_string(f.kind)},
                                   {"severity", to_string(f.severity)},
                                   {"parts", f.parts},
                                   {"message", f.message},
                                   {"advice", f.advice}};
    if (f.depth) item["depth"] = *f.depth;
    if (f.at) item["at"] = {f.at->x(), f.at->y(), f.at->z()};
    if (!f.picture.empty()) item["picture"] = f.picture;
    json["findings"].push_back(std::move(item));
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace dismantle
