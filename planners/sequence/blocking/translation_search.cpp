#include "blocking/translation_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <unordered_set>

#include "blocking_graph/directions.h"
#include "dismantle/geometry/numerics.h"

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

/// The arrangements that one search has found.
class TranslationSearch::Arrangements {
 public:
  using Set = std::uint64_t;  ///< of parts, by their index in the group
  static constexpr std::size_t kMostParts = std::numeric_limits<Set>::digits;

  /// `search` outlives this and is prepared for `places`.
  Arrangements(TranslationSearch& search, const Places& places, bool to_contact)
      : search_(search), to_contact_(to_contact), free_(places.size() * places.size()) {
    Node first;
    for (const auto& [part, at] : places) {
      ids_.push_back(part);
      first.at.push_back(at);
    }
    everyone_ = count() == kMostParts ? ~Set{0} : (Set{1} << count()) - 1;
    seen_.insert(search_.key_of_places(first.at));
    nodes_.push_back(std::move(first));
  }

  std::size_t size() const { return nodes_.size(); }
  /// Adds the arrangements that follow an arrangement. Ends early, with the translations that lead there and the last
  /// one that never ends, if parts can leave. Also when the work of the search is used up.
  std::optional<std::vector<Translation>> expand(std::size_t node);

 private:
  /// One arrangement. Places are relative to those of the group's first part.
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
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::size_t count() const { return ids_.size(); }
  bool measure(const std::vector<Vec3>& at, std::size_t direction);
  Set taken_along(std::size_t part, double length) const;
  Set fewest_that_leave() const;
  double next_flush(const std::vector<Vec3>& at, std::size_t part, std::size_t direction);
  std::vector<double> lengths_of(const std::vector<Vec3>& at, std::size_t part, std::size_t direction);
  void add(std::size_t parent, Set moved, std::size_t direction, double length);
  std::vector<PartId> parts_of(Set set) const;
  std::vector<Translation> unwind(std::size_t node, Set leaving, std::size_t direction) const;

  TranslationSearch& search_;
  const bool to_contact_;  ///< parts also stop where they meet others
  std::vector<PartId> ids_;
  Set everyone_;
  std::vector<Node> nodes_;
  std::unordered_set<std::vector<std::int64_t>, PlacesHash> seen_;
  std::vector<double> free_;  ///< by pair: length that the first can move until it meets the second
};

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

TranslationSearch::TranslationSearch(const Assembly& assembly, double tolerance,
                                     const PartialTranslationParameters& params)
    : assembly_(assembly), tolerance_(tolerance), params_(params) {}

const TranslationSearch::Shape& TranslationSearch::shape(PartId part) { return shapes_.at(part); }

/// Does the body have few enough edges to compare all pairs of them?
bool TranslationSearch::is_simple(const Polyhedron& body) const {
  return body.edges().size() <= params_.translation_edges;
}

/// Computes shapes and directions for a group. False: the search is not suited to it.
bool TranslationSearch::prepare(const Places& places) {
  if (places.size() > Arrangements::kMostParts) return false;
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

/// Measures how far each part can move along a direction until it meets each other part. False: the work is used up.
bool TranslationSearch::Arrangements::measure(const std::vector<Vec3>& at, std::size_t direction) {
  for (std::size_t i = 0; i < count(); ++i)
    for (std::size_t j = 0; j < count(); ++j) {
      if (search_.work_ > search_.most_work_) return false;
      free_[i * count() + j] = i == j ? kInfinity : search_.free_distance(ids_[i], ids_[j], at[i] - at[j], direction);
    }
  return true;
}

/// All parts that move when a part moves by `length`: each part takes along the parts that it runs into.
TranslationSearch::Arrangements::Set TranslationSearch::Arrangements::taken_along(std::size_t part,
                                                                                  double length) const {
  Set set = Set{1} << part;
  std::vector<std::size_t> open{part};
  while (!open.empty()) {
    const std::size_t g = open.back();
    open.pop_back();
    for (std::size_t j = 0; j < count(); ++j)
      if ((set >> j & 1) == 0 && free_[g * count() + j] < length) {
        set |= Set{1} << j;
        open.push_back(j);
      }
  }
  return set;
}

/// The smallest set of parts that can leave; empty if none can.
TranslationSearch::Arrangements::Set TranslationSearch::Arrangements::fewest_that_leave() const {
  Set best = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    const Set leaving = taken_along(i, kInfinity);
    if (leaving != everyone_ && (best == 0 || std::popcount(leaving) < std::popcount(best))) best = leaving;
  }
  return best;
}

/// Distance to the next place where a face of a part is flush with another part's face of equal normal.
double TranslationSearch::Arrangements::next_flush(const std::vector<Vec3>& at, std::size_t part,
                                                   std::size_t direction) {
  const double least = search_.params_.translation_least_step * search_.tolerance_;
  double next = kInfinity;
  for (std::size_t j = 0; j < count(); ++j) {
    if (j == part) continue;
    const double along = (at[j] - at[part]).dot(search_.directions_[direction]);
    for (const std::size_t side : {direction, Directions::opposite(direction)}) {
      const double sign = side == direction ? 1 : -1;
      search_.work_ += static_cast<double>(search_.shape(ids_[part]).planes[side].size() *
                                           search_.shape(ids_[j]).planes[side].size());
      for (const double a : search_.shape(ids_[part]).planes[side])
        for (const double b : search_.shape(ids_[j]).planes[side]) {
          const double length = sign * (b - a) + along;
          if (length > least && length < next) next = length;
        }
    }
  }
  return next;
}

/// The lengths by which a part is translated.
std::vector<double> TranslationSearch::Arrangements::lengths_of(const std::vector<Vec3>& at, std::size_t part,
                                                                std::size_t direction) {
  const double next = next_flush(at, part, direction);
  std::vector<double> lengths;
  if (next < kInfinity) lengths.push_back(next);
  if (!to_contact_) return lengths;
  const auto row = free_.begin() + static_cast<std::ptrdiff_t>(part * count());
  const double meets = *std::min_element(row, row + static_cast<std::ptrdiff_t>(count()));
  const double play = search_.params_.play * search_.tolerance_, stop = meets - search_.gap();
  if (meets < next && stop > play && next - meets > play) lengths.push_back(stop);
  return lengths;
}

void TranslationSearch::Arrangements::add(std::size_t parent, Set moved, std::size_t direction, double length) {
  Node node;
  node.at = nodes_[parent].at;
  for (std::size_t k = 0; k < count(); ++k)
    if (moved >> k & 1) node.at[k] += length * search_.directions_[direction];
  if (!seen_.insert(search_.key_of_places(node.at)).second) return;
  node.parent = static_cast<std::int64_t>(parent);
  node.moved = moved;
  node.direction = direction;
  node.length = length;
  nodes_.push_back(std::move(node));
}

std::optional<std::vector<Translation>> TranslationSearch::Arrangements::expand(std::size_t node) {
  const std::vector<Vec3> at = nodes_[node].at;
  for (std::size_t d = 0; d < search_.directions_.size(); ++d) {
    if (!measure(at, d)) return std::nullopt;
    if (const Set leaving = fewest_that_leave(); leaving != 0) return unwind(node, leaving, d);
    std::set<std::pair<Set, std::int64_t>> tried;
    for (std::size_t i = 0; i < count(); ++i)
      for (const double length : lengths_of(at, i, d)) {
        const Set moved = taken_along(i, length);
        if (moved != everyone_ && tried.insert({moved, search_.grid(length)}).second) add(node, moved, d, length);
      }
  }
  return std::nullopt;
}

std::vector<PartId> TranslationSearch::Arrangements::parts_of(Set set) const {
  std::vector<PartId> parts;
  for (std::size_t i = 0; i < count(); ++i)
    if (set >> i & 1) parts.push_back(ids_[i]);
  return parts;
}

/// The translations from the first arrangement to this one, and then `leaving` along `direction`.
std::vector<Translation> TranslationSearch::Arrangements::unwind(std::size_t node, Set leaving,
                                                                 std::size_t direction) const {
  std::vector<Translation> translations{{parts_of(leaving), search_.directions_[direction], kInfinity}};
  for (const Node* step = &nodes_[node]; step->parent >= 0; step = &nodes_[static_cast<std::size_t>(step->parent)])
    translations.push_back({parts_of(step->moved), search_.directions_[step->direction], step->length});
  std::reverse(translations.begin(), translations.end());
  // Merge consecutive translations of the same parts along the same direction.
  for (std::size_t k = 0; k + 1 < translations.size();) {
    Translation &a = translations[k], &b = translations[k + 1];
    if (a.parts == b.parts && a.direction == b.direction) {
      a.length += b.length;
      translations.erase(translations.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    } else {
      ++k;
    }
  }
  return translations;
}

TranslationSearch::Answer TranslationSearch::search(const Places& places, std::size_t most_states, bool to_contact,
                                                    const RunContext& context) {
  Arrangements arrangements(*this, places, to_contact);
  Answer answer;
  answer.moves = places.size() * directions_.size();
  for (std::size_t current = 0; current < arrangements.size(); ++current) {
    answer.waiting = arrangements.size() - current;
    if (context.should_stop()) {
      answer.end = End::stopped;
      return answer;
    }
    answer.states = current + 1;
    if (current >= most_states || work_ > most_work_) {
      answer.end = current >= most_states ? End::limit : End::too_long;
      return answer;
    }
    if (auto translations = arrangements.expand(current)) {
      answer.translations = std::move(*translations);
      answer.end = End::found;
      return answer;
    }
    if (work_ > most_work_) {  // it may be in the middle of the arrangement
      answer.end = End::too_long;
      return answer;
    }
  }
  answer.end = End::exhausted;
  answer.waiting = 0;
  return answer;
}

}  // namespace dismantle::blocking
