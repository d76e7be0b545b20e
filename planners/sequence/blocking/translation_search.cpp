#include "blocking/translation_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

#include "blocking_graph/directions.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

using Set = std::uint64_t;  // of parts, by their index in the group

/// One state of the search. Places are relative to those of the group's first part.
struct Node {
  std::vector<Vec3> at;
  std::int64_t parent = -1;
  Set moved = 0;
  std::size_t direction = 0;
  double length = 0;
};

struct PlacesHash {
  std::size_t operator()(const std::vector<std::int64_t>& key) const {
    std::uint64_t h = 0x9e3779b97f4a7c15ULL;
    for (const std::int64_t v : key) h = (h ^ static_cast<std::uint64_t>(v)) * 0xbf58476d1ce4e5b9ULL, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

}  // namespace

/// Parts are thinner by the inset. Half of it remains between parts where they stop; passing closer counts as contact.
double TranslationSearch::gap() const { return 0.5 * params_.translation_inset * tolerance_; }

/// Places that differ by less than the gap are the same.
std::int64_t TranslationSearch::grid(double x) const { return std::llround(x / gap()); }

std::vector<std::int64_t> TranslationSearch::key_of_places(const std::vector<Vec3>& at) const {
  std::vector<std::int64_t> key;
  for (std::size_t i = 1; i < at.size(); ++i)
    for (int k = 0; k < 3; ++k) key.push_back(grid(at[i][k] - at[0][k]));
  return key;
}

std::size_t TranslationSearch::Hash::operator()(const Key& k) const {
  std::uint64_t h = k.pair;
  for (const std::int64_t v : {k.x, k.y, k.z})
    h = (h ^ static_cast<std::uint64_t>(v)) * 0xbf58476d1ce4e5b9ULL, h ^= h >> 31;
  return static_cast<std::size_t>(h);
}

TranslationSearch::TranslationSearch(const Assembly& assembly, double tolerance, const PartialTranslationParams& params)
    : assembly_(assembly), tolerance_(tolerance), params_(params) {}

const TranslationSearch::Shape& TranslationSearch::shape(PartId part) { return shapes_.at(part); }

/// Does the body have few enough edges to compare all pairs of them?
bool TranslationSearch::is_simple(const Polyhedron& body) const {
  return body.edges().size() <= params_.translation_edges;
}

/// Computes shapes and directions for a group. False: the search is not suited to it.
bool TranslationSearch::prepare(const Places& places) {
  if (places.size() > std::numeric_limits<Set>::digits) return false;
  for (const auto& [part, at] : places) {
    const auto known = shapes_.find(part);
    if (known != shapes_.end()) {
      if (!is_simple(known->second.body)) return false;
      continue;
    }
    const Mesh& mesh = *assembly_.parts[part].mesh;
    const auto [entry, is_new] =
        shapes_.emplace(part, Shape{Polyhedron(mesh, params_.translation_inset * tolerance_), {}});
    if (!is_simple(entry->second.body)) return false;
  }
  if (directions_.empty()) {
    // The most important axes of all parts of the assembly, not only of this group, so that indices stay valid.
    std::vector<std::pair<Vec3, double>> axes;
    for (const auto& part : assembly_.parts) {
      double weight = 1;
      for (const Vec3& axis : axes_of(*part.mesh, params_.translation_axes)) {
        const auto same = std::find_if(axes.begin(), axes.end(), [&](const auto& a) {
          return std::abs(a.first.dot(axis)) > geometry::kSameDirection;
        });
        if (same == axes.end())
          axes.emplace_back(axis, weight);
        else
          same->second += weight;
        weight *= 0.5;
      }
    }
    std::stable_sort(axes.begin(), axes.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    if (axes.size() > params_.translation_axes) axes.resize(params_.translation_axes);
    for (const auto& [axis, weight] : axes) {
      directions_.push_back(axis);
      directions_.push_back(-axis);
    }
  }
  for (auto& [part, shape] : shapes_) {
    if (!shape.planes.empty()) continue;
    shape.planes.resize(directions_.size());
    for (const auto& face : shape.body.faces())
      for (std::size_t d = 0; d < directions_.size(); ++d)
        if (face.normal.dot(directions_[d]) > geometry::kSameDirection) shape.planes[d].push_back(face.offset);
    for (auto& list : shape.planes) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end(), [this](double a, double b) { return b - a < gap(); }),
                 list.end());
    }
  }
  return true;
}

TranslationSearch::Key TranslationSearch::key_of(PartId moving, PartId fixed, const Vec3& offset, std::size_t direction,
                                                 double& sign) const {
  sign = moving < fixed ? 1 : -1;
  const std::uint64_t a = std::min(moving, fixed), b = std::max(moving, fixed);
  const std::size_t d = moving < fixed ? direction : Directions::opposite(direction);
  return {(a << 40) ^ (b << 16) ^ d, grid(sign * offset.x()), grid(sign * offset.y()), grid(sign * offset.z())};
}

double TranslationSearch::free_distance(PartId moving, PartId fixed, const Vec3& offset, std::size_t direction) {
  double sign = 1;
  const Key key = key_of(moving, fixed, offset, direction, sign);
  const auto known = free_.find(key);
  if (known != free_.end()) return known->second;
  work_ +=
      static_cast<double>(shape(moving).body.edges().size()) * static_cast<double>(shape(fixed).body.edges().size());
  const double length =
      distance_until_contact(shape(moving).body, shape(fixed).body, offset, directions_[direction], gap());
  return free_.emplace(key, length).first->second;
}

void TranslationSearch::forbid(PartId moving, PartId fixed, const Vec3& offset, const Vec3& direction) {
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    if (directions_[d].dot(direction) < geometry::kSameDirection) continue;
    double sign = 1;
    free_[key_of(moving, fixed, offset, d, sign)] = 0;
  }
}

TranslationSearch::Answer TranslationSearch::search(const Places& places, std::size_t most_states, double most_work,
                                                    const RunContext& context) {
  if (!prepare(places)) return {};
  work_ = 0;
  most_work_ = most_work;
  // Stops at contact multiply the number of states, and most puzzles do not need them.
  const Answer flush = search(places, most_states, false, context);
  if (flush.end != End::exhausted) return flush;
  Answer both = search(places, most_states, true, context);
  both.states += flush.states;
  return both;
}

TranslationSearch::Answer TranslationSearch::search(const Places& places, std::size_t most_states, bool to_contact,
                                                    const RunContext& context) {
  Answer answer;
  const std::size_t n = places.size();
  std::vector<PartId> id;
  Node first;
  for (const auto& [part, at] : places) {
    id.push_back(part);
    first.at.push_back(at);
  }
  const Set everyone = n == std::numeric_limits<Set>::digits ? ~Set{0} : (Set{1} << n) - 1;

  const double play = params_.play * tolerance_;
  const double stand_off = gap();
  std::vector<Node> nodes{first};
  std::unordered_set<std::vector<std::int64_t>, PlacesHash> seen{key_of_places(first.at)};
  std::vector<double> free(n * n);
  const auto unwind = [&](std::size_t node, Set leaving, std::size_t direction) {
    const auto parts_of = [&](Set set) {
      std::vector<PartId> parts;
      for (std::size_t i = 0; i < n; ++i)
        if (set >> i & 1) parts.push_back(id[i]);
      return parts;
    };
    answer.translations.push_back({parts_of(leaving), directions_[direction], std::numeric_limits<double>::infinity()});
    for (std::int64_t k = static_cast<std::int64_t>(node); nodes[static_cast<std::size_t>(k)].parent >= 0;
         k = nodes[static_cast<std::size_t>(k)].parent) {
      const Node& step = nodes[static_cast<std::size_t>(k)];
      answer.translations.push_back({parts_of(step.moved), directions_[step.direction], step.length});
    }
    std::reverse(answer.translations.begin(), answer.translations.end());
    // Merge consecutive translations of the same parts along the same direction.
    for (std::size_t k = 0; k + 1 < answer.translations.size();) {
      Translation &a = answer.translations[k], &b = answer.translations[k + 1];
      if (a.parts == b.parts && a.direction == b.direction) {
        a.length += b.length;
        answer.translations.erase(answer.translations.begin() + static_cast<std::ptrdiff_t>(k) + 1);
      } else {
        ++k;
      }
    }
    answer.end = End::found;
  };

  for (std::size_t current = 0; current < nodes.size(); ++current) {
    if (context.should_stop()) {
      answer.end = End::stopped;
      return answer;
    }
    answer.states = current + 1;
    if (current >= most_states) {
      answer.end = End::limit;
      return answer;
    }
    if (work_ > most_work_) {
      answer.end = End::too_long;
      return answer;
    }
    const std::vector<Vec3> at = nodes[current].at;
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          free[i * n + j] =
              i == j ? std::numeric_limits<double>::infinity() : free_distance(id[i], id[j], at[i] - at[j], d);
      /// All parts that move when part i moves by `length`: each part takes along the parts that it runs into.
      const auto taken_along = [&](std::size_t i, double length) {
        Set set = Set{1} << i;
        std::vector<std::size_t> open{i};
        while (!open.empty()) {
          const std::size_t g = open.back();
          open.pop_back();
          for (std::size_t j = 0; j < n; ++j)
            if ((set >> j & 1) == 0 && free[g * n + j] < length) {
              set |= Set{1} << j;
              open.push_back(j);
            }
        }
        return set;
      };
      Set best = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const Set leaving = taken_along(i, std::numeric_limits<double>::infinity());
        if (leaving != everyone && (best == 0 || __builtin_popcountll(leaving) < __builtin_popcountll(best)))
          best = leaving;
      }
      if (best != 0) {
        unwind(current, best, d);
        return answer;
      }
      std::set<std::pair<Set, std::int64_t>> tried;
      for (std::size_t i = 0; i < n; ++i) {
        // Distance to the next place where a face of part i is flush with another part's face of equal normal.
        double next = std::numeric_limits<double>::infinity(), meets = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < n; ++j) {
          if (j == i) continue;
          meets = std::min(meets, free[i * n + j]);
          const double along = (at[j] - at[i]).dot(directions_[d]);
          for (const std::size_t side : {d, Directions::opposite(d)}) {
            const double sign = side == d ? 1 : -1;
            for (const double a : shape(id[i]).planes[side])
              for (const double b : shape(id[j]).planes[side]) {
                const double length = sign * (b - a) + along;
                if (length > params_.translation_least_step * tolerance_ && length < next) next = length;
              }
          }
        }
        std::vector<double> lengths;
        if (next < std::numeric_limits<double>::infinity()) lengths.push_back(next);
        if (to_contact && meets < next && meets - stand_off > play && next - meets > play)
          lengths.push_back(meets - stand_off);
        for (const double length : lengths) {
          const Set set = taken_along(i, length);
          if (set == everyone || !tried.insert({set, grid(length)}).second) continue;
          Node node;
          node.at = at;
          for (std::size_t k = 0; k < n; ++k)
            if (set >> k & 1) node.at[k] += length * directions_[d];
          if (!seen.insert(key_of_places(node.at)).second) continue;
          node.parent = static_cast<std::int64_t>(current);
          node.moved = set;
          node.direction = d;
          node.length = length;
          nodes.push_back(std::move(node));
        }
      }
    }
  }
  answer.end = End::exhausted;
  return answer;
}

}  // namespace dismantle::blocking
