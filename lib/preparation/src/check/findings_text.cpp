// Findings in words and as JSON.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "check/fastenings.h"
#include "check/kinds.h"
#include "check/usual_overlaps.h"
#include "dismantle/preparation/check_assembly.h"

namespace dismantle {

std::string_view to_string(FindingKind kind) {
  switch (kind) {
    case FindingKind::unusable:
      return "unusable";
    case FindingKind::repaired:
      return "repaired";
    case FindingKind::open:
      return "open";
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
    case FindingKind::flexible:
      return "flexible";
    case FindingKind::fastener:
      return "fastener";
    case FindingKind::input:
      return "input";
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

/// A class of contact in the words of a workshop.
static const char* contact_words(ContactClass contact) {
  switch (contact) {
    case ContactClass::clearance:
      return "with clearance";
    case ContactClass::kissing:
      return "touching";
    case ContactClass::uniform_interference:
      return "with an overlap of one depth (press fits, threads)";
    case ContactClass::local_interference:
      return "overlapping in a small place";
    case ContactClass::duplicate:
      return "twice the same";
    case ContactClass::inside:
      return "one inside the other";
  }
  return "unknown";
}

/// How many pairs there are of each class; empty when no two parts are near each other.
static std::string contacts_text(const AssemblyCheck& check) {
  std::map<ContactClass, std::size_t> counts;
  for (const CheckedContact& c : check.contacts) ++counts[c.place.contact];
  std::string out;
  for (const auto& [contact, count] : counts)
    out += fmt::format("{}{} {}", out.empty() ? "pairs of parts: " : ", ", count, contact_words(contact));
  return out.empty() ? out : out + "\n";
}

static nlohmann::ordered_json vector_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

static nlohmann::ordered_json contact_json(const CheckedContact& c) {
  nlohmann::ordered_json item = {{"parts", {c.a, c.b}}, {"class", to_string(c.place.contact)}};
  if (c.depth > 0) item["depth"] = c.depth;
  if (c.place.region.empty()) return item;
  item["at"] = vector_of(c.place.at);
  item["region"] = {vector_of(c.place.region.lo), vector_of(c.place.region.hi)};
  item["share"] = c.place.share;
  if (c.place.axis) item["axis"] = {{"point", vector_of(c.place.axis_point)}, {"direction", vector_of(*c.place.axis)}};
  return item;
}

std::string findings_text(const AssemblyCheck& check, const std::string& source, bool verbose) {
  std::string out =
      fmt::format("{}: {} part{}, {} usable\n", source, check.parts, check.parts == 1 ? "" : "s", check.usable);
  out += contacts_text(check);
  out += kinds_text(check.kinds, verbose);
  out += fastenings_text(check.fastenings);
  std::map<std::string, std::vector<const Finding*>> together;
  for (const Finding& f : check.findings)
    if (!verbose && !f.together.empty()) together[f.together].push_back(&f);
  for (const Finding& f : check.findings) {
    if (const auto alike = together.find(f.together); alike != together.end() && alike->second.size() > 1) {
      if (alike->second.front() == &f) out += together_text(alike->second);
      continue;
    }
    out += fmt::format("{}: {}", to_string(f.severity), f.message);
    if (f.at) out += fmt::format(", at ({:.6g}, {:.6g}, {:.6g})", f.at->x(), f.at->y(), f.at->z());
    if (!f.picture.empty()) out += fmt::format(", picture {}", f.picture);
    out += '\n';
    if (verbose)
      for (const std::string& detail : f.details) out += fmt::format("    {}\n", detail);
    if (!f.advice.empty()) out += fmt::format("    next: {}\n", f.advice);
  }
  const auto errors = check.count(Severity::error), warnings = check.count(Severity::warning);
  if (errors + warnings == 0) return out + "No problem was found.\n";
  return out +
         fmt::format("{} error{}, {} warning{}\n", errors, errors == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s");
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
    if (f.contact) item["class"] = to_string(*f.contact);
    if (f.depth) item["depth"] = *f.depth;
    if (f.at) item["at"] = {f.at->x(), f.at->y(), f.at->z()};
    if (!f.picture.empty()) item["picture"] = f.picture;
    if (!f.details.empty()) item["details"] = f.details;
    if (!f.together.empty()) item["together"] = f.together;
    json["findings"].push_back(std::move(item));
  }
  json["contacts"] = nlohmann::ordered_json::array();
  for (const CheckedContact& c : check.contacts) json["contacts"].push_back(contact_json(c));
  json["kinds"] = nlohmann::ordered_json::array();
  for (const CheckedKind& k : check.kinds)
    json["kinds"].push_back({{"kind", k.kind.kind},
                             {"size", k.kind.size},
                             {"confidence", k.kind.confidence},
                             {"reason", k.kind.reason},
                             {"stated", k.kind.stated},
                             {"parts", k.parts}});
  json["fasteners"] = nlohmann::ordered_json::array();
  for (const CheckedFastening& f : check.fastenings)
    json["fasteners"].push_back({{"screws", f.screws},
                                 {"size", f.size},
                                 {"text", f.text},
                                 {"clamps", f.clamps},
                                 {"into", f.into},
                                 {"only", f.only}});
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace dismantle
