#include "dismantle/plan_io/job_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <tuple>

#include "dismantle/plan_io/csv_text.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> kKinds{"screw", "nut", "washer", "insert", "stand-off", "pin", "ring"};

std::size_t rank_of(const std::string& kind) {
  return static_cast<std::size_t>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
}

/// Numbers in a size, so that M10 comes after M3.
std::vector<double> numbers_in(const std::string& size) {
  std::vector<double> out;
  for (const char *p = size.data(), *end = p + size.size(); p != end;) {
    double value = 0;
    const auto [rest, error] = std::from_chars(p, end, value);
    if (error == std::errc{}) out.push_back(value);
    p = error == std::errc{} ? rest : p + 1;
  }
  return out;
}

/// What the user states, as the reason of the kind has it.
std::string stated(const PartKind& kind, std::string_view key) {
  if (!kind.stated) return {};
  const std::size_t at = kind.reason.find(key);
  if (at == std::string::npos) return {};
  const std::string rest = kind.reason.substr(at + key.size());
  return key == "; torque " ? rest.substr(0, rest.find(" N m")) : rest;
}

std::string text_in(const json& data, const char* key) {
  return data.contains(key) && data[key].is_string() ? data[key].get<std::string>() : std::string();
}

/// What a note of `tool_access` says; null: it is of another kind.
json data_of(const StepNote& note) {
  if (!note.kind.starts_with("tool_access.")) return nullptr;
  json data = json::parse(note.data, nullptr, false);
  return data.is_object() ? data : json(nullptr);
}

/// The tool on one end.
struct Use {
  std::string part, id, name;
};
std::vector<Use> uses_in(const json& data) {
  const auto use = [](const json& from, const char* part) {
    Use out{text_in(from, part), text_in(from, "tool"), text_in(from, "name")};
    if (out.name.empty()) out.name = out.id;
    return out;
  };
  std::vector<Use> out{use(data, data.contains("turned") ? "turned" : "part")};
  if (data.contains("hold") && data["hold"].is_object()) out.push_back(use(data["hold"], "part"));
  std::erase_if(out, [](const Use& u) { return u.part.empty() || u.id.empty(); });
  return out;
}

/// Names of parts that are no item of the job: bodies inside products, and rings inside lock nuts.
std::set<std::string> inner_parts(const Plan& plan) {
  std::set<std::string> out;
  std::map<std::string, const PlanPart*> known;
  for (const PlanPart& part : plan.assembly.parts) {
    known[part.name] = &part;
    if (part.kind && part.kind->reason.find("ring inside nut '") != std::string::npos) out.insert(part.name);
  }
  for (const PlanComponent& component : plan.assembly.components) {
    const auto is_fastener = [&](const std::string& name) {
      const auto part = known.find(name);
      return part != known.end() && part->second->kind && rank_of(part->second->kind->kind) < kKinds.size();
    };
    if (component.kept && !std::all_of(component.parts.begin(), component.parts.end(), is_fastener))
      out.insert(component.parts.begin(), component.parts.end());
  }
  return out;
}

void add_new(std::vector<std::string>& list, const std::string& text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

class Job {
 public:
  Job(const Plan& plan, bool disassembly) : plan_(plan) {
    const std::size_t steps = plan.disassembly.size();
    for (std::size_t i = 0; i < steps; ++i) {
      const std::size_t k = disassembly ? i : steps - 1 - i;
      look_at(plan.disassembly[k], step_number(plan, k, disassembly));
    }
  }

  JobList list() {
    add_fasteners();
    for (JobTool& tool : list_.tools)
      for (const JobFastener& f : list_.fasteners) {
        const auto driven = std::count_if(f.parts.begin(), f.parts.end(), [&](const std::string& part) {
          return std::find(tools_[part].begin(), tools_[part].end(), tool.name) != tools_[part].end();
        });
        if (driven > 0) tool.fasteners.push_back(fmt::format("{}x {}", driven, f.size.empty() ? f.kind : f.size));
      }
    return std::move(list_);
  }

 private:
  void look_at(const PlanStep& step, std::size_t number) {
    for (const PlanMove& move : step.moves) step_of_.try_emplace(move.part, number);
    for (const PlanVerdict& verdict : step.checks)
      for (const StepNote& note : verdict.notes)
        if (const json data = data_of(note); !data.is_null()) look_at(data, note.kind == "tool_access.tool", number);
  }

  void look_at(const json& data, bool has_tool, std::size_t number) {
    if (const std::string drive = text_in(data, "drive"); !drive.empty()) drive_[text_in(data, "part")] = drive;
    if (!has_tool || data.contains("by_hand")) return;
    if (data.contains("hold") && data["hold"].is_object())
      drive_[text_in(data["hold"], "part")] = text_in(data["hold"], "drive");
    for (const Use& use : uses_in(data)) {
      add_new(tools_[use.part], use.name);
      auto tool =
          std::find_if(list_.tools.begin(), list_.tools.end(), [&](const JobTool& t) { return t.id == use.id; });
      if (tool == list_.tools.end()) tool = list_.tools.insert(tool, {use.id, use.name, {}});
      if (tool->steps.empty() || tool->steps.back() != number) tool->steps.push_back(number);
    }
  }

  void add_fasteners() {
    const std::set<std::string> inner = inner_parts(plan_);
    std::map<std::tuple<std::size_t, std::vector<double>, std::string, std::string, std::string, std::string>,
             JobFastener>
        groups;
    for (const PlanPart& part : plan_.assembly.parts) {
      if (!part.kind || inner.contains(part.name)) continue;
      const std::size_t rank = rank_of(part.kind->kind);
      if (rank == kKinds.size() && !tools_.contains(part.name)) continue;
      const std::string torque = stated(*part.kind, "; torque "), glue = stated(*part.kind, "; glue: ");
      const std::string size = part.kind->size, drive = drive_[part.name];
      JobFastener& f = groups[{rank, numbers_in(size), part.kind->kind + size, drive, torque, glue}];
      f.kind = part.kind->kind;
      f.size = size;
      f.drive = drive;
      f.glue = glue;
      if (double value = 0; std::from_chars(torque.data(), torque.data() + torque.size(), value).ec == std::errc{})
        f.torque = value;
      f.parts.push_back(part.name);
      for (const std::string& tool : tools_[part.name]) add_new(f.tools, tool);
      if (const auto step = step_of_.find(part.name); step != step_of_.end()) f.steps.push_back(step->second);
    }
    for (auto& [key, f] : groups) {
      std::sort(f.steps.begin(), f.steps.end());
      f.steps.erase(std::unique(f.steps.begin(), f.steps.end()), f.steps.end());
      list_.fasteners.push_back(std::move(f));
    }
  }

  const Plan& plan_;
  JobList list_;
  std::map<std::string, std::size_t> step_of_;
  std::map<std::string, std::vector<std::string>> tools_;  // names, by part
  std::map<std::string, std::string> drive_;
};

}  // namespace

JobList job_list(const Plan& plan, bool disassembly) { return Job(plan, disassembly).list(); }

std::string fastener_words(const JobFastener& f) {
  std::string out = fmt::format("{}x {}{}", f.parts.size(), f.kind, f.size.empty() ? "" : " " + f.size);
  std::vector<std::string> more;
  if (!f.tools.empty()) more.push_back(fmt::format("{}", fmt::join(f.tools, " or ")));
  if (f.torque) more.push_back(fmt::format("{:g} N m", *f.torque));
  if (!f.glue.empty()) more.push_back("glue: " + f.glue);
  return more.empty() ? out : out + fmt::format(": {}", fmt::join(more, "; "));
}

std::string tool_words(const JobTool& tool) {
  return fmt::format("{}: {}, {} {}", tool.name, fmt::join(tool.fasteners, ", "),
                     tool.steps.size() == 1 ? "step" : "steps", fmt::join(tool.steps, ", "));
}

std::string fasteners_csv(const Plan& plan) {
  std::string out = "count,kind,size,drive,tools,torque,glue,steps,parts\n";
  for (const JobFastener& f : job_list(plan).fasteners)
    out += fmt::format("{},{},{},{},{},{},{},{},{}\n", f.parts.size(), csv_field(f.kind), csv_field(f.size),
                       csv_field(f.drive), csv_field(fmt::format("{}", fmt::join(f.tools, ";"))),
                       f.torque ? fmt::format("{:g}", *f.torque) : "", csv_field(f.glue), fmt::join(f.steps, ";"),
                       csv_field(fmt::format("{}", fmt::join(f.parts, ";"))));
  return out;
}

std::string tools_csv(const Plan& plan) {
  std::string out = "id,name,fasteners,steps\n";
  for (const JobTool& t : job_list(plan).tools)
    out += fmt::format("{},{},{},{}\n", csv_field(t.id), csv_field(t.name),
                       csv_field(fmt::format("{}", fmt::join(t.fasteners, ";"))), fmt::join(t.steps, ";"));
  return out;
}

}  // namespace dismantle
