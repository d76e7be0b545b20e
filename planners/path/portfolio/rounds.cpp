#include "rounds.h"

#include <algorithm>
#include <utility>

#include "thin_groups.h"

namespace dismantle::portfolio {

Rounds::Rounds(Members& members, const Parameters& parameters)
    : members_(members), parameters_(parameters), turn_(static_cast<std::uint64_t>(parameters.turn)) {
  short_round_ = members.order().size() > 1 && parameters.overlap_turn > 0 &&
                 parameters.overlap_turn < parameters.turn && thinner_than_overlap(members.query());
}

/// A round with a short turn of the first member is followed by a full round of the same length.
void Rounds::begin_round() {
  if (!short_round_ || members_.primary()->ended())
    turn_ = static_cast<std::uint64_t>(std::min(parameters_.growth * static_cast<double>(turn_), 4e18));
  short_round_ = false;
  at_ = 0;
}

/// The first member has time alone before this one begins.
bool Rounds::waits(const MemberSearch& m) const {
  const MemberSearch* primary = members_.primary();
  return &m != primary && !primary->ended() && primary->spent() < static_cast<std::uint64_t>(m.member().after);
}

Decision Rounds::run(const RunContext& context, Portion& portion) {
  const auto& order = members_.order();
  while (true) {
    if (at_ == order.size()) {
      if (std::all_of(order.begin(), order.end(), [](const MemberSearch* m) { return m->ended(); })) return {};
      begin_round();
    }
    MemberSearch& m = *order[at_];
    if (!waits(m)) {
      if (!m.begun() && !m.ended() && !members_.ready(m)) m.leave_out();
      if (!m.ended()) {
        const Decision decision = take_turn(m, context, portion);
        if (!decision.is_open()) return decision;
      }
    }
    in_turn_ = false;
    ++at_;
  }
}

std::uint64_t Rounds::length_of_turn(const MemberSearch& m) const {
  const auto& order = members_.order();
  const bool alone =
      std::all_of(order.begin(), order.end(), [&](const MemberSearch* other) { return other == &m || other->ended(); });
  if (alone || m.member().whole) return kUnlimited;
  return short_round_ && &m == members_.primary() ? static_cast<std::uint64_t>(parameters_.overlap_turn) : turn_;
}

/// Returns an open decision when the turn is over, `paused` when the portion is.
Decision Rounds::take_turn(MemberSearch& m, const RunContext& context, Portion& portion) {
  if (const auto ends = members_.prepare(m, context, portion)) return *ends;
  if (!std::exchange(in_turn_, true)) turn_began_ = m.spent();
  const std::uint64_t length = length_of_turn(m);
  const std::uint64_t left = length == kUnlimited ? length : length - std::min(length, m.spent() - turn_began_);
  const Decision decision = members_.run(m, left, portion);
  if (decision.status != SearchStatus::paused) return decision;
  const bool turn_goes_on = length == kUnlimited || m.spent() - turn_began_ < length;
  return portion.over() && turn_goes_on ? decision : Decision{};
}

}  // namespace dismantle::portfolio
