#include "verify/pocket/pose_flood.h"

#include <algorithm>
#include <utility>

namespace dismantle::verify {
namespace {

constexpr double kLeastExtent = 5e-4;    // assembly units: cells that are smaller are not divided
constexpr double kSmall = 1.0 / 16;      // of the whole box: cells that tell something by their centres
constexpr std::size_t kSeldom = 16;      // rounds: how often large ones are asked as well
constexpr double kAbout = 0.5;           // cells so much smaller than others are divided later
constexpr double kGrain = 0.05;          // assembly units: what a walk has reached is measured in grains of that size
constexpr double kMostGrains = 5e5;      // of more a proof is not to be expected
constexpr std::size_t kPause = 500;      // rounds after which the walk is sent again, twice as many each time in vain
constexpr std::size_t kLedLooks = 2000;  // poses it looks at each time

bool any_side(const PoseBox::Sides& sides) { return std::find(sides.begin(), sides.end(), true) != sides.end(); }

/// Is the assembled pose in it?
bool holds_start(const PoseCell& c) { return !c.empty && (c.lo.array() <= 0).all() && (c.hi.array() >= 0).all(); }

}  // namespace

PoseFlood::PoseFlood(const Pinned& pinned, PinWalk& walk, const Limits& limits, Contractor& contractor)
    : pinned_(pinned),
      walk_(walk),
      limits_(limits),
      contractor_(contractor),
      in_use_(pinned, walk.met()),
      scale_(pinned.scale()),
      box_(walk, scale_),
      pause_(kPause) {
  Node all;
  all.cell.lo = box_.lo();
  all.cell.hi = box_.hi();
  all.cell.pins = std::make_shared<PinList>();
  all.close = in_use_.all();
  contract(all.cell, pinned, in_use_.list());
  all.border = at_border(all.cell);
  cells_.push_back(std::move(all));
  reach(0, kNone);
}

bool PoseFlood::at_border(const PoseCell& cell) const { return any_side(box_.touched(cell)); }

double PoseFlood::extent(const PoseCell& cell) const { return cell.size().cwiseProduct(scale_).maxCoeff(); }

void PoseFlood::reach(std::uint32_t node, std::uint32_t from) {
  Node& n = cells_[node];
  n.reached = true;
  n.expanded = false;
  n.from = from;
  ++n.stamp;
  n.on.clear();
  if (from != kNone) cells_[from].on.push_back(node);
  queue_.push({box_.from_border(n.cell), node, n.stamp});
}

/// Reaches a cell again from a neighbour, if one is.
void PoseFlood::adopt(std::uint32_t node) {
  const auto& near = cells_[node].near;
  const auto by =
      std::find_if(near.begin(), near.end(), [&](std::uint32_t k) { return cells_[k].reached && cells_[k].expanded; });
  if (by != near.end()) reach(node, *by);
}

/// Goes on from cell to cell, the closest to the border first, until one is there.
std::uint32_t PoseFlood::next_exit() {
  while (!queue_.empty()) {
    const Entry e = queue_.top();
    Node& n = cells_[e.node];
    if (n.divided || !n.reached || n.stamp != e.stamp) {
      queue_.pop();
      continue;
    }
    if (n.border) return e.node;
    queue_.pop();
    n.expanded = true;
    for (const std::uint32_t k : n.near)
      if (!cells_[k].reached) reach(k, e.node);
  }
  return kNone;
}

/// Of the cells on the way: the largest whose centre is out of bounds; the largest, when those are all small.
std::uint32_t PoseFlood::to_divide(std::uint32_t exit) const {
  std::uint32_t shut = kNone, any = kNone;
  double shut_extent = 0, any_extent = 0;
  for (std::uint32_t k = exit; k != kNone; k = cells_[k].from) {
    const double e = extent(cells_[k].cell);
    if (!cells_[k].cell.center_open && e > shut_extent) shut_extent = e, shut = k;
    if (e > any_extent) any_extent = e, any = k;
  }
  return shut != kNone && shut_extent >= kAbout * any_extent ? shut : any;
}

void PoseFlood::learn_along(std::uint32_t exit) {
  for (std::uint32_t k = exit; k != kNone; k = cells_[k].from) {
    if (!cells_[k].cell.center_open || cells_[k].asked) continue;
    cells_[k].asked = true;
    in_use_.learn(cells_[k].cell, cells_[k].close);
  }
}

/// Goes from centre to centre: the cell where a pin in use is in the way, the larger of two. Nothing: the way is free,
/// as far as poses tell that are a step apart.
std::uint32_t PoseFlood::barred_at(std::uint32_t exit) const {
  for (std::uint32_t k = exit; cells_[k].from != kNone; k = cells_[k].from) {
    const std::uint32_t next = cells_[k].from;
    if (!in_use_.passes(cells_[k].cell.center(), cells_[next].cell.center()))
      return extent(cells_[k].cell) > extent(cells_[next].cell) ? k : next;
  }
  return kNone;
}

/// Sides that the parts seem to get to. It is asked in the middle of what of the cell is on them.
PoseBox::Sides PoseFlood::sides_reached(std::uint32_t exit) const {
  const PoseCell& cell = cells_[exit].cell;
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
      const auto node = static_cast<std::uint32_t>(cells_.size());
      cells_.emplace_back();
      cells_[node].close = in_use_.all();
      cells_[node].cell = box_.grow(d, upper, walk_);
      contract(cells_[node].cell, pinned_, in_use_.list());
      for (std::uint32_t k = 0; k < node; ++k)
        if (!cells_[k].divided) befriend(k, node);
      if (!cells_[node].cell.empty) adopt(node);
    }
  for (Node& n : cells_) n.border = !n.divided && at_border(n.cell);
}

PoseFlood::End PoseFlood::run(std::size_t most, const RunContext& context) {
  for (std::size_t round = 1; round <= most; ++round) {
    if (context.should_stop()) return End::open;
    const std::uint32_t exit = next_exit();
    if (exit == kNone) return closed() ? End::closed : End::open;
    learn_along(exit);
    std::uint32_t node = to_divide(exit);
    const double large = kSmall * box_.extent();
    box_.led_to(cells_[exit].cell, extent(cells_[exit].cell) < large, round);
    PoseBox::Sides sides = box_.insisted_on(round);
    if (cells_[node].cell.center_open && (round % kSeldom == 0 || extent(cells_[node].cell) < large)) {
      if (const std::uint32_t barred = barred_at(exit); barred != kNone) {
        node = barred;
      } else if (sides = sides_reached(exit); any_side(sides)) {
        for (std::uint32_t k = exit; k != kNone; k = cells_[k].from) walk_.add(cells_[k].cell.center());
      }
    }
    if (any_side(sides) || round >= sent_at_ + pause_) {
      sent_at_ = round;
      walk_.lead(box_.beyond(cells_[exit].cell), kLedLooks, context);
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
    if (extent(cells_[node].cell) < kLeastExtent) return End::open;
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
  if (std::none_of(cells_.begin(), cells_.end(),
                   [&](const Node& n) { return !n.divided && n.reached && holds_start(n.cell); }))
    return false;
  bounds_.lo = box_.hi();
  bounds_.hi = box_.lo();
  for (const Node& n : cells_)
    if (!n.divided && n.reached) {
      bounds_.lo = bounds_.lo.cwiseMin(n.cell.lo);
      bounds_.hi = bounds_.hi.cwiseMax(n.cell.hi);
    }
  return true;
}

void PoseFlood::divide(std::uint32_t node) {
  const std::uint32_t from = cells_[node].from;
  std::vector<std::uint32_t> lost, stack = cells_[node].on;
  while (!stack.empty()) {
    const std::uint32_t k = stack.back();
    stack.pop_back();
    cells_[k].reached = false;
    lost.push_back(k);
    stack.insert(stack.end(), cells_[k].on.begin(), cells_[k].on.end());
    cells_[k].on.clear();
  }
  if (from != kNone) std::erase(cells_[from].on, node);
  cells_[node].reached = false;
  cells_[node].on.clear();
  const std::uint32_t first = split(node);
  if (from == kNone) reach(holds_start(cells_[first].cell) ? first : first + 1, kNone);
  for (const std::uint32_t k : {first, first + 1})
    if (!cells_[k].cell.empty && !cells_[k].reached) adopt(k);
  for (const std::uint32_t k : lost)
    if (!cells_[k].reached) adopt(k);
}

/// In halves, across the longest edge. Returns the first of the two.
std::uint32_t PoseFlood::split(std::uint32_t node) {
  int d = 0;
  cells_[node].cell.size().cwiseProduct(scale_).maxCoeff(&d);
  const double middle = cells_[node].cell.center()[d];
  const auto first = static_cast<std::uint32_t>(cells_.size());
  for (const bool upper : {false, true}) {
    Node half;
    half.cell = cells_[node].cell;
    half.close = cells_[node].close;
    (upper ? half.cell.lo : half.cell.hi)[d] = middle;
    cells_.push_back(std::move(half));
  }
  contractor_(cells_[first].cell, cells_[first + 1].cell, in_use_.list());
  for (const std::uint32_t k : {first, first + 1}) cells_[k].border = at_border(cells_[k].cell);
  cells_[node].divided = true;
  cells_[node].cell.pins.reset();
  cells_[node].close.pins.reset();
  join(node, first);
  return first;
}

void PoseFlood::befriend(std::uint32_t x, std::uint32_t y) {
  if (cells_[x].cell.empty || cells_[y].cell.empty || !cells_[x].cell.touches(cells_[y].cell)) return;
  cells_[x].near.push_back(y);
  cells_[y].near.push_back(x);
}

/// The halves take the place of the whole among its neighbours.
void PoseFlood::join(std::uint32_t node, std::uint32_t first) {
  for (const std::uint32_t k : cells_[node].near) {
    auto& near = cells_[k].near;
    near.erase(std::find(near.begin(), near.end(), node));
    befriend(first, k);
    befriend(first + 1, k);
  }
  befriend(first, first + 1);
  std::vector<std::uint32_t>().swap(cells_[node].near);
}

}  // namespace dismantle::verify
