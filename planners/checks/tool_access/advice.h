/// What helps where no tool reaches.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fastener_memo.h"
#include "reach.h"

namespace dismantle::checks {

/// A fastener that no tool reaches, and the best use of one.
struct Blocked {
  const FastenerMemo& memo;
  const Driven& driven;
  const fasteners::Fastening* fastening;  ///< of its screw; null: not known
  const Reach& best;                      ///< with the fewest parts in the way
  const std::vector<Reach>& others;       ///< with one part in the way
  std::vector<PlacedPart> there;          ///< without the fastener
  Pose pose;                              ///< of the fastener
  bool hand;
};

/// Says whether there is room before the parts in the way are there ("room_before"), or if one of them is turned about
/// its own axis ("turn_first": {"part", "degrees", "tool", "use"}).
void add_advice(const Blocked& blocked, std::string& text, nlohmann::json& data);

}  // namespace dismantle::checks
