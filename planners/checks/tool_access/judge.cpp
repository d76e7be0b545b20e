#include "judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "advice.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/tools/two_tools.h"
#include "order_notes.h"
#include "tool_picture.h"
#include "tool_words.h"

namespace dismantle::checks {
namespace {

using fasteners::Kind;
using nlohmann::json;

constexpr double kChange = 0.1;  // of the tool; ten changes are as bad as a fastener that cannot be driven

class Judge {
 public:
  Judge(const FastenerMemo& memo, const Bench& bench, const StepQuestion& question)
      : memo_(memo),
        all_(bench.tools),
        left_out_(bench.left_out),
        hand_(bench.hand),
        q_(question),
        in_hand_(bench.tools.size()) {
    there_.assign(q_.present.begin(), q_.present.end());
    there_.insert(there_.end(), q_.moving.begin(), q_.moving.end());
  }

  StepVerdict verdict() {
    take_up_held();
    if (q_.previous == nullptr)  // what there is before the first step was put in by none
      for (const PlacedPart& part : q_.present) look_at_first(part);
    for (const PlacedPart& part : q_.moving)
      if (const Driven* driven = memo_.driven(part.part)) look_at(*driven, part.pose);
    verdict_.cost = unreached_ + early_ + kChange * changes_;
    if (verdict_.reason.empty() && changes_ > 0) verdict_.reason = "another tool than in the step before";
    return std::move(verdict_);
  }

 private:
  const std::string& name(PartId part) const { return memo_.assembly().parts[part].name; }
  const std::string& name(const Driven& driven) const { return name(driven.part); }
  /// The parts that are there, without one of them.
  std::vector<PlacedPart> without(PartId part) const {
    std::vector<PlacedPart> out = there_;
    std::erase_if(out, [&](const PlacedPart& p) { return p.part == part; });
    return out;
  }

  void note(const char* kind, std::string text, const Driven& driven, json data) {
    data["part"] = name(driven);
    if (!driven.size.empty()) data["size"] = driven.size;
    if (is_turned(driven) && has_drive(driven)) data["drive"] = drive_text(driven.fastener);
    add_fastening(memo_, driven, text, data);
    if (memo_.assembly().unit.empty()) data["assumed"] = "mm";  // said once for the whole plan
    verdict_.notes.push_back({fmt::format("tool_access.{}", kind), std::move(text), data.dump()});
  }
  void look_at(const Driven& driven, const Pose& pose) {
    const tools::Fastener& f = driven.fastener;
    std::optional<PartId> other;  // the nut of a screw, the screw of a nut
    if (f.kind == Kind::screw) other = memo_.nut_of(driven.part);
    if (f.kind == Kind::nut) other = memo_.screw_in(driven.part);
    // In its place with a part that moves, too, it was driven before; a nut that is on nothing is not driven yet.
    std::optional<PartId> partner;
    for (const PartId part : driven.partners) {
      if (is_in(part, q_.moving)) return;
      if (!partner && is_in(part, q_.present)) partner = part;
    }
    if (other && is_in(*other, q_.moving)) return;
    if (f.kind == Kind::nut && other && !is_in(*other, q_.present)) return look_at_early_nut(driven, *other, pose);
    if (!partner && f.kind != Kind::screw) return;
    if (!driven.unknown.empty()) return not_checked(driven, driven.unknown);
    // A nut that is put in across its axis goes into a trap and is not screwed on.
    if (f.kind == Kind::nut && !q_.direction.isZero() && std::abs(q_.direction.dot(pose.q * f.axis)) < 0.1) return;
    if (f.kind == Kind::screw && other && !is_in(*other, q_.present)) {
      note("later", fmt::format("Put in '{}' by hand: '{}' is screwed on later.", name(driven), name(*other)), driven,
           {{"nut", name(*other)}});
      return;
    }
    const char* why = !has_drive(driven)  ? "its drive is not recognised"
                      : !has_size(driven) ? "its size is in no table"
                                          : nullptr;
    if (why != nullptr)
      not_checked(driven, why);
    else if (driven.pressed)
      report_pressed(driven, answer(driven, partner, {}, pose), *partner, pose);
    else
      report(driven, answer(driven, partner, other, pose), pose);
    if (const auto screw = f.kind == Kind::nut ? other : driven.part) look_at_order(*screw);
  }

  void not_checked(const Driven& driven, const std::string& why) {
    note("not_checked", fmt::format("Whether a tool reaches '{}' was not checked: {}.", name(driven), why), driven,
         {{"reason", why}});
  }

  void add_early(StepNote note, std::string reason) {
    ++early_;
    if (verdict_.reason.empty()) verdict_.reason = std::move(reason);
    verdict_.notes.push_back(std::move(note));
  }
  void look_at_first(const PlacedPart& part) {
    const Driven* driven = memo_.driven(part.part);
    if (driven == nullptr || driven->fastener.kind != Kind::nut) return;
    const auto screw = memo_.screw_in(part.part);
    if (screw && !is_in(*screw, q_.present)) look_at_early_nut(*driven, *screw, part.pose);
  }
  /// A nut without its screw stays where it is if it cannot turn there.
  void look_at_early_nut(const Driven& nut, PartId screw, const Pose& pose) {
    if (memo_.kept_by(nut, there_, pose)) return;
    add_early(early_nut_note(memo_, nut.part, screw),
              fmt::format("'{}' is put in before its screw '{}'", name(nut), name(screw)));
  }
  /// What the order of the screws calls for.
  void look_at_order(PartId screw) {
    if (auto note = early_note(memo_, there_, screw))
      add_early(std::move(*note), fmt::format("'{}' is tightened before what it fastens is there", name(screw)));
    const fasteners::Pattern* pattern = memo_.pattern_of(screw);
    if (pattern == nullptr || std::find(said_.begin(), said_.end(), pattern) != said_.end()) return;
    said_.push_back(pattern);
    if (auto note = pattern_note(memo_, q_.present, screw)) verdict_.notes.push_back(std::move(*note));
  }

  /// Tools that fit the fasteners of the step before: one of each is in the hand.
  void take_up_held() {
    if (q_.previous == nullptr) return;
    const auto take = [&](const Driven* driven) {
      for (std::size_t t = 0; driven != nullptr && t < all_.size(); ++t)
        in_hand_[t] = in_hand_[t] || tools::fits(all_[t], driven->fastener);
    };
    for (const PlacedPart& part : q_.previous->moving) {
      const Driven* driven = memo_.driven(part.part);
      take(driven);
      if (driven == nullptr) continue;
      const auto other = driven->fastener.kind == Kind::nut ? memo_.screw_in(part.part) : memo_.nut_of(part.part);
      if (other) take(memo_.driven(*other));
    }
  }

  Task task(const Driven& turned, const Driven* other, std::optional<PartId> partner, const Pose& pose) const {
    Task out{&turned, nullptr, partner, {}, false};
    if (other == nullptr) return out;
    out.kept_by = memo_.kept_by(*other, there_, pose);
    if (out.kept_by) return out;
    if (has_drive(*other) && has_size(*other))
      out.held = other;
    else
      out.hold_unknown = true;
    return out;
  }

  /// The fastener is turned, or what is on its other end if that alone has room.
  Answer answer(const Driven& driven, std::optional<PartId> partner, std::optional<PartId> other, const Pose& pose) {
    const Driven* end = nullptr;
    for (const PlacedPart& part : q_.present)
      if (other && part.part == *other && (part.pose == pose || (pose.inverse() * part.pose).is_identity(1e-9)))
        end = memo_.driven(*other);
    const bool kept = end != nullptr && memo_.kept_by(driven, there_, pose).has_value();
    Answer first = kept ? Answer{} : carried_out(task(driven, end, partner, pose), pose);
    if (end == nullptr || first.reaches() || !has_drive(*end) || !has_size(*end)) return first;
    Answer second = carried_out(task(*end, &driven, driven.part, pose), pose);
    return second.reaches() || kept ? second : first;
  }

  /// Sides from which the tool comes; true: from the end that the axis does not point to.
  std::vector<bool> sides_of(const Driven& driven, const Pose& pose) const {
    if (!driven.either_side) return {false};
    if (const auto screw = memo_.screw_in(driven.part))
      return {memo_.driven(*screw) != nullptr && memo_.driven(*screw)->fastener.axis.dot(driven.fastener.axis) > 0};
    // A nut or ring is put on from one side, and the tool comes from there.
    const double against = -q_.direction.dot(pose.q * driven.fastener.axis);
    std::vector<bool> sides{against < 0};
    if (std::abs(against) < 0.1) sides.push_back(!sides.front());
    return sides;
  }

  /// Calls f(tool, number of its first use) for each tool that fits, those in the hand first, until f is true.
  template <class F>
  bool for_tools(const Driven& driven, const F& f) const {
    for (const bool first : {true, false}) {
      std::size_t place = 0;
      for (std::size_t t = 0; t < all_.size(); place += all_[t++].uses.size())
        if (in_hand_[t] == first && tools::fits(all_[t], driven.fastener) && f(t, place)) return true;
    }
    return false;
  }

  Reach reach_of(const tools::Tool& tool, const tools::Fastener& f, const Pose& pose, tools::Access access) const {
    const Normalization& units = memo_.assembly().normalization;
    Reach out{&tool, std::move(access), pose.q * f.axis, units.to_input(pose * f.top)};
    out.fastener = f;
    if (out.reaches()) out.seat = units.to_input(pose * tools::seat_of(*out.access.use, f));
    return out;
  }

  Answer carried_out(const Task& task, const Pose& pose) {
    Answer out{task, {}, {}};
    bool turns = false;  // some tool reaches what is turned
    const std::vector<PlacedPart> there = without(task.turned->part);
    for_tools(*task.turned, [&](std::size_t t, std::size_t place) {
      for (const bool flipped : sides_of(*task.turned, pose)) {
        const tools::Fastener fastener = memo_.driven_by(*task.turned, task.partner, flipped);
        for (std::size_t u = 0; u < all_[t].uses.size(); ++u) {
          const tools::Use& use = all_[t].uses[u];
          const BlockedBy blocked = memo_.blocked(*task.turned, fastener, flipped, use, place + u, there, pose, hand_);
          Reach found = reach_of(all_[t], fastener, pose, FastenerMemo::room(fastener, use, blocked, there, pose));
          found.flipped = flipped;
          found.place = place + u;
          if (!found.reaches()) {
            if (!turns && found.access.obstacles.size() == 1) out.one_obstacle.push_back(found);
            if (!turns) keep_better(out.turning, std::move(found));
            continue;
          }
          turns = true;
          out.turning = std::move(found);
          if (task.held != nullptr && !hold(task, {use, fastener, blocked.arcs()}, pose, out)) continue;
          return true;
        }
      }
      return false;
    });
    return out;
  }

  /// A tool that `only` leaves out, and that would reach; null: none.
  const tools::Tool* left_out_for(const Task& task, const Pose& pose) const {
    std::size_t place = 0;  // they are numbered after the others
    for (const tools::Tool& tool : all_) place += tool.uses.size();
    const std::vector<PlacedPart> there = without(task.turned->part);
    for (const tools::Tool& tool : left_out_) {
      const bool fits = tools::fits(tool, task.turned->fastener);
      for (std::size_t u = 0; fits && u < tool.uses.size(); ++u)
        for (const bool flipped : sides_of(*task.turned, pose)) {
          const tools::Fastener f = memo_.driven_by(*task.turned, task.partner, flipped);
          const BlockedBy blocked =
              memo_.blocked(*task.turned, f, flipped, tool.uses[u], place + u, there, pose, hand_);
          if (FastenerMemo::room(f, tool.uses[u], blocked, there, pose).reaches()) return &tool;
        }
      place += tool.uses.size();
    }
    return nullptr;
  }

  /// A tool for the other end that does not meet the one that turns.
  bool hold(const Task& task, const tools::ToolOn& turning, const Pose& pose, Answer& out) {
    const std::vector<PlacedPart> there = without(task.held->part);
    return for_tools(*task.held, [&](std::size_t t, std::size_t place) {
      const bool flipped = sides_of(*task.held, pose).front();
      tools::Fastener fastener = memo_.driven_by(*task.held, std::nullopt, flipped);
      fastener.travel = 0;
      for (std::size_t u = 0; u < all_[t].uses.size(); ++u) {
        tools::Use still = all_[t].uses[u];
        still.swing = 0;
        const BlockedBy blocked = memo_.blocked(*task.held, fastener, flipped, still, place + u, there, pose, hand_);
        Reach found = reach_of(all_[t], fastener, pose, FastenerMemo::room(fastener, still, blocked, there, pose));
        found.access.use = &all_[t].uses[u];
        std::optional<tools::BothAccess> both;
        if (found.reaches()) both = tools::room_for_both(turning, {still, fastener, blocked.arcs()}, hand_);
        if (both) {
          out.turning.access.start = both->turning.start;
          out.turning.access.handle = pose.q * both->turning.handle;
          found.access.handle = pose.q * both->holding.handle;
          out.holding = std::move(found);
          return true;
        }
        if (found.reaches()) found.access.handle.setZero();  // the other tool is in the way
        keep_better(out.holding, std::move(found));
      }
      return false;
    });
  }

  /// The tools of a task that is done are in the hands; those that were not before are changes.
  void take_up(const Answer& a) {
    const bool counts = q_.previous != nullptr || used_;
    for (const Reach* reach : {&a.turning, &a.holding}) {
      if (!reach->reaches()) continue;
      const auto index = static_cast<std::size_t>(reach->tool - all_.data());
      if (!in_hand_[index] && counts) ++changes_;
      in_hand_[index] = used_ = true;
    }
  }

  json place_of(const Driven& driven, const Reach& found) const {
    return checks::place_of(memo_.assembly(), driven, found, hand_);
  }

  /// Where only facets overlap it may go in by hand: that costs nothing.
  void report_pressed(const Driven& driven, const Answer& a, PartId partner, const Pose& pose) {
    if (!a.reaches()) return driven.sure ? report_blocked(driven, a, pose) : void();
    if (driven.sure) take_up(a);
    const std::string use = use_text(*a.turning.tool, *a.turning.access.use);
    std::string text =
        fmt::format("{} has no play in '{}': {}{}, {}.", label(name(driven), driven), name(partner),
                    driven.sure ? "" : "if it does not go in by hand, ", use, from_text(a.turning.axis, q_.up));
    json data = place_of(driven, a.turning);
    if (!driven.sure) data["by_hand"] = true;
    note("tool", std::move(text), driven, std::move(data));
  }

  void report(const Driven& driven, const Answer& a, const Pose& pose) {
    if (!a.reaches()) return report_blocked(driven, a, pose);
    take_up(a);
    const Driven& turned = *a.task.turned;
    const tools::Use& use = *a.turning.access.use;
    std::string text = fmt::format("{}: {}, {}", label(name(turned), turned), use_text(*a.turning.tool, use),
                                   from_text(a.turning.axis, q_.up));
    if (use.swing > 0) text += fmt::format(", {:.0f} degrees at a time", use.swing * 180 / std::numbers::pi);
    json data = place_of(turned, a.turning);
    if (const double pitch = fasteners::pitch_of(turned.size); pitch > 0) {
      const int turns = std::max(1, static_cast<int>(std::lround(a.turning.fastener.travel / pitch)));
      text += fmt::format(", {} {} of {:.4g} mm", turns, turns == 1 ? "turn" : "turns", pitch);
      data["pitch"] = pitch;
      data["turns"] = turns;
    }
    if (&turned != &driven) data["turned"] = name(turned);
    if (a.task.held != nullptr) {
      const Driven& held = *a.task.held;
      text += fmt::format("; hold {} with {}, {}", label(name(held), held),
                          use_text(*a.holding.tool, *a.holding.access.use), from_text(a.holding.axis, q_.up));
      data["hold"] = place_of(held, a.holding);
      data["hold"].erase("swing");
      data["hold"]["drive"] = drive_text(held.fastener);
    } else if (a.task.kept_by) {
      text += fmt::format("; its other end cannot turn in '{}'", name(*a.task.kept_by));
      data["kept_by"] = name(*a.task.kept_by);
    } else if (a.task.hold_unknown) {
      text += "; how its other end is held was not checked: its drive is not recognised";
    }
    note("tool", text + ".", driven, std::move(data));
  }

  void report_blocked(const Driven& driven, const Answer& a, const Pose& pose) {
    ++unreached_;
    const bool turns = a.turning.reaches();
    const Driven& about = turns ? *a.task.held : *a.task.turned;
    const Reach& best = turns ? a.holding : a.turning;
    const char* does = turns ? "holds" : "reaches";
    std::string text;
    json data = json::object();
    if (best.tool == nullptr) {
      text = fmt::format("No tool of the catalogue fits {}.", label(name(about), about));
    } else {
      std::vector<std::string> names;
      for (const std::size_t part : best.access.obstacles) names.push_back(name(static_cast<PartId>(part)));
      text = fmt::format("No tool of the catalogue {} {}: {} {} in the way of {}.", does, label(name(about), about),
                         names.empty() ? "the other tool" : listed_names(names), names.size() > 1 ? "are" : "is",
                         use_text(*best.tool, *best.access.use));
      data["tool"] = best.tool->id;
      data["use"] = best.access.use->name;
      for (const std::size_t part : best.access.obstacles)
        data["in_the_way"].push_back(name(static_cast<PartId>(part)));
    }
    if (&about != &driven) data[turns ? "held" : "turned"] = name(about);
    if (const tools::Tool* other = turns ? nullptr : left_out_for(a.task, pose)) {
      text += fmt::format(" The catalogue has one that does: {}.", other->name);
      data["left_out"] = other->id;
    }
    if (best.tool != nullptr && !turns)
      add_advice({memo_, *a.task.turned, fastening_about(memo_, *a.task.turned), best, a.one_obstacle,
                  without(a.task.turned->part), pose, hand_},
                 text, data);
    if (verdict_.reason.empty()) verdict_.reason = fmt::format("no tool {} '{}'", does, name(about));
    note("blocked", std::move(text), driven, std::move(data));
  }

  const FastenerMemo& memo_;
  const std::vector<tools::Tool>&all_, &left_out_;
  bool hand_;
  const StepQuestion& q_;
  std::vector<PlacedPart> there_;
  StepVerdict verdict_;
  std::vector<bool> in_hand_;  // by tool
  bool used_ = false;          // a tool, in this step
  std::vector<const fasteners::Pattern*> said_;
  int unreached_ = 0, early_ = 0, changes_ = 0;
};

}  // namespace

StepVerdict judge_step(const FastenerMemo& memo, const Bench& bench, const StepQuestion& question) {
  return Judge(memo, bench, question).verdict();
}

}  // namespace dismantle::checks
