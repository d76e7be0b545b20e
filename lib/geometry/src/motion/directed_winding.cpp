// Many turns of a screw motion at once, in unrolled coordinates.
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "dismantle/geometry/directed_check.h"

namespace dismantle::geometry {

static constexpr std::size_t kFew = 64;  // patches

/// Checks all turns of a winding together by the vertex rule, and the patches that remain like any other motion. Wide
/// cells come first, each time five times as wide as the next: most of a part is not near, and threads have play.
bool DirectedCheck::wind(const Winding& winding) {
  List list;
  if (!a_.bvh.nodes().empty())
    collect(interval(static_cast<double>(winding.begin), static_cast<double>(winding.end)), 0, list);
  const double fine = 0.1 * limits_.cells_from(), lead = 2 * std::numbers::pi * std::abs(winding.pitch);
  double widest = fine;
  while (5 * widest < lead / 16) widest *= 5;
  return wind_in_cells(winding, widest, {winding.begin, winding.end, std::move(list)});
}

/// What wide cells do not certify is looked at in narrower ones, and at last like any other motion.
bool DirectedCheck::wind_in_cells(const Winding& winding, double cell, Stretch stretch) {
  const double fine = 0.1 * limits_.cells_from();
  const bool finest = !(cell > 2 * fine);
  const UnrolledMesh other = unrolled(winding, stretch, finest ? fine : cell);
  if (finest) return wind(other, winding, stretch.from, stretch.to, std::move(stretch.list));
  const std::size_t before = stretch.list.size();
  if (!clear_unrolled(other, winding, stretch.from, stretch.to, stretch.list)) return false;
  std::vector<Stretch> rest;
  if (!halve(other, winding, std::move(stretch), before, rest)) return false;
  for (Stretch& s : rest) {
    // Cells of any width take more work than the sweeps of a few patches that touch all the time.
    const bool few = s.list.size() < kFew && s.list.size() == before;
    if (few ? !wind(other, winding, s.from, s.to, std::move(s.list)) : !wind_in_cells(winding, cell / 5, std::move(s)))
      return false;
  }
  return true;
}

/// Halving pays if few patches are left or more than half were certified, and only above 1 rad.
static bool worth_halving(const Winding& winding, std::size_t from, std::size_t to, std::size_t before,
                          std::size_t left) {
  return (left < kFew || 2 * left < before) && to - from >= 2 && winding.turned_at(to) - winding.turned_at(from) >= 1;
}

/// Collects the stretches in which halves of the time certify few more: less than a quarter. `before`: patches, before
/// these were left. False: the check failed.
bool DirectedCheck::halve(const UnrolledMesh& other, const Winding& winding, Stretch whole, std::size_t before,
                          std::vector<Stretch>& rest) {
  if (whole.list.empty()) return true;
  const std::size_t all = whole.list.size(), middle = whole.from + (whole.to - whole.from) / 2;
  if (worth_halving(winding, whole.from, whole.to, before, all)) {
    Stretch early{whole.from, middle, whole.list}, late{middle, whole.to, whole.list};
    if (!clear_unrolled(other, winding, early.from, early.to, early.list) ||
        !clear_unrolled(other, winding, late.from, late.to, late.list))
      return false;
    if (2 * (early.list.size() + late.list.size()) < 3 * all)
      return halve(other, winding, std::move(early), all, rest) && halve(other, winding, std::move(late), all, rest);
  }
  rest.push_back(std::move(whole));
  return true;
}

/// B in unrolled coordinates, where the listed patches come near it.
UnrolledMesh DirectedCheck::unrolled(const Winding& winding, const Stretch& stretch, double cell) const {
  const Placement start(motion_.at(static_cast<double>(winding.begin)));
  std::vector<Corners> asked;
  asked.reserve(stretch.list.size());
  for (const std::uint32_t id : stretch.list)
    asked.push_back(placed(start, moved_by_vertices(patches_[id], displacement(patches_[id]))));
  return {b_.bvh, winding, asked, stretch.from, stretch.to, cell};
}

DirectedCheck::QuickTest DirectedCheck::quick_test(const UnrolledMesh& other, const Placement& start, std::size_t from,
                                                   std::size_t to, std::uint32_t patch) const {
  const Patch& p = patches_[patch];
  QuickTest seen{true, false, 0};
  seen.clear = other.clear_of(placed(start, moved_by_vertices(p, displacement(p))), from, to, seen.cells);
  return seen;
}

/// Removes certified patches from the list. False: the check failed.
bool DirectedCheck::clear_unrolled(const UnrolledMesh& other, const Winding& winding, std::size_t from, std::size_t to,
                                   List& list) {
  const Placement start(motion_.at(static_cast<double>(winding.begin)));
  const std::vector<QuickTest> known = quick_tests(other, winding, from, to, list);
  List rest;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Patch& patch = patches_[list[k]];
    const QuickTest seen = k < known.size() && known[k].done ? known[k] : quick_test(other, start, from, to, list[k]);
    if (!budget_.spend_tests(1 + seen.cells / 256))  // 256 cells cost as much as one sweep test
      return fail(Answer::exhausted, patch.center(), 0, patch.triangle, static_cast<double>(from));
    if (seen.clear)
      pieces_.push_back({list[k], static_cast<double>(from), static_cast<double>(to)});
    else
      rest.push_back(list[k]);
  }
  list = std::move(rest);
  return true;
}

bool DirectedCheck::wind(const UnrolledMesh& other, const Winding& winding, std::size_t from, std::size_t to,
                         List list) {
  const std::size_t before = list.size();
  if (!clear_unrolled(other, winding, from, to, list)) return false;
  if (list.empty()) return true;
  if (!worth_halving(winding, from, to, before, list.size()))
    return process(interval(static_cast<double>(from), static_cast<double>(to)), std::move(list), true);
  const std::size_t middle = from + (to - from) / 2;
  return wind(other, winding, from, middle, list) && wind(other, winding, middle, to, std::move(list));
}

}  // namespace dismantle::geometry
