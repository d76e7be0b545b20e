// Lists of patches on several threads. Patches are independent, so the list can be divided. Budgets and findings are
// merged as if the pieces had been settled one after the other.
#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "dismantle/executor.h"
#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {
namespace {

/// Fewest patches that justify a task; a list is divided among threads if it is long enough for several tasks.
constexpr std::size_t kLeastPiece = 32, kWorthHelp = 4 * kLeastPiece;

}  // namespace

/// A piece of a list, settled as if it came first.
struct DirectedCheck::Share {
  List list;
  std::vector<double> unclear;  // previous values, by patch of the list
  Budget budget;
  std::uint64_t patches_at_first;
  std::optional<DirectedCheck> check;
  List later;
  bool done = false, holds = false;
};

DirectedCheck::DirectedCheck(const DirectedCheck& whole, const List& list, Budget& budget)
    : a_(whole.a_),
      b_(whole.b_),
      motion_(whole.motion_),
      limits_(whole.limits_),
      budget_(budget),
      unclear_(whole.unclear_),
      walls_(whole.walls_),
      lean_(whole.lean_),
      sides_(whole.sides_) {
  patches_.reserve(list.size());
  for (const std::uint32_t id : list) patches_.push_back(whole.patches_[id]);
}

bool DirectedCheck::has_help() const {
  return budget_.context != nullptr && budget_.context->executor && budget_.context->executor->threads() > 1;
}

/// Cuts from the end, where processing begins. Patches of one triangle are adjacent and stay together.
std::vector<DirectedCheck::List> DirectedCheck::cut(const List& list) const {
  const std::size_t size = std::max(kLeastPiece, list.size() / 8 + 1);  // at most 8 pieces
  std::vector<List> pieces;
  for (std::size_t end = list.size(); end > 0;) {
    std::size_t begin = end > size ? end - size : 0;
    while (begin > 0 && patches_[list[begin - 1]].triangle == patches_[list[begin]].triangle) --begin;
    pieces.emplace_back(list.begin() + static_cast<std::ptrdiff_t>(begin),
                        list.begin() + static_cast<std::ptrdiff_t>(end));
    end = begin;
  }
  return pieces;
}

bool DirectedCheck::settle_shared(const Interval& i, const List& list, bool vertex_rule, List& later) {
  if (list.size() < kWorthHelp) return settle_in_turn(i, list, vertex_rule, later);
  std::vector<Share> shares;
  for (List& piece : cut(list)) {
    Share share{std::move(piece), {}, budget_, budget_.patches_left, std::nullopt, {}, false, false};
    share.budget.tests_done = 0;
    for (const std::uint32_t id : share.list) share.unclear.push_back((*unclear_)[patches_[id].triangle]);
    shares.push_back(std::move(share));
  }
  std::atomic<bool> failed{false};
  parallel_for(
      shares.size(), *budget_.context,
      [&](std::size_t k) {
        Share& s = shares[k];
        s.check.emplace(DirectedCheck(*this, s.list, s.budget));
        List own(s.list.size());
        for (std::size_t n = 0; n < own.size(); ++n) own[n] = static_cast<std::uint32_t>(n);
        s.holds = s.check->settle_in_turn(i, std::move(own), vertex_rule, s.later);
        s.done = true;
        if (!s.holds) failed = true;
      },
      [&] { return failed.load(); });
  for (Share& s : shares) {
    if (take_over(s, later)) {
      if (!s.holds) return false;
      continue;
    }
    // Not started, or needs more budget than the pieces before it left.
    for (std::size_t n = 0; n < s.list.size(); ++n) (*unclear_)[patches_[s.list[n]].triangle] = s.unclear[n];
    if (!settle_in_turn(i, s.list, vertex_rule, later)) return false;
  }
  return true;
}

/// False: settled in order, this piece could have ended differently.
bool DirectedCheck::take_over(Share& share, List& later) {
  if (!share.done) return false;
  const std::uint64_t tests = share.budget.tests_done, patches = share.patches_at_first - share.budget.patches_left;
  if (tests > budget_.tests_left || patches > budget_.patches_left) return false;
  if (!share.holds && share.check->finding_.answer == Answer::exhausted) return false;
  budget_.tests_left -= tests;
  budget_.tests_done += tests;
  budget_.patches_left -= patches;
  const auto given = static_cast<std::uint32_t>(share.list.size()), first = static_cast<std::uint32_t>(patches_.size());
  const auto renamed = [&](std::uint32_t id) { return id < given ? share.list[id] : first + (id - given); };
  DirectedCheck& check = *share.check;
  patches_.insert(patches_.end(), check.patches_.begin() + given, check.patches_.end());
  for (const Piece& piece : check.pieces_) pieces_.push_back({renamed(piece.patch), piece.s0, piece.s1});
  for (const std::uint32_t id : share.later) later.push_back(renamed(id));
  by_shrunken_copy_ = by_shrunken_copy_ && check.by_shrunken_copy_;
  if (!share.holds) finding_ = check.finding_;
  return true;
}

/// Tests of a list, as many as were done before a stop request; none without other threads.
std::vector<DirectedCheck::QuickTest> DirectedCheck::quick_tests(const UnrolledMesh& other, const Winding& winding,
                                                                 std::size_t from, std::size_t to,
                                                                 const List& list) const {
  if (!has_help() || list.size() < kWorthHelp) return {};
  std::vector<QuickTest> seen(list.size());
  const Placement start(motion_.at(static_cast<double>(winding.begin)));
  parallel_for((list.size() + kLeastPiece - 1) / kLeastPiece, *budget_.context,
               [&](std::size_t part) {
                 for (std::size_t k = part * kLeastPiece; k < std::min(list.size(), (part + 1) * kLeastPiece); ++k)
                   seen[k] = quick_test(other, start, from, to, list[k]);
               },
               [&] { return budget_.context->should_stop(); });
  return seen;
}

}  // namespace dismantle::geometry
