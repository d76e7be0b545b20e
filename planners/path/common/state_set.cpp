#include "dismantle/path/state_set.h"

#include <cmath>

namespace dismantle::path {

StateSet::StateSet(std::vector<Ball> bodies, double translation, double rotation)
    : bodies_(std::move(bodies)), translation_(translation), rotation_(rotation) {}

StateSet::Key StateSet::key(const Eigen::Vector3d& c, int dx, int dy, int dz) const {
  const auto cell = [&](double x, int d) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / translation_)) + d) & 0x1fffffu;
  };
  return cell(c.x(), dx) << 42 | cell(c.y(), dy) << 21 | cell(c.z(), dz);
}

StateSet::Entry StateSet::entry(const State& state, std::uint32_t label) const {
  Entry e;
  e.label = label;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    e.centers.push_back(state.bodies[i].pose * bodies_[i].center);
    e.turns.push_back(state.bodies[i].pose.q);
  }
  return e;
}

bool StateSet::close(const Entry& a, const Entry& b) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if ((a.centers[i] - b.centers[i]).norm() >= translation_) return false;
    if (angle_between(a.turns[i], b.turns[i]) >= rotation_) return false;
  }
  return true;
}

void StateSet::add(const State& state, std::uint32_t label) {
  entries_.push_back(entry(state, label));
  cells_[key(entries_.back().centers.front(), 0, 0, 0)].push_back(static_cast<std::uint32_t>(entries_.size() - 1));
}

void StateSet::clear() {
  entries_.clear();
  cells_.clear();
}

bool StateSet::similar(const State& a, const State& b) const { return close(entry(a, 0), entry(b, 0)); }

template <class F>
void StateSet::near(const Entry& probe, const F& f) const {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dz = -1; dz <= 1; ++dz) {
        const auto cell = cells_.find(key(probe.centers.front(), dx, dy, dz));
        if (cell == cells_.end()) continue;
        for (const std::uint32_t i : cell->second)
          if (close(entries_[i], probe) && !f(entries_[i])) return;
      }
}

bool StateSet::has_similar(const State& state, std::uint32_t ignore_first, std::uint32_t ignore_last) const {
  bool found = false;
  near(entry(state, 0), [&](const Entry& e) {
    found = e.label < ignore_first || e.label >= ignore_last;
    return !found;
  });
  return found;
}

std::size_t StateSet::count_similar(const State& state) const {
  std::size_t count = 0;
  near(entry(state, 0), [&](const Entry&) { return ++count > 0; });
  return count;
}

}  // namespace dismantle::path
