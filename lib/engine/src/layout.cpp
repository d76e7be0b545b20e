#include "dismantle/engine/layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/geometry/direction.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle {

namespace {

struct Rectangle {
  Eigen::Vector2d lo, hi;
};

/// A value of x at which a corner may be placed. Among equally near positions the lowest rank is taken.
struct Column {
  double x = 0;
  std::size_t rank = 0;
};

/// `wish` and the edges of all rectangles, by ascending x, each value once, with its lowest rank.
std::vector<Column> columns_at(double wish, const std::vector<Rectangle>& blocked) {
  std::vector<Column> columns{{wish, 0}};
  for (const Rectangle& r : blocked) {
    columns.push_back({r.hi.x(), columns.size()});
    columns.push_back({r.lo.x(), columns.size()});
  }
  std::sort(columns.begin(), columns.end(),
            [](const Column& p, const Column& q) { return std::make_pair(p.x, p.rank) < std::make_pair(q.x, q.rank); });
  columns.erase(
      std::unique(columns.begin(), columns.end(), [](const Column& p, const Column& q) { return p.x == q.x; }),
      columns.end());
  return columns;
}

/// Sweeps a line over rectangles by ascending x and keeps those that it crosses, so that a column costs only these.
class Columns {
 public:
  /// `blocked`, by ascending lower edge, must outlive this.
  explicit Columns(const std::vector<Rectangle>& blocked) : blocked_(blocked), by_left_(blocked.size()) {
    std::iota(by_left_.begin(), by_left_.end(), std::size_t{0});
    std::sort(by_left_.begin(), by_left_.end(),
              [&](std::size_t p, std::size_t q) { return blocked[p].lo.x() < blocked[q].lo.x(); });
  }

  /// The values of y nearest to `wish`, one not below and one not above it, that are inside no rectangle at `x`. None
  /// is nearer than `least`. Must be called with ascending `x`.
  std::pair<double, double> nearest_free(double x, double wish, double least) {
    for (; next_ < by_left_.size() && blocked_[by_left_[next_]].lo.x() < x; ++next_)
      crossed_.insert(std::lower_bound(crossed_.begin(), crossed_.end(), by_left_[next_]), by_left_[next_]);
    std::erase_if(crossed_, [&](std::size_t r) { return blocked_[r].hi.x() <= x; });
    double above = wish + least, below = wish - least;
    for (const std::size_t i : crossed_) {  // by ascending lower edge, so one pass is enough
      const Rectangle& r = blocked_[i];
      if (r.lo.y() < above && above < r.hi.y()) above = r.hi.y();
    }
    for (bool moved = true; moved;) {
      moved = false;
      for (const std::size_t i : crossed_) {
        const Rectangle& r = blocked_[i];
        if (r.lo.y() < below && below < r.hi.y()) below = r.lo.y(), moved = true;
      }
    }
    return {above, below};
  }

 private:
  const std::vector<Rectangle>& blocked_;
  std::vector<std::size_t> by_left_;  // indices of blocked_, by left edge
  std::vector<std::size_t> crossed_;  // indices, ascending
  std::size_t next_ = 0;              // of by_left_: the first that the line has not reached
};

class Table {
 public:
  Table(int normal, double gap) : u_((normal + 1) % 3), v_((normal + 2) % 3), gap_(gap) {}

  Rectangle shadow(const Aabb& box) const { return {{box.lo[u_], box.lo[v_]}, {box.hi[u_], box.hi[v_]}}; }
  void take(const Rectangle& r) { taken_.push_back(r); }

  /// Lower corner of the free position of a box of this size whose centre is nearest to `middle`, which is the same for
  /// all. The forbidden corners are a union of rectangles; each coordinate of the nearest point outside is that of
  /// `wish` or of an edge.
  Eigen::Vector2d place(const Eigen::Vector2d& size, const Eigen::Vector2d& middle) {
    const Eigen::Vector2d wish = middle - size / 2;
    // Nothing is free within `known`. Rectangles that end there are not looked at: as many are left as fit around it.
    const double known = no_nearer(size), ends = known * (1 - geometry::kRounding);
    std::vector<Rectangle> blocked;
    // Rounding must not reduce the gap, and both edges are rounded.
    const double gap = gap_ + 2 * geometry::kRounding * gap_;
    for (const auto& t : taken_) {
      const Rectangle r{t.lo.array() - gap - size.array(), t.hi.array() + gap};
      const Eigen::Vector2d reach = (r.lo - wish).cwiseAbs().cwiseMax((r.hi - wish).cwiseAbs());
      if (!(reach.squaredNorm() < ends * ends)) blocked.push_back(r);
    }
    std::stable_sort(blocked.begin(), blocked.end(),
                     [](const Rectangle& p, const Rectangle& q) { return p.lo.y() < q.lo.y(); });

    Eigen::Vector2d best = wish;
    auto least = std::make_pair(std::numeric_limits<double>::infinity(), std::size_t{0});
    const auto consider = [&](const Eigen::Vector2d& corner, std::size_t rank) {
      const auto cost = std::make_pair((corner - wish).squaredNorm(), rank);
      if (cost < least) least = cost, best = corner;
    };
    Columns columns(blocked);
    for (const Column& c : columns_at(wish.x(), blocked)) {
      const double aside = c.x - wish.x(), within = known * known - aside * aside;
      const auto [above, below] = columns.nearest_free(c.x, wish.y(), within > 0 ? std::sqrt(within) : 0);
      consider({c.x, above}, 2 * c.rank);
      consider({c.x, below}, 2 * c.rank + 1);
    }
    remember(size, std::sqrt(least.first) - geometry::kRounding * (best.cwiseAbs() + size + middle.cwiseAbs()).sum());
    return best;
  }

 private:
  int u_, v_;
  /// A box of at least this size had no free position nearer to the middle. What is taken since makes it no nearer.
  struct Known {
    Eigen::Vector2d size;
    double distance = 0;
  };
  static bool is_within(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return (a.array() <= b.array()).all(); }
  double no_nearer(const Eigen::Vector2d& size) const {
    double most = 0;
    for (const Known& k : known_)
      if (k.distance > most && is_within(k.size, size)) most = k.distance;
    return most;
  }
  void remember(const Eigen::Vector2d& size, double distance) {
    if (!(distance > no_nearer(size))) return;
    std::erase_if(known_, [&](const Known& k) { return k.distance <= distance && is_within(size, k.size); });
    known_.push_back({size, distance});
  }

  double gap_;
  std::vector<Rectangle> taken_;
  std::vector<Known> known_;  // of which none says all that another one says
};

}  // namespace

void LayoutOptions::describe(Schema<LayoutOptions>& s) {
  s.add("enabled", &LayoutOptions::enabled,
        {.doc = "Plan the transfer of each part from a layout to where it is inserted (Algorithm 3). Off: assembly "
                "steps begin where the disassembly left the parts."});
  s.add("up", &LayoutOptions::up,
        {.doc =
             "What is up in the input's coordinates: x, y, z, -x, -y, -z or X,Y,Z; auto is y for glTF, else z. Gravity "
             "pulls against it, pictures and words follow it, and parts are laid out on the plane across the nearest "
             "axis."});
  s.add("gap", &LayoutOptions::gap,
        {.unit = "unit", .min = 1e-3, .max = 100, .doc = "Minimum distance between any two boxes of the layout."});
}

Eigen::Vector3d LayoutOptions::up_axis() const {
  const std::optional<Eigen::Vector3d> axis = direction_named(up == "auto" ? "z" : up);
  if (!axis) throw Error("layout.up: '" + up + "' is no direction; write " + kDirectionForms);
  return *axis;
}

std::vector<Eigen::Vector3d> lay_out(const std::vector<Aabb>& boxes, const std::vector<Aabb>& taken,
                                     const Eigen::Vector3d& up, double gap) {
  if (taken.empty()) throw std::invalid_argument("lay_out: there must be something to lay the boxes around");
  int w = 0;
  up.cwiseAbs().maxCoeff(&w);
  Table table(w, gap);
  for (const auto& t : taken) table.take(table.shadow(t));
  const Rectangle first = table.shadow(taken.front());
  const Eigen::Vector2d middle = (first.lo + first.hi) / 2;

  const auto area = [&](std::size_t i) {
    const Rectangle r = table.shadow(boxes[i]);
    return (r.hi - r.lo).prod();
  };
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return area(a) > area(b); });

  std::vector<Eigen::Vector3d> shifts(boxes.size());
  for (const std::size_t i : order) {
    const Rectangle r = table.shadow(boxes[i]);
    const Eigen::Vector2d at = table.place(r.hi - r.lo, middle);
    table.take({at, at + (r.hi - r.lo)});
    shifts[i][(w + 1) % 3] = at.x() - r.lo.x();
    shifts[i][(w + 2) % 3] = at.y() - r.lo.y();
    shifts[i][w] = up[w] > 0 ? taken.front().lo[w] - boxes[i].lo[w] : taken.front().hi[w] - boxes[i].hi[w];
  }
  return shifts;
}

}  // namespace dismantle
