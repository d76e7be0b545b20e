#include "verify/pocket/pose_flood.h"

#include <algorithm>
#include <utility>

namespace dismantle::verify {
namespace {

constexpr double kLeastExtent = 5e-4;  // assembly units: cells that are smaller are not divided
constexpr double kOnBorder = 1e-12;
constexpr double kSmall = 1.0 / 16;  // of the whole box: cells that tell something by their centres
constexpr std::size_t kSeldom = 16;  // rounds: how often large ones are asked as well
constexpr double kStep = 0.004;      // assembly units: on a way that is looked at
constexpr double kGrow = 0.3;        // of the box, on a side that is too close

/// Is the assembled pose in it?
bool holds_start(const PoseCell& c) { return !c.empty && (c.lo.array() <= 0).all() && (c.hi.array() >= 0).all(); }

}  // namespace

PoseFlood::PoseFlood(const Pinned& pinned, PinList in_use, const Vector6& lo, const Vector6& hi, Contractor& contractor)
    : pinned_(pinned), contractor_(contractor), in_use_(std::move(in_use)), lo_(lo), hi_(hi) {
  used_.assign(pinned.pins().size(), false);
  for (const std::uint32_t p : in_use_) used_[p] = true;
  scale_ << Eigen::Vector3d::Constant(0.7 * pinned.radius()), Eigen::Vector3d::Ones();
  Node all;
  all.cell.lo = lo;
  all.cell.hi = hi;
  all.cell.pins = std::make_shared<PinList>();
  contract(all.cell, pinned, in_use_);
  all.border = at_border(all.cell);
  cells_.push_back(std::move(all));
  reach(0, kNone);
}

bool PoseFlood::at_border(const PoseCell& cell) const {
  return !cell.empty && (((cell.lo - lo_).array() < kOnBorder).any() || ((hi_ - cell.hi).array() < kOnBorder).any());
}

double PoseFlood::from_border(const PoseCell& cell) const {
  const Vector6 size = hi_ - lo_;
  return std::min((cell.lo - lo_).cwiseQuotient(size).minCoeff(), (hi_ - cell.hi).cwiseQuotient(size).minCoeff());
}

double PoseFlood::extent(const PoseCell& cell) const { return cell.size().cwiseProduct(scale_).maxCoeff(); }

void PoseFlood::reach(std::uint32_t node, std::uint32_t from) {
  Node& n = cells_[node];
  n.reached = true;
  n.expanded = false;
  n.from = from;
  ++n.stamp;
  n.on.clear();
  if (from != kNone) cells_[from].on.push_back(node);
  queue_.push({from_border(n.cell), node, n.stamp});
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
  return shut != kNone && shut_extent >= 0.25 * any_extent ? shut : any;
}

/// Takes the pin that is deepest inside at the centre of the cell, if there is one.
void PoseFlood::learn(std::uint32_t node) {
  const Stance stance(pinned_, cells_[node].cell.center());
  std::uint32_t best = kNone;
  double deepest = 0;
  for (std::uint32_t p = 0; p < pinned_.pins().size(); ++p) {
    const Pin& pin = pinned_.pins()[p];
    if (used_[p] || pin.room > stance.moved() || !stance.inside(pin)) continue;
    const double depth = pinned_.faced(pin).solid->bvh.closest(stance.seen(pin)).distance;
    if (depth > deepest) deepest = depth, best = p;
  }
  if (best == kNone) return;
  used_[best] = true;
  in_use_.push_back(best);
}

void PoseFlood::learn_along(std::uint32_t exit) {
  for (std::uint32_t k = exit; k != kNone; k = cells_[k].from) {
    if (!cells_[k].cell.center_open || cells_[k].asked) continue;
    cells_[k].asked = true;
    learn(k);
  }
}

/// Is no pin inside at all? Those that may be inside somewhere in the cell around are asked first.
bool PoseFlood::within_bounds(const Vector6& x, const PoseCell& around) const {
  const Stance stance(pinned_, x);
  const auto& pins = pinned_.pins();
  if (std::any_of(around.pins->begin(), around.pins->end(), [&](std::uint32_t p) { return stance.inside(pins[p]); }))
    return false;
  return std::none_of(pins.begin(), pins.end(),
                      [&](const Pin& p) { return p.room <= stance.moved() && stance.inside(p); });
}

/// Goes from centre to centre: the cell where a pin in use is in the way, the larger of two. Nothing: the way is free,
/// as far as poses tell that are a step apart.
std::uint32_t PoseFlood::barred_at(std::uint32_t exit) const {
  const auto barred = [&](const Vector6& x) {
    const Stance stance(pinned_, x);
    return std::any_of(in_use_.begin(), in_use_.end(), [&](std::uint32_t p) {
      const Pin& pin = pinned_.pins()[p];
      return pin.room <= stance.moved() && stance.inside(pin);
    });
  };
  for (std::uint32_t k = exit; cells_[k].from != kNone; k = cells_[k].from) {
    const std::uint32_t next = cells_[k].from;
    const Vector6 x = cells_[k].cell.center(), by = cells_[next].cell.center() - x;
    const int steps = 1 + static_cast<int>(by.cwiseProduct(scale_).norm() / kStep);
    for (int i = 1; i < steps; ++i)
      if (barred(x + static_cast<double>(i) / steps * by))
        return extent(cells_[k].cell) > extent(cells_[next].cell) ? k : next;
  }
  return kNone;
}

/// When each side was last reached.
void PoseFlood::note_sides(std::uint32_t exit, std::size_t round) {
  const PoseCell& cell = cells_[exit].cell;
  for (std::size_t d = 0; d < 6; ++d) {
    const auto n = static_cast<Eigen::Index>(d);
    if (cell.lo[n] - lo_[n] < kOnBorder) round_at_[2 * d] = round;
    if (hi_[n] - cell.hi[n] < kOnBorder) round_at_[2 * d + 1] = round;
  }
}

/// Do the parts get to the border? It is asked in the middle of what of the cell is on it.
bool PoseFlood::wants_more(std::uint32_t exit) {
  const PoseCell& cell = cells_[exit].cell;
  const Vector6 width = hi_ - lo_;
  bounds_.lo = lo_;
  bounds_.hi = hi_;
  bool grows = false;
  const auto look = [&](int d, double at, double& bound, double by) {
    Vector6 x = cell.center();
    x[d] = at;
    if (!within_bounds(x, cell)) return;
    bound += by;
    grows = true;
  };
  for (int d = 0; d < 6; ++d) {
    if (cell.lo[d] - lo_[d] < kOnBorder) look(d, lo_[d], bounds_.lo[d], -kGrow * width[d]);
    if (hi_[d] - cell.hi[d] < kOnBorder) look(d, hi_[d], bounds_.hi[d], kGrow * width[d]);
  }
  return grows;
}

PoseFlood::End PoseFlood::run(std::size_t most, const RunContext& context) {
  const double whole = extent(cells_.front().cell);
  for (std::size_t round = 0; round < most; ++round) {
    if (context.should_stop()) return End::open;
    const std::uint32_t exit = next_exit();
    if (exit == kNone) {
      // Rounding, if anything: the assembled pose is within bounds, so its cell cannot be empty.
      if (std::none_of(cells_.begin(), cells_.end(),
                       [&](const Node& n) { return !n.divided && n.reached && holds_start(n.cell); }))
        return End::open;
      bounds_.lo = hi_;
      bounds_.hi = lo_;
      for (const Node& n : cells_)
        if (!n.divided && n.reached) {
          bounds_.lo = bounds_.lo.cwiseMin(n.cell.lo);
          bounds_.hi = bounds_.hi.cwiseMax(n.cell.hi);
        }
      return End::closed;
    }
    note_sides(exit, round);
    learn_along(exit);
    std::uint32_t node = to_divide(exit);
    if (cells_[node].cell.center_open && (round % kSeldom == 0 || extent(cells_[node].cell) < kSmall * whole)) {
      if (const std::uint32_t barred = barred_at(exit); barred != kNone)
        node = barred;
      else if (wants_more(exit))
        return End::at_edge;
    }
    if (extent(cells_[node].cell) < kLeastExtent) return End::open;
    divide(node);
  }
  // Where the last ways led to the border may be too close: what is open may well go round something further out.
  bounds_.lo = lo_;
  bounds_.hi = hi_;
  for (std::size_t d = 0; d < 6; ++d) {
    const auto n = static_cast<Eigen::Index>(d);
    const double by = kGrow * (hi_[n] - lo_[n]);
    if (round_at_[2 * d] + most / 8 > most) bounds_.lo[n] -= by;
    if (round_at_[2 * d + 1] + most / 8 > most) bounds_.hi[n] += by;
  }
  return End::spent;
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
    (upper ? half.cell.lo : half.cell.hi)[d] = middle;
    cells_.push_back(std::move(half));
  }
  contractor_(cells_[first].cell, cells_[first + 1].cell, in_use_);
  for (const std::uint32_t k : {first, first + 1}) cells_[k].border = at_border(cells_[k].cell);
  cells_[node].divided = true;
  cells_[node].cell.pins.reset();
  join(node, first);
  return first;
}

/// The halves take the place of the whole among its neighbours.
void PoseFlood::join(std::uint32_t node, std::uint32_t first) {
  const auto befriend = [&](std::uint32_t x, std::uint32_t y) {
    if (cells_[x].cell.empty || cells_[y].cell.empty || !cells_[x].cell.touches(cells_[y].cell)) return;
    cells_[x].near.push_back(y);
    cells_[y].near.push_back(x);
  };
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
