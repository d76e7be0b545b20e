#include "dismantle/engine/layout.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace dismantle {

namespace {

/// Room for rounding: things that keep `gap` apart must not be a rounding closer.
constexpr double kSlack = 1e-9;

struct Rectangle {
  Eigen::Vector2d lo, hi;
};

class Table {
 public:
  Table(Up up, double gap) : u_((static_cast<int>(up) + 1) % 3), v_((static_cast<int>(up) + 2) % 3), gap_(gap) {}

  Rectangle shadow(const Aabb& box) const { return {{box.lo[u_], box.lo[v_]}, {box.hi[u_], box.hi[v_]}}; }
  void take(const Rectangle& r) { taken_.push_back(r); }

  /// Lower corner of the free place for a box of this size whose middle is nearest to `middle`. Where a corner may not
  /// be is a union of rectangles; the nearest point outside of it has `middle` or an edge in either coordinate.
  Eigen::Vector2d place(const Eigen::Vector2d& size, const Eigen::Vector2d& middle) const {
    std::vector<Rectangle> blocked;
    for (const auto& t : taken_)
      blocked.push_back({t.lo.array() - (gap_ + kSlack) - size.array(), t.hi.array() + (gap_ + kSlack)});
    std::stable_sort(blocked.begin(), blocked.end(),
                     [](const Rectangle& p, const Rectangle& q) { return p.lo.y() < q.lo.y(); });
    const Eigen::Vector2d wish = middle - size / 2;
    std::vector<double> xs{wish.x()};
    for (const auto& r : blocked) xs.insert(xs.end(), {r.hi.x(), r.lo.x()});

    Eigen::Vector2d best = wish;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](double x, double y) {
      const double off = (Eigen::Vector2d(x, y) - wish).squaredNorm();
      if (off < least) least = off, best = {x, y};
    };
    for (const double x : xs) {
      const auto in_the_way = [x](const Rectangle& r) { return r.lo.x() < x && x < r.hi.x(); };
      double above = wish.y(), below = wish.y();
      for (const auto& r : blocked)  // by rising lower edge: what was passed is not met again
        if (in_the_way(r) && r.lo.y() < above && above < r.hi.y()) above = r.hi.y();
      for (bool moved = true; moved;) {
        moved = false;
        for (const auto& r : blocked)
          if (in_the_way(r) && r.lo.y() < below && below < r.hi.y()) below = r.lo.y(), moved = true;
      }
      consider(x, above);
      consider(x, below);
    }
    return best;
  }

 private:
  int u_, v_;
  double gap_;
  std::vector<Rectangle> taken_;
};

}  // namespace

void LayoutOptions::describe(Schema<LayoutOptions>& s) {
  s.add(
      "enabled", &LayoutOptions::enabled,
      {.doc = "Plan the way of each part from a layout to where it is put in (Algorithm 3). Off: assembly steps begin "
              "where the disassembly left the parts."});
  s.add_choice<Up>("up", &LayoutOptions::up,
                   {{"x", Up::x, "the plane of y and z"}, {"y", Up::y, "of z and x"}, {"z", Up::z, "of x and y"}},
                   "Normal of the plane on which parts are laid out around the assembly.");
  s.add("gap", &LayoutOptions::gap,
        {.unit = "unit", .min = 1e-3, .max = 100, .doc = "Least distance between the boxes of two things laid out."});
}

std::vector<Eigen::Vector3d> lay_out(const std::vector<Aabb>& boxes, const std::vector<Aabb>& taken, Up up,
                                     double gap) {
  if (taken.empty()) throw std::invalid_argument("lay_out: there must be something to lay the boxes around");
  Table table(up, gap);
  for (const auto& t : taken) table.take(table.shadow(t));
  const Rectangle first = table.shadow(taken.front());
  const Eigen::Vector2d middle = (first.lo + first.hi) / 2;
  const int w = static_cast<int>(up);

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
    shifts[i][w] = taken.front().lo[w] - boxes[i].lo[w];
  }
  return shifts;
}

}  // namespace dismantle
