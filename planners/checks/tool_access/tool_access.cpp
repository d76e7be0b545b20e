#include "tool_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <sstream>

#include "dismantle/errors.h"
#include "fastener_memo.h"
#include "judge.h"

namespace dismantle::checks {
namespace {

std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string item; std::getline(in, item, ',');) {
    const auto from = item.find_first_not_of(" \t"), to = item.find_last_not_of(" \t");
    if (from != std::string::npos) out.push_back(item.substr(from, to - from + 1));
  }
  return out;
}

/// `left_out` receives the tools that `only` does not name.
std::vector<tools::Tool> chosen(const ToolAccessParameters& params, std::vector<tools::Tool>& left_out) {
  std::vector<tools::Tool> all;
  std::vector<Diagnostic> problems;
  for (const std::string& file : listed(params.catalogue))
    for (tools::Tool& tool : tools::read_catalogue(std::filesystem::path(file))) {
      if (std::any_of(all.begin(), all.end(), [&](const tools::Tool& t) { return t.id == tool.id; }))
        problems.push_back({file, 0, 0, fmt::format("the tool '{}' is in another catalogue, too", tool.id)});
      all.push_back(std::move(tool));
    }
  const std::vector<std::string> only = listed(params.only);
  if (all.empty() && !only.empty()) all = tools::standard_catalogue();
  for (const std::string& id : only)
    if (std::none_of(all.begin(), all.end(), [&](const tools::Tool& t) { return t.id == id; }))
      problems.push_back({"", 0, 0, fmt::format("tool_access: only: there is no tool '{}' in the catalogue", id)});
  if (!problems.empty()) throw ConfigError(std::move(problems));
  if (only.empty()) return all;
  const auto end = std::stable_partition(all.begin(), all.end(), [&](const tools::Tool& t) {
    return std::find(only.begin(), only.end(), t.id) != only.end();
  });
  left_out.assign(end, all.end());
  all.erase(end, all.end());
  return all;
}

}  // namespace

void ToolAccessParameters::describe(Schema<ToolAccessParameters>& s) {
  s.add("catalogue", &ToolAccessParameters::catalogue,
        {.doc = "Files with tools, separated by commas (docs/tools.md). Empty: the tools that come with the program."});
  s.add("only", &ToolAccessParameters::only,
        {.doc = "Ids of the tools that there are, separated by commas. Empty: all."});
  s.add("hand", &ToolAccessParameters::hand, {.doc = "The hand that holds the tool needs room, too."});
}

ToolAccess::ToolAccess(const ToolAccessParameters& params) : params_(params), own_(chosen(params, left_out_)) {}
ToolAccess::~ToolAccess() = default;

const std::vector<tools::Tool>& ToolAccess::tools() const { return own_.empty() ? tools::standard_catalogue() : own_; }

std::shared_ptr<const FastenerMemo> ToolAccess::memo_of(const Assembly& assembly) const {
  const std::lock_guard lock(mutex_);
  if (!known_ || !known_->is_of(assembly)) known_ = std::make_shared<const FastenerMemo>(assembly);
  return known_;
}

StepVerdict ToolAccess::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  const std::shared_ptr<const FastenerMemo> memo = memo_of(question.assembly);
  // Without a fastener there is nothing to say, and the catalogue, which takes longest to read, is not needed.
  const auto none_driven = [&](std::span<const PlacedPart> parts) {
    return std::none_of(parts.begin(), parts.end(),
                        [&](const PlacedPart& p) { return memo->driven(p.part) != nullptr; });
  };
  if (none_driven(question.moving) && (question.previous != nullptr || none_driven(question.present))) return {};
  return judge_step(*memo, {tools(), left_out_, params_.hand}, question);
}

}  // namespace dismantle::checks
