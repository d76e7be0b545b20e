#include "configuration_cells/pose_flood.h"

#include <algorithm>
#include <utility>

namespace dismantle::immobility {
namespace {

constexpr double kLeastExtent = 5e-4;    // assembly units: cells that are smaller are not divided
constexpr double kSmall = 1.0 / 16;      // of the whole box: cells that tell something by their centres
constexpr std::size_t kSeldom = 16;      // rounds: how often large ones are asked as well
constexpr double kAbout = 0.8;           // cells so much smaller than others are divided later
constexpr double kGrain = 0.05;          // assembly units: what a walk has reached is measured in grains of that size
constexpr double kMostGrains = 5e5;      // of more a proof is not to be expected
constexpr std::size_t kPause = 500;      // rounds after which the walk is sent again, twice as many each time in vain
constexpr std::size_t kLedLooks = 2000;  // poses it looks at each time

bool any_side(const PoseBox::Sides& sides) { return std::find(sides.begin(), sides.end(), true) != sides.end(); }

/// Is the assembled pose in it?
bool holds_start(const PoseCell& c) { return !c.empty && (c.lo.array() <= 0).all() && (c.hi.array() >= 0).all(); }

}  // namespace

PoseFlood::PoseFlood(const Pinned& pinned, PinWalk& walk, const Limits& limits, ForkJoin& both)
    : pinned_(pinned),
      walk_(walk),
      limits_(limits),
      both_(both),
      in_use_(pinned, walk.met()),
      scale_(pinned.scale()),
      box_(walk, scale_),
      cells_(first_cell(), {.start = true}),
      pause_(kPause) {
  cells_.set_place(0, place(cells_[0]));
}

PoseFlood::Cell PoseFlood::first_cell() const {
  Cell all;
  all.lo = box_.lo();
  all.hi = box_.hi();
  all.pins = std::make_shared<PinList>();
  all.close = in_use_.all();
  contract(all, pinned_, in_use_.list());
  return all;
}

CellPlace PoseFlood::place(const PoseCell& cell) const {
  CellPlace p;
  p.from_border = box_.from_border(cell);
  p.border = any_side(box_.touched(cell));
  p.start = holds_start(cell);
  return p;
}

double PoseFlood::extent(const PoseCell& cell) const { return cell.size().cwiseProduct(scale_).maxCoeff(); }

/// Of the cells on the way: the largest whose centre is out of bounds; the largest, when those are all small.
std::uint32_t PoseFlood::to_divide(std::uint32_t exit) const {
  std::uint32_t shut = kNone, any = kNone;
  double shut_extent = 0, any_extent = 0;
  for (std::uint32_t k = exit; k != kNone; k = cells_.from(k)) {
    const double e = extent(cells_[k]);
    if (!cells_[k].center_open && e > shut_extent) shut_extent = e, shut = k;
    if (e > any_extent) any_extent = e, any = k;
  }
  return shut != kNone && shut_extent >= kAbout * any_extent ? shut : any;
}

void PoseFlood::learn_along(std::uint32_t exit) {
  for (std::uint32_t k = exit; k != kNone; k = cells_.from(k)) {
    if (!cells_[k].center_open || cells_[k].asked) continue;
    cells_[k].asked = true;
    in_use_.learn(cells_[k], cells_[k].close);
  }
}

/// Goes from centre to centre: the cell where a pin in use is in the way, the larger of two. Nothing: the way is free,
/// as far as poses tell that are a step apart.
std::uint32_t PoseFlood::barred_at(std::uint32_t exit) const {
  for (std::uint32_t k = exit; cells_.from(k) != kNone; k = cells_.from(k)) {
    const std::uint32_t next = cells_.from(k);
    if (!in_use_.passes(cells_[k].center(), cells_[next].center()))
      return extent(cells_[k]) > extent(cells_[next]) ? k : next;
  }
  return kNone;
}

/// Sides that the parts seem to get to. It is asked in the middle of what of the cell is on them.
PoseBox::Sides PoseFlood::sides_reached(std::uint32_t exit) const {
  const PoseCell& cell = cells_[exit];
  PoseBox::Sides sides = box_.touched(cell);
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      bool& reached = sides[PoseBox::side(d, upper)];
      if (!reached) continue;
      Vector6 x = cell.center();
      x[d] = (upper ? box_.hi() : box_.lo())[d];
      reached = in_use_.within_bounds(x, cell) && in_use_.passes(cell.center(), x);
    }
  return sides;
}

/// The box becomes larger on those sides: a cell is added on each. What is known of the others stays.
void PoseFlood::grow(const PoseBox::Sides& sides) {
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      if (!sides[PoseBox::side(d, upper)]) continue;
      Cell slab{box_.grow(d, upper, walk_), in_use_.all()};
      contract(slab, pinned_, in_use_.list());
      const CellPlace at = place(slab);
      cells_.add(std::move(slab), at);
    }
  for (std::uint32_t k = 0; k < cells_.size(); ++k)
    if (!cells_.divided(k)) cells_.set_place(k, place(cells_[k]));
}

PoseFlood::End PoseFlood::run(std::size_t most, const RunContext& context) {
  for (std::size_t round = 1; round <= most; ++round) {
    if (context.should_stop()) return End::open;
    const std::uint32_t exit = cells_.next_exit();
    if (exit == kNone) return closed() ? End::closed : End::open;
    learn_along(exit);
    std::uint32_t node = to_divide(exit);
    const double large = kSmall * box_.extent();
    box_.led_to(cells_[exit], extent(cells_[exit]) < large, round);
    PoseBox::Sides sides = box_.insisted_on(round);
    if (cells_[node].center_open && (round % kSeldom == 0 || extent(cells_[node]) < large)) {
      if (const std::uint32_t barred = barred_at(exit); barred != kNone) {
        node = barred;
      } else if (sides = sides_reached(exit); any_side(sides)) {
        for (std::uint32_t k = exit; k != kNone; k = cells_.from(k)) walk_.add(cells_[k].center());
      }
    }
    if (any_side(sides) || round >= sent_at_ + pause_) {
      sent_at_ = round;
      walk_.lead(box_.beyond(cells_[exit]), kLedLooks, context);
      pause_ *= 2;
      if (hopeless()) return End::open;
      const PoseBox::Sides passed = box_.passed_by(walk_);
      for (std::size_t k = 0; k < sides.size(); ++k) sides[k] = sides[k] || passed[k];
    }
    if (any_side(sides)) {
      pause_ = kPause;
      grow(sides);
      box_.begin_again(round);
      continue;
    }
    if (extent(cells_[node]) < kLeastExtent) return End::open;
    divide(node);
  }
  return End::spent;
}

/// Have the parts come away, or so far and in so many ways that the divisions will not do?
bool PoseFlood::hopeless() const {
  if (walk_.away()) return true;
  const Vector6 most = (-box_.lo()).cwiseMax(box_.hi());
  if (most.head<3>().maxCoeff() > limits_.turn || most.tail<3>().maxCoeff() > limits_.shift) return true;
  const Vector6 grains = (walk_.hi() - walk_.lo()).cwiseProduct(scale_) / kGrain;
  return grains.cwiseMax(1.0).prod() > kMostGrains;
}

/// Bounds of what can be reached. False: the assembled pose cannot, by rounding, if anything: it is within bounds.
bool PoseFlood::closed() {
  bool start = false;
  bounds_.lo = box_.hi();
  bounds_.hi = box_.lo();
  for (std::uint32_t k = 0; k < cells_.size(); ++k) {
    if (!cells_.connected(k)) continue;
    start = start || cells_.holds_start(k);
    bounds_.lo = bounds_.lo.cwiseMin(cells_[k].lo);
    bounds_.hi = bounds_.hi.cwiseMax(cells_[k].hi);
  }
  return start;
}

/// In halves, across the longest edge.
void PoseFlood::divide(std::uint32_t node) {
  Cell below = std::move(cells_[node]);
  int d = 0;
  below.size().cwiseProduct(scale_).maxCoeff(&d);
  Cell above = below;
  below.hi[d] = above.lo[d] = below.center()[d];
  below.asked = above.asked = false;
  const PinList& in_use = in_use_.list();
  both_([&] { contract(below, pinned_, in_use); }, [&] { contract(above, pinned_, in_use); });
  const CellPlace first = place(below), second = place(above);
  cells_.divide(node, {std::move(below), first}, {std::move(above), second});
}

}  // namespace dismantle::immobility
