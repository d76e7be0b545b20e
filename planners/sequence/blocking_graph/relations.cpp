#include "blocking_graph/relations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace dismantle::blocking {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kAngle = 1e-9;  // unit of directions and rotations: far below the tolerance over an assembly's size

}  // namespace

const SharedAnswers& SharedAnswers::of(const PairSweep& sweep) {
  // By the tolerance, which decides them, too. The first part stands for the assembly.
  return *sweep.memo().get<SharedAnswers>(fmt::format("relations of shapes, tolerance {:a}", sweep.tolerance()), 0,
                                          RunContext{}, [] { return std::optional<SharedAnswers>(std::in_place); });
}

Relations::Relations(const PairSweep& sweep, const Directions& directions, const Orientations& orientations,
                     std::shared_ptr<Executor> executor)
    : directions_(directions),
      sweep_(sweep),
      grid_(1e-4 * sweep.tolerance()),
      shadows_(directions.all.size()),
      orientations_(orientations),
      answers_(SharedAnswers::of(sweep)),
      executor_(std::move(executor)),
      blocks_ahead_(executor_, Executor::Priority::speculative, [](bool blocked) { return blocked; }) {
  for (const auto& d : directions.all) {
    const Vec3 across = d.unitOrthogonal();
    Eigen::Matrix3d frame;
    frame.row(0) = d;
    frame.row(1) = across;
    frame.row(2) = d.cross(across);
    frames_.push_back(frame);
  }
}

Relations::Shadow Relations::scene(PartId part, std::size_t direction, const Eigen::Matrix3d& turn) const {
  Shadow s;
  const Eigen::Matrix3d frame = frames_[direction] * turn;
  for (const Vec3& v : sweep_.hull(part)) {
    const Vec3 p = frame * v;
    for (int k = 0; k < 3; ++k) s.lo[k] = std::min(s.lo[k], p[k]), s.hi[k] = std::max(s.hi[k], p[k]);
  }
  return s;
}

const Relations::Shadow& Relations::shadow(PartId part, std::size_t direction, std::size_t turn) const {
  if (turn != 0) {
    const auto [entry, is_new] = rotated_shadows_.try_emplace({turn, direction, part});
    if (is_new) entry->second = scene(part, direction, orientations_[turn].toRotationMatrix());
    return entry->second;
  }
  auto& list = shadows_[direction];
  if (list.empty())
    for (PartId id = 0; id < sweep_.parts(); ++id) list.push_back(scene(id, direction, Eigen::Matrix3d::Identity()));
  return list[part];
}

std::pair<double, double> Relations::extent(PartId part, std::size_t direction, std::size_t turn) const {
  const Shadow& s = shadow(part, direction, turn);
  return {s.lo[0], s.hi[0]};
}

Relations::Extents Relations::extents_at(PartId part, std::size_t direction, std::size_t turn, const Vec3& at) const {
  Extents e = shadow(part, direction, turn);
  const Vec3 t = frames_[direction] * at;
  for (int k = 0; k < 3; ++k) {
    e.lo[k] += t[k];
    e.hi[k] += t[k];
  }
  return e;
}

/// "i along d past j" and "j along -d past i" are one question. Budgets and rounded offsets could make their answers
/// differ, so only one form of the question is ever computed.
Relations::Key Relations::key_of(const Pair& pair) const {
  const bool swap = pair.moving > pair.fixed;
  const Vec3 offset = swap ? Vec3(-pair.offset) : pair.offset;
  const auto grid = [this](double x) { return std::lround(x / grid_); };
  return {swap ? pair.fixed : pair.moving,
          swap ? pair.moving : pair.fixed,
          swap ? Directions::opposite(pair.direction) : pair.direction,
          grid(offset.x()),
          grid(offset.y()),
          grid(offset.z()),
          swap ? pair.orientation_fixed : pair.orientation_moving,
          swap ? pair.orientation_moving : pair.orientation_fixed};
}

ShapeQuestion Relations::as_asked(const Pair& p) const {
  const geometry::ShapePlacement &moving = sweep_.shape(p.moving), &fixed = sweep_.shape(p.fixed);
  const Pose at = Pose{Vec3::Zero(), orientations_[p.orientation_fixed]} * fixed.pose;
  const Pose lies = at.inverse() * (Pose{p.offset, orientations_[p.orientation_moving]} * moving.pose);
  const Vec3 along = at.q.conjugate() * directions_.all[p.direction];
  // Of the two quaternions of a rotation, the one whose first large component is positive.
  std::array<double, 4> q{lies.q.w(), lies.q.x(), lies.q.y(), lies.q.z()};
  const auto large = std::find_if(q.begin(), q.end(), [](double x) { return std::abs(x) > 0.49; });
  if (large != q.end() && *large < 0)
    for (double& x : q) x = -x;
  ShapeQuestion question{static_cast<PartId>(moving.original), static_cast<PartId>(fixed.original)};
  for (std::size_t k = 0; k < 3; ++k) {
    question.offset[k] = std::llround(lies.t[static_cast<Eigen::Index>(k)] / grid_);
    question.direction[k] = std::llround(along[static_cast<Eigen::Index>(k)] / kAngle);
  }
  for (std::size_t k = 0; k < 4; ++k) question.rotation[k] = std::llround(q[k] / kAngle);
  // Ends a tenth of the tolerance past the fixed part, so that the two do not just touch at the end.
  question.length = std::llround((distance_past(p) + 0.1 * sweep_.tolerance()) / grid_);
  question.overlap = sweep_.overlap(p.moving, p.fixed);
  return question;
}

ShapeQuestion Relations::question_of(const Pair& p) const {
  return std::min(as_asked(p), as_asked({p.fixed, p.moving, Directions::opposite(p.direction), -p.offset,
                                         p.orientation_fixed, p.orientation_moving}));
}

bool Relations::known(const Pair& pair) const { return far(pair) || blocks_.contains(key_of(pair)); }

bool Relations::known_to_block(const Pair& pair) const {
  if (far(pair)) return false;
  const auto found = blocks_.find(key_of(pair));
  return found != blocks_.end() && found->second;
}

double Relations::distance_past(const Pair& p) const {
  return shadow(p.fixed, p.direction, p.orientation_fixed).hi[0] -
         shadow(p.moving, p.direction, p.orientation_moving).lo[0] - p.offset.dot(directions_.all[p.direction]);
}

bool Relations::far(const Pair& p) const {
  const Shadow &a = shadow(p.moving, p.direction, p.orientation_moving),
               &b = shadow(p.fixed, p.direction, p.orientation_fixed);
  const Vec3 o = frames_[p.direction] * p.offset;
  if (b.hi[0] - a.lo[0] - o[0] <= 0) return true;  // past it already
  for (int k = 1; k < 3; ++k)
    if (a.lo[k] + o[k] >= b.hi[k] || a.hi[k] + o[k] <= b.lo[k]) return true;
  return false;
}

/// The computation of an answer.
Relations::Ahead::Request Relations::request(const ShapeQuestion& q) const {
  return {q, [this, q](const RunContext&) {
            const auto real = [](std::int64_t x, double unit) { return unit * static_cast<double>(x); };
            Pose begin;
            Vec3 along;
            for (std::size_t k = 0; k < 3; ++k) {
              begin.t[static_cast<Eigen::Index>(k)] = real(q.offset[k], grid_);
              along[static_cast<Eigen::Index>(k)] = real(q.direction[k], kAngle);
            }
            begin.q = Eigen::Quaterniond(real(q.rotation[0], kAngle), real(q.rotation[1], kAngle),
                                         real(q.rotation[2], kAngle), real(q.rotation[3], kAngle))
                          .normalized();
            Pose end = begin;
            end.t += real(q.length, grid_) * along.normalized();
            // Of two others of these shapes the region is not known, unless these lie as they do.
            const bool as_assembled = begin.t.isZero(0) && begin.q.vec().isZero(0);
            if (as_assembled && sweep_.leaves_region(q.moving, q.fixed, Pose{}, {begin, end})) return true;
            return !sweep_.passes(q.moving, q.fixed, Pose{}, {begin, end}, q.overlap);
          }};
}

bool Relations::blocks(const Pair& pair) {
  if (far(pair)) return false;
  const Key key = key_of(pair);
  const auto found = blocks_.find(key);
  if (found != blocks_.end()) return found->second;
  const ShapeQuestion question = question_of(pair);
  std::optional<bool> answer = answers_.find(question);
  if (!answer) answers_.add(question, *(answer = blocks_ahead_.get(question, request(question).compute, {})));
  return blocks_.emplace(key, *answer).first->second;
}

void Relations::compute(std::span<const Pair> pairs) {
  std::vector<std::pair<Key, ShapeQuestion>> asked;
  std::vector<ShapeQuestion> unknown;
  for (const Pair& pair : pairs) {
    if (known(pair)) continue;
    asked.emplace_back(key_of(pair), question_of(pair));
    if (!answers_.find(asked.back().second)) unknown.push_back(asked.back().second);
  }
  std::sort(unknown.begin(), unknown.end());
  unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
  std::vector<char> blocked(unknown.size());
  parallel_for(
      unknown.size(), executor_.get(),
      [&](std::size_t k) { blocked[k] = blocks_ahead_.get(unknown[k], request(unknown[k]).compute, {}); },
      [] { return false; });
  for (std::size_t k = 0; k < unknown.size(); ++k) answers_.add(unknown[k], blocked[k] != 0);
  for (const auto& [key, question] : asked) blocks_.emplace(key, answers_.find(question).value());
}

void Relations::hint(const std::vector<std::vector<Pair>>& lists) {
  std::deque<Ahead::Sequence> sequences;
  for (const auto& list : lists) {
    Ahead::Sequence sequence;
    for (const Pair& pair : list) {
      if (known(pair)) continue;
      const ShapeQuestion question = question_of(pair);
      const std::optional<bool> answer = answers_.find(question);
      if (!answer)
        sequence.push_back(request(question));
      else if (*answer)
        break;
    }
    if (!sequence.empty()) sequences.push_back(std::move(sequence));
  }
  blocks_ahead_.prefetch(std::move(sequences), {});
}

}  // namespace dismantle::blocking
