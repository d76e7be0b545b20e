#include "advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool_words.h"

namespace dismantle::checks {
namespace {

/// It is driven into this part, or clamps it.
bool belongs(const Blocked& b, PartId part) {
  const auto in = [&](const std::vector<PartId>& parts) {
    return std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  const fasteners::Fastening* f = b.fastening;
  return in(b.driven.partners) || (f != nullptr && (f->screw == part || in(f->clamps) || in(f->into)));
}

/// It may turn by itself, as wheels do. What fastens, and what is fastened, stays as it is.
bool may_turn(const Blocked& b, PartId part) {
  using fasteners::Kind;
  if (belongs(b, part)) return false;
  const auto& said = b.memo.assembly().parts[part].kind;
  const Kind kind = said ? fasteners::kind_from_string(said->kind).value_or(Kind::other) : Kind::other;
  return kind == Kind::wheel || kind == Kind::gear || kind == Kind::pulley || kind == Kind::plate ||
         kind == Kind::shaft || kind == Kind::coupling || kind == Kind::other;
}

/// The smallest turn, degrees, of the one part in the way about its own axis; 0: none helps.
int turn_that_helps(const Blocked& b, const Reach& reach) {
  const auto part = static_cast<PartId>(reach.access.obstacles.front());
  const auto at = std::find_if(b.there.begin(), b.there.end(), [&](const PlacedPart& p) { return p.part == part; });
  if (at == b.there.end() || !(at->pose == b.pose || (b.pose.inverse() * at->pose).is_identity(1e-12))) return 0;
  if (!may_turn(b, part)) return 0;
  const tools::Use& use = *reach.access.use;
  const auto turned = b.memo.turned(b.driven, reach.fastener, reach.flipped, use, reach.place, part, b.hand);
  if (turned.empty()) return 0;
  BlockedBy blocked =
      b.memo.blocked(b.driven, reach.fastener, reach.flipped, use, reach.place, b.there, b.pose, b.hand);
  for (int k = 1; k <= 18; ++k)
    for (const int degrees : {10 * k, -10 * k}) {
      const int turn = degrees > 0 ? k : 36 - k;
      blocked.replace(static_cast<std::size_t>(at - b.there.begin()), turned[static_cast<std::size_t>(turn - 1)]);
      if (tools::room_for(use, reach.fastener, blocked.arcs()).reaches()) return degrees;
    }
  return 0;
}

}  // namespace

void add_advice(const Blocked& b, std::string& text, nlohmann::json& data) {
  const std::vector<std::size_t>& obstacles = b.best.access.obstacles;
  if (obstacles.empty()) return;
  std::vector<std::string> names;
  for (const std::size_t part : obstacles) names.push_back(b.memo.assembly().parts[part].name);
  if (std::none_of(obstacles.begin(), obstacles.end(),
                   [&](std::size_t part) { return belongs(b, static_cast<PartId>(part)); })) {
    text += fmt::format(" There is room before {} {} there.", listed_names(names), names.size() > 1 ? "are" : "is");
    data["room_before"] = names;
  }
  for (const Reach& reach : b.others) {
    const int degrees = turn_that_helps(b, reach);
    if (degrees == 0) continue;
    const std::string& part = b.memo.assembly().parts[reach.access.obstacles.front()].name;
    text += fmt::format(" There is room for {} if '{}' is turned by {} degrees first.",
                        use_text(*reach.tool, *reach.access.use), part, std::abs(degrees));
    data["turn_first"] = {
        {"part", part}, {"degrees", degrees}, {"tool", reach.tool->id}, {"use", reach.access.use->name}};
    return;
  }
}

}  // namespace dismantle::checks
