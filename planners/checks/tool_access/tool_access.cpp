#include "tool_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/tools/access.h"
#include "fastener_memo.h"

namespace dismantle::checks {
namespace {

constexpr double kChange = 0.1;  // of the tool; ten changes are as bad as a fastener that cannot be driven

std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string item; std::getline(in, item, ',');) {
    const auto from = item.find_first_not_of(" \t"), to = item.find_last_not_of(" \t");
    if (from != std::string::npos) out.push_back(item.substr(from, to - from + 1));
  }
  return out;
}

std::vector<tools::Tool> chosen(const ToolAccessParams& params) {
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
  if (!only.empty())
    std::erase_if(all, [&](const tools::Tool& t) { return std::find(only.begin(), only.end(), t.id) == only.end(); });
  return all;
}

std::string direction_text(const Eigen::Vector3d& d) {
  const auto rounded = [](double x) { return std::round(x * 100) / 100 + 0.0; };
  return fmt::format("({:g}, {:g}, {:g})", rounded(d.x()), rounded(d.y()), rounded(d.z()));
}

std::string names(const Assembly& assembly, const std::vector<std::size_t>& parts) {
  std::string out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    out += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ", assembly.parts[parts[i]].name);
  return out + (parts.size() == 1 ? " is" : " are");
}

std::string drive_text(const tools::Fastener& f) {
  if (f.kind == fasteners::Kind::ring) return fmt::format("ring of {:.3g} mm", f.size);
  return fmt::format("{} {:.4g}", fasteners::to_string(f.drive), std::round(20 * f.size) / 20);
}

std::string use_text(const tools::Tool& tool, const tools::Use& use) {
  return use.name.empty() ? tool.name : fmt::format("{}, {}", tool.name, use.name);
}

nlohmann::json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// What was found for one fastener.
struct Reach {
  const tools::Tool* tool = nullptr;  // null: none of the catalogue fits
  tools::Access access;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  // top of the fastener, input units
};

class Judge {
 public:
  Judge(const FastenerMemo& memo, const std::vector<tools::Tool>& all, bool hand, const StepQuestion& question)
      : memo_(memo), all_(all), hand_(hand), q_(question), held_(all.size()) {}

  StepVerdict verdict() {
    take_up_held();
    for (const PlacedPart& part : q_.moving)
      if (const Driven* driven = memo_.driven(part.part)) look_at(*driven, part.pose);
    verdict_.cost = unreached_ + kChange * changes_;
    if (unreached_ == 0 && changes_ > 0) verdict_.reason = "another tool than in the step before";
    return std::move(verdict_);
  }

 private:
  const std::string& name(const Driven& driven) const { return memo_.assembly().parts[driven.part].name; }
  static bool is_in(PartId part, std::span<const PlacedPart> list) {
    return std::any_of(list.begin(), list.end(), [&](const PlacedPart& p) { return p.part == part; });
  }
  void note(const char* kind, std::string text, const Driven& driven, nlohmann::json data) {
    data["part"] = name(driven);
    if (!driven.size.empty()) data["size"] = driven.size;
    if (memo_.assembly().unit.empty()) {
      data["assumed"] = "mm";
      text += " (The input states no unit; mm is assumed.)";
    }
    verdict_.notes.push_back({fmt::format("tool_access.{}", kind), std::move(text), data.dump()});
  }
  std::string label(const Driven& driven) const {
    const std::string drive = drive_text(driven.fastener);
    return driven.size.empty() ? fmt::format("'{}' ({})", name(driven), drive)
                               : fmt::format("'{}' ({}, {})", name(driven), driven.size, drive);
  }

  void look_at(const Driven& driven, const Pose& pose) {
    // In its place with a part that moves, too, it was driven before; a nut that is on nothing is not driven yet.
    std::optional<PartId> partner;
    for (const PartId part : driven.partners) {
      if (is_in(part, q_.moving)) return;
      if (!is_in(part, q_.present)) continue;
      partner = part;
      break;
    }
    const tools::Fastener& f = driven.fastener;
    if (!partner && f.kind != fasteners::Kind::screw) return;
    // A nut that is put in across its axis goes into a trap and is not screwed on.
    if (f.kind == fasteners::Kind::nut && !q_.direction.isZero() && std::abs(q_.direction.dot(pose.q * f.axis)) < 0.1)
      return;
    const bool no_drive = f.kind != fasteners::Kind::ring && (f.drive == fasteners::Drive::none || !(f.size > 0));
    const bool no_size = f.kind != fasteners::Kind::ring && (driven.size.empty() || driven.size.front() == '?');
    const char* why = no_drive ? "its drive is not recognised" : no_size ? "its size is in no table" : nullptr;
    if (why != nullptr) {
      note("not_checked", fmt::format("Whether a tool reaches '{}' was not checked: {}.", name(driven), why), driven,
           {{"reason", why}});
      return;
    }
    report(driven, reach(driven, partner, pose));
  }

  /// Tools that fit a fastener of the step before: one of them is in the hand.
  void take_up_held() {
    if (q_.previous == nullptr) return;
    for (const PlacedPart& part : q_.previous->moving)
      if (const Driven* driven = memo_.driven(part.part))
        for (std::size_t t = 0; t < all_.size(); ++t) held_[t] = held_[t] || tools::fits(all_[t], driven->fastener);
  }

  Reach reach(const Driven& driven, std::optional<PartId> partner, const Pose& pose) {
    std::vector<PlacedPart> there(q_.present.begin(), q_.present.end());
    for (const PlacedPart& part : q_.moving)
      if (part.part != driven.part) there.push_back(part);
    // A nut or ring is put on from one side, and the tool comes from there.
    const double against = -q_.direction.dot(pose.q * driven.fastener.axis);
    std::vector<bool> sides{driven.either_side && against < 0};
    if (driven.either_side && std::abs(against) < 0.1) sides.push_back(!sides.front());
    Reach best;
    const std::vector<bool> in_hand = held_;
    for (const bool first : {true, false}) {
      std::size_t place = 0;
      for (std::size_t t = 0; t < all_.size(); place += all_[t++].uses.size()) {
        if (in_hand[t] != first || !tools::fits(all_[t], driven.fastener)) continue;
        for (const bool flipped : sides) {
          const tools::Fastener fastener = memo_.driven_by(driven, partner, flipped);
          for (std::size_t u = 0; u < all_[t].uses.size(); ++u) {
            Reach found{
                &all_[t], {}, pose.q * fastener.axis, memo_.assembly().normalization.to_input(pose * fastener.top)};
            found.access = memo_.room(driven, fastener, flipped, all_[t].uses[u], place + u, there, pose, hand_);
            if (found.access.reaches()) {
              if (!first && (q_.previous != nullptr || used_)) ++changes_;
              held_[t] = used_ = true;
              return found;
            }
            if (best.tool == nullptr || found.access.in_the_way.size() < best.access.in_the_way.size())
              best = std::move(found);
          }
        }
      }
    }
    return best;
  }

  void report(const Driven& driven, const Reach& found) {
    if (found.tool != nullptr && found.access.reaches()) {
      const tools::Use& use = *found.access.use;
      const double degrees = use.swing * 180 / std::numbers::pi;
      std::string text =
          fmt::format("{}: {}, from {}", label(driven), use_text(*found.tool, use), direction_text(found.axis));
      text += use.swing > 0 ? fmt::format(", handle to {}, {:.0f} degrees between two grips.",
                                          direction_text(found.access.handle), degrees)
                            : ".";
      note("tool", std::move(text), driven,
           {{"tool", found.tool->id},
            {"use", use.name},
            {"at", json_of(found.at)},
            {"from", json_of(found.axis)},
            {"handle", json_of(found.access.handle)},
            {"swing", use.swing}});
      return;
    }
    ++unreached_;
    std::string text;
    nlohmann::json data = nlohmann::json::object();
    if (found.tool == nullptr) {
      text = fmt::format("No tool of the catalogue fits {}.", label(driven));
    } else {
      text = fmt::format("No tool of the catalogue reaches {}: {} in the way of {}.", label(driven),
                         names(memo_.assembly(), found.access.in_the_way), use_text(*found.tool, *found.access.use));
      data["tool"] = found.tool->id;
      data["use"] = found.access.use->name;
      for (const std::size_t part : found.access.in_the_way)
        data["in_the_way"].push_back(memo_.assembly().parts[part].name);
    }
    if (verdict_.reason.empty()) verdict_.reason = fmt::format("no tool reaches '{}'", name(driven));
    note("blocked", std::move(text), driven, std::move(data));
  }

  const FastenerMemo& memo_;
  const std::vector<tools::Tool>& all_;
  bool hand_;
  const StepQuestion& q_;
  StepVerdict verdict_;
  std::vector<bool> held_;  // by tool
  bool used_ = false;       // a tool, in this step
  int unreached_ = 0, changes_ = 0;
};

}  // namespace

void ToolAccessParams::describe(Schema<ToolAccessParams>& s) {
  s.add("catalogue", &ToolAccessParams::catalogue,
        {.doc = "Files with tools, separated by commas (docs/tools.md). Empty: the tools that come with the program."});
  s.add("only", &ToolAccessParams::only, {.doc = "Ids of the tools that there are, separated by commas. Empty: all."});
  s.add("hand", &ToolAccessParams::hand, {.doc = "The hand that holds the tool needs room, too."});
}

ToolAccess::ToolAccess(const ToolAccessParams& params) : params_(params), own_(chosen(params)) {}
ToolAccess::~ToolAccess() = default;

const std::vector<tools::Tool>& ToolAccess::tools() const { return own_.empty() ? tools::standard_catalogue() : own_; }

std::shared_ptr<const FastenerMemo> ToolAccess::memo_of(const Assembly& assembly) const {
  const std::lock_guard lock(mutex_);
  if (!known_ || !known_->is_of(assembly)) known_ = std::make_shared<const FastenerMemo>(assembly);
  return known_;
}

StepVerdict ToolAccess::judge(const StepQuestion& question, const RunContext& /*context*/) const {
  const std::shared_ptr<const FastenerMemo> memo = memo_of(question.assembly);
  return Judge(*memo, tools(), params_.hand, question).verdict();
}

}  // namespace dismantle::checks
