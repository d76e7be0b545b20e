#include "configuration_cells/cell_decomposition.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace dismantle::immobility {
namespace {

/// Rotations are stored as rotation vectors; boxes of larger ones are not divided. Radians.
constexpr double kMostTurn = 0.5 * std::numbers::pi;

bool any_side(const SearchBox::Sides& sides) { return std::find(sides.begin(), sides.end(), true) != sides.end(); }

/// True if the assembled pose is in the cell.
bool holds_start(const PoseCell& c) { return !c.empty && (c.lo.array() <= 0).all() && (c.hi.array() >= 0).all(); }

}  // namespace

CellDecomposition::CellDecomposition(const SampledPair& pair, FreeSpaceSampler& sampler,
                                     const ConfigurationCellsParameters& params, const Scale& scale,
                                     ForkJoin& fork_join)
    : pair_(pair),
      sampler_(sampler),
      params_(params),
      limits_(scale),
      fork_join_(fork_join),
      active_(pair, sampler.blocking(), scale.tolerance),
      scale_(pair.scale()),
      box_(sampler, scale_, static_cast<std::size_t>(params.patience), scale.tolerance),
      cells_(first_cell(), {.has_start = true}),
      pause_(static_cast<std::size_t>(params.patience)) {
  cells_.set_status(0, status(cells_[0]));
}

CellDecomposition::Cell CellDecomposition::first_cell() {
  Cell all;
  all.lo = box_.lo();
  all.hi = box_.hi();
  all.samples = std::make_shared<SampleList>();
  all.near = active_.all();
  Contraction made;
  contract(all, pair_, active_.list(), made);
  record_.add(std::move(made));
  return all;
}

CellStatus CellDecomposition::status(const PoseCell& cell) const {
  CellStatus s;
  s.border_distance = box_.border_distance(cell);
  s.on_border = any_side(box_.sides_touched(cell));
  s.has_start = holds_start(cell);
  return s;
}

double CellDecomposition::extent(const PoseCell& cell) const { return cell.size().cwiseProduct(scale_).maxCoeff(); }

/// Selects the largest cell on the path whose centre is blocked, since dividing it most likely cuts the path. Selects
/// the largest cell of all if the blocked ones are clearly smaller.
std::uint32_t CellDecomposition::to_divide(std::uint32_t exit) const {
  std::uint32_t blocked = kNoIndex, any = kNoIndex;
  double blocked_extent = 0, any_extent = 0;
  for (std::uint32_t k = exit; k != kNoIndex; k = cells_.parent(k)) {
    const double e = extent(cells_[k]);
    if (!cells_[k].center_free && e > blocked_extent) blocked_extent = e, blocked = k;
    if (e > any_extent) any_extent = e, any = k;
  }
  return blocked != kNoIndex && blocked_extent >= 0.8 * any_extent ? blocked : any;
}

void CellDecomposition::activate_along(std::uint32_t exit) {
  for (std::uint32_t k = exit; k != kNoIndex; k = cells_.parent(k)) {
    if (!cells_[k].center_free || cells_[k].tested) continue;
    cells_[k].tested = true;
    active_.activate_deepest(cells_[k], cells_[k].near);
  }
}

/// Checks the segments between the centres of the cells on the path. Returns the larger of the two cells between which
/// an active sample blocks; kNoIndex if the path is free as far as the checks tell.
std::uint32_t CellDecomposition::blocked_at(std::uint32_t exit) const {
  for (std::uint32_t k = exit; cells_.parent(k) != kNoIndex; k = cells_.parent(k)) {
    const std::uint32_t next = cells_.parent(k);
    if (!active_.is_free(cells_[k].center(), cells_[next].center()))
      return extent(cells_[k]) > extent(cells_[next]) ? k : next;
  }
  return kNoIndex;
}

/// Sides that the parts seem to reach: the middle of the cell's face on that side is free.
SearchBox::Sides CellDecomposition::sides_reached(std::uint32_t exit) const {
  const PoseCell& cell = cells_[exit];
  SearchBox::Sides sides = box_.sides_touched(cell);
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      bool& reached = sides[SearchBox::side(d, upper)];
      if (!reached) continue;
      Vector6 x = cell.center();
      x[d] = (upper ? box_.hi() : box_.lo())[d];
      reached = active_.is_free(x, cell) && active_.is_free(cell.center(), x);
    }
  return sides;
}

/// Enlarges the box on those sides by a cell each. The existing cells stay.
void CellDecomposition::grow(const SearchBox::Sides& sides) {
  for (int d = 0; d < 6; ++d)
    for (const bool upper : {false, true}) {
      if (!sides[SearchBox::side(d, upper)]) continue;
      const double border = (upper ? box_.hi() : box_.lo())[d];
      Cell slab{box_.grow(d, upper, sampler_), active_.all()};
      Contraction made;
      contract(slab, pair_, active_.list(), made);
      record_.grow(d, upper, border, std::move(made));
      const CellStatus at = status(slab);
      cells_.add(std::move(slab), at);
    }
  for (std::uint32_t k = 0; k < cells_.size(); ++k)
    if (!cells_.divided(k)) cells_.set_status(k, status(cells_[k]));
}

CellDecomposition::End CellDecomposition::run(const RunContext& context) {
  const auto most = static_cast<std::size_t>(params_.max_divisions);
  // Each extension of the sampler gets a third of its first state checks.
  const auto checks = static_cast<std::size_t>(params_.walk_checks) / 3;
  if (turns_freely(checks, context)) return End::open;
  for (std::size_t round = 1; round <= most; ++round) {
    if (context.should_stop()) return End::open;
    const std::uint32_t exit = cells_.next_exit();
    if (exit == kNoIndex) return closed() ? End::closed : End::open;
    activate_along(exit);
    std::uint32_t node = to_divide(exit);
    // The centre represents a cell only if the cell is small.
    const double small = box_.extent() / 16;
    box_.record_exit(cells_[exit], extent(cells_[exit]) < small, round);
    SearchBox::Sides sides = box_.persistent_sides(round);
    // On a path through large cells the check is seldom worth its time, so it runs only in every 16th round.
    if (cells_[node].center_free && (round % 16 == 0 || extent(cells_[node]) < small)) {
      if (const std::uint32_t blocked = blocked_at(exit); blocked != kNoIndex) {
        node = blocked;
      } else if (sides = sides_reached(exit); any_side(sides)) {
        for (std::uint32_t k = exit; k != kNoIndex; k = cells_.parent(k)) sampler_.add(cells_[k].center());
      }
    }
    if (any_side(sides) || round >= sent_at_ + pause_) {
      sent_at_ = round;
      sampler_.extend_towards(box_.pose_beyond(cells_[exit]), checks, context);
      pause_ *= 2;
      if (beyond_limits()) return End::open;
      const SearchBox::Sides exceeded = box_.sides_exceeded(sampler_);
      for (std::size_t k = 0; k < sides.size(); ++k) sides[k] = sides[k] || exceeded[k];
    }
    if (any_side(sides)) {
      pause_ = static_cast<std::size_t>(params_.patience);
      grow(sides);
      box_.restart(round);
      continue;
    }
    if (extent(cells_[node]) < params_.smallest_cell * limits_.tolerance) return End::open;
    divide(node);
  }
  return End::spent;
}

/// A part that turns about an axis without end, as a ring does in its groove, is found by a few state checks; growing
/// the box until it is too large takes seconds.
bool CellDecomposition::turns_freely(std::size_t checks, const RunContext& context) {
  constexpr double kStep = kMostTurn / 8;
  const auto pose_of = [](const Vector6& x) { return Pose{x.tail<3>(), rotation_from_vector(x.head<3>())}; };
  const auto furthest = [&]() -> const Vector6& { return sampler_.furthest_turn(); };
  const double first = furthest().head<3>().norm();
  if (first < kStep) return false;
  const Pose step = screw_interpolate(Pose{}, pose_of(furthest()), kStep / first);  // further about the same axis
  for (double before = 0; furthest().head<3>().norm() > before + 0.5 * kStep;) {
    before = furthest().head<3>().norm();
    if (furthest().head<3>().cwiseAbs().maxCoeff() > kMostTurn) return true;
    const Pose next = step * pose_of(furthest());
    Vector6 to;
    to << rotation_vector(next.q), next.t;
    sampler_.extend_towards(to, checks / 4, context);
  }
  return false;
}

/// True if the parts are separated, or the volume of their free poses is too large for the divisions.
bool CellDecomposition::beyond_limits() const {
  if (sampler_.separated()) return true;
  const Vector6 most = (-box_.lo()).cwiseMax(box_.hi());
  if (most.head<3>().maxCoeff() > kMostTurn || most.tail<3>().maxCoeff() > limits_.max_shift) return true;
  // The box of the sampled poses, counted in cells of five tolerances. Only its border needs finer cells, so a few
  // times as many as there are divisions may still do.
  const Vector6 cells = (sampler_.hi() - sampler_.lo()).cwiseProduct(scale_) / (5 * limits_.tolerance);
  return cells.cwiseMax(1.0).prod() > 5.0 * static_cast<double>(params_.max_divisions);
}

/// Sets the bounds of the component of the start. False: the start is in no cell, which only rounding can cause, since
/// the assembled pose is free.
bool CellDecomposition::closed() {
  bool start = false;
  bounds_.lo = box_.hi();
  bounds_.hi = box_.lo();
  for (std::uint32_t k = 0; k < cells_.size(); ++k) {
    if (!cells_.reachable(k)) continue;
    start = start || cells_.has_start(k);
    bounds_.lo = bounds_.lo.cwiseMin(cells_[k].lo);
    bounds_.hi = bounds_.hi.cwiseMax(cells_[k].hi);
  }
  return start;
}

/// In halves, across the longest edge.
void CellDecomposition::divide(std::uint32_t node) {
  Cell below = std::move(cells_[node]);
  int d = 0;
  below.size().cwiseProduct(scale_).maxCoeff(&d);
  Cell above = below;
  const double at = below.center()[d];
  below.hi[d] = above.lo[d] = at;
  below.tested = above.tested = false;
  const SampleList& active = active_.list();
  Contraction made_below, made_above;
  fork_join_([&] { contract(below, pair_, active, made_below); }, [&] { contract(above, pair_, active, made_above); });
  record_.divide(node, d, at, std::move(made_below), std::move(made_above));
  const CellStatus first = status(below), second = status(above);
  cells_.divide(node, {std::move(below), first}, {std::move(above), second});
}

}  // namespace dismantle::immobility
