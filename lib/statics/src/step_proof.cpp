#include "dismantle/statics/step_proof.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <optional>

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kOverturn = -0.7;  // cosine: over two sides

std::optional<double> number_in(const Numbers& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  if (found == numbers.end() || found->second.size() != 1) return std::nullopt;
  return found->second.front();
}

}  // namespace

std::vector<PlacedPart> joined(std::span<const PlacedPart> a, std::span<const PlacedPart> b) {
  const auto by_part = [](const PlacedPart& x, const PlacedPart& y) { return x.part < y.part; };
  std::vector<PlacedPart> all;
  all.reserve(a.size() + b.size());
  if (std::is_sorted(a.begin(), a.end(), by_part) && std::is_sorted(b.begin(), b.end(), by_part)) {  // as a rule
    std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all), by_part);
    return all;
  }
  all.assign(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  std::sort(all.begin(), all.end(), by_part);
  return all;
}

std::vector<PlacedPart> where_assembled(std::vector<PlacedPart> parts) {
  constexpr double kSamePlace = 1e-9;  // assembly units
  if (std::ranges::all_of(parts, [&](const PlacedPart& p) {
        return p.pose.q.vec().isZero(0) && (p.pose.t - parts.front().pose.t).norm() <= kSamePlace;
      }))
    for (PlacedPart& p : parts) p.pose.t.setZero();
  return parts;
}

Vec3 up_while_turned(const Vec3& from, const Vec3& to) {
  const Vec3 sum = from + to;
  return from.dot(to) < kOverturn ? Vec3(from.unitOrthogonal()) : Vec3(sum.normalized());
}

StepHolds check_step_proof(const BuiltPiles& piles, const StepQuestion& question, const Numbers& numbers) {
  StepHolds result;
  const auto wrong = [&](const std::string& state, const std::string& text) {
    result.wrong = "'" + state + "': " + text;
    return result;
  };
  for (const std::string state : {"after", "during", "turning"}) {
    if (!numbers.contains(state + ".held")) continue;
    const std::optional<double> gaps = number_in(numbers, state + ".gaps");
    if (gaps != 0 && gaps != 1) return wrong(state, "it does not say which gaps count as touching");
    const bool after = state == "after", turning = state == "turning";
    if (turning && question.previous == nullptr) return wrong(state, "nothing is turned before the first step");
    const std::optional<double> push = state == "during" ? number_in(numbers, "during.push") : 0;
    if (push != 0 && push != kHandPush && push != -kHandPush) return wrong(state, "it does not say how it is pushed");
    std::vector<PlacedPart> parts = after ? joined(question.present, question.moving) : joined(question.present, {});
    if (*push == 0) parts = where_assembled(std::move(parts));
    const Gaps which = *gaps == 0 ? Gaps::tight : Gaps::play;
    const Vec3 up = turning ? up_while_turned(question.previous->up, question.up) : question.up;
    BuiltPile built = piles.pile(parts, up, which, !turning);
    if (*push != 0)
      piles.press(built, parts, question.moving, (*push > 0 ? 1.0 : -1.0) * question.direction, kHandPush, which);
    const std::optional<HoldProof> proof = hold_proof_in(numbers, state, built.pile);
    if (!proof) return wrong(state, "its numbers are not those of such a pile");
    if (std::string text = check_hold_proof(built.pile, *proof); !text.empty()) return wrong(state, text);
    auto& held = result.held[state];
    for (const std::uint32_t body : proof->held) {
      held.emplace_back();
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (built.body_of[i] == body) held.back().push_back(parts[i].part);
    }
  }
  if (result.held.empty()) result.wrong = "it proves nothing";
  return result;
}

}  // namespace dismantle::statics
