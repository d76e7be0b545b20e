#include "dismantle/geometry/hull.h"

#include <libqhull_r/libqhull_r.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <tuple>

namespace dismantle {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// The first of each set of equal points, in the order given.
Points without_duplicates(std::span<const Eigen::Vector3d> points) {
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  const auto key = [&](std::uint32_t i) { return std::make_tuple(points[i].x(), points[i].y(), points[i].z(), i); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<bool> keep(points.size(), true);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) keep[order[i]] = false;
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (keep[i]) result.push_back(points[i]);
  return result;
}

/// Discards the output of qhull: a degenerate set is a valid input here, not an error.
class MemoryStream {
 public:
  MemoryStream() : file_(open_memstream(&text_, &size_)) {}
  ~MemoryStream() {
    if (file_) std::fclose(file_);
    std::free(text_);
  }
  MemoryStream(const MemoryStream&) = delete;
  MemoryStream& operator=(const MemoryStream&) = delete;
  FILE* file() const { return file_; }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  FILE* file_;
};

/// Corners after which qhull is stopped: its time grows with the square of the corners that lie in one plane, as those
/// of a round plate do.
constexpr std::size_t kMostAdded = 10'000;

class Qhull {
 public:
  /// Runs qhull on `coordinates` (x y z ...); keeps no reference to them.
  Qhull(std::vector<double>& coordinates, FILE* sink) {
    qh_zero(&qh_, sink);
    std::string command = "qhull Pp TA" + std::to_string(kMostAdded);
    failed_ = qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(), False, command.data(),
                           sink, sink) != 0;
  }
  ~Qhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int left = 0, total = 0;
    qh_memfreeshort(&qh_, &left, &total);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool failed() const { return failed_; }
  /// Corners, and where qhull was stopped also the points that it had not looked at.
  std::vector<bool> corner_flags(std::size_t count) {
    std::vector<bool> flags(count, false);
    const auto mark = [&](pointT* point) {
      const int id = qh_pointid(&qh_, point);
      if (id >= 0) flags[static_cast<std::size_t>(id)] = true;
    };
    std::size_t corners = 0;
    for (vertexT* v = qh_.vertex_list; v && v->next; v = v->next, ++corners) mark(v->point);
    if (corners < kMostAdded) return flags;
    for (facetT* f = qh_.facet_list; f && f->next; f = f->next)
      for (setT* left : {f->outsideset, f->coplanarset})
        for (int i = 0, n = left ? qh_setsize(&qh_, left) : 0; i < n; ++i) mark(static_cast<pointT*>(left->e[i].p));
    return flags;
  }

 private:
  qhT qh_;
  bool failed_ = true;
};

}  // namespace

std::vector<Eigen::Vector3d> hull_corners(std::span<const Eigen::Vector3d> points) {
  Points distinct = without_duplicates(points);
  if (distinct.size() <= 4 || distinct.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 4))
    return distinct;
  std::vector<double> coordinates;
  coordinates.reserve(3 * distinct.size());
  for (const auto& p : distinct) coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  const MemoryStream sink;
  if (!sink.file()) return distinct;
  Qhull qhull(coordinates, sink.file());
  if (qhull.failed()) return distinct;  // flat: return all points, a superset of the corners
  const std::vector<bool> flags = qhull.corner_flags(distinct.size());
  Points result;
  for (std::size_t i = 0; i < distinct.size(); ++i)
    if (flags[i]) result.push_back(distinct[i]);
  return result.empty() ? distinct : result;
}

}  // namespace dismantle
