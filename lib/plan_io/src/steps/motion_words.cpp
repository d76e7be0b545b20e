#include "dismantle/plan_io/motion_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {
namespace {

constexpr double kOneAxis = 0.996;  // cosine of 5 degrees: within it a direction is that of an axis
constexpr double kTurned = 1.0;     // degrees: a smaller turn is not mentioned

/// Appends the kept points of points[begin..end], without the first.
void simplify(const std::vector<Eigen::Vector3d>& points, std::size_t begin, std::size_t end, double tolerance,
              std::vector<Eigen::Vector3d>& kept) {
  const Eigen::Vector3d a = points[begin], d = points[end] - a;
  std::size_t furthest = begin;
  double distance = tolerance;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const double u = d.squaredNorm() > 0 ? std::clamp((points[i] - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    const double off = (points[i] - a - u * d).norm();
    if (off > distance) {
      distance = off;
      furthest = i;
    }
  }
  if (furthest == begin) {
    kept.push_back(points[end]);
    return;
  }
  simplify(points, begin, furthest, tolerance, kept);
  simplify(points, furthest, end, tolerance, kept);
}

std::string turn_words(double turn) {
  const double degrees = turn * 180 / std::numbers::pi;
  if (degrees >= 719.5) return fmt::format("{} turns", figure_text(degrees / 360));
  return fmt::format("{:.0f}°", degrees);
}

/// Is the motion a list of straight slides, each along one of three orthogonal axes, as in a puzzle?
bool is_of_slides(const MotionSummary& motion) {
  constexpr std::size_t kMostSlides = 40;
  if (motion.stretches.size() > kMostSlides || motion.turn * 180 / std::numbers::pi >= kTurned) return false;
  const double across = std::sin(std::acos(kOneAxis));
  return std::all_of(motion.stretches.begin(), motion.stretches.end(), [&](const Eigen::Vector3d& a) {
    return std::all_of(motion.stretches.begin(), motion.stretches.end(), [&](const Eigen::Vector3d& b) {
      const double cosine = std::abs(a.normalized().dot(b.normalized()));
      return cosine > kOneAxis || cosine < across;
    });
  });
}

}  // namespace

Eigen::Vector3d point_on_axis(const std::vector<Pose>& poses, const Eigen::Vector3d& near) {
  const Pose* turned = nullptr;
  double most = std::sin(kTurned * std::numbers::pi / 180);
  for (const Pose& pose : poses)
    if (const double sine = (pose.q * poses.front().q.conjugate()).vec().norm(); sine > most) {
      most = sine;
      turned = &pose;
    }
  if (turned == nullptr) return near;
  // The motion from the first pose to this one: x -> R x + t. Its axis is where R x + t - x is parallel to the axis.
  const Eigen::Quaterniond q = turned->q * poses.front().q.conjugate();
  const Eigen::Vector3d t = turned->t - q * poses.front().t, axis = q.vec().normalized();
  const Eigen::Vector3d across = t - axis * axis.dot(t);
  const Eigen::Vector3d centre = 0.5 * (across + (q.w() / q.vec().norm()) * axis.cross(across));
  const Eigen::Vector3d start = poses.front() * near;
  return poses.front().q.conjugate() * (centre + axis * axis.dot(start) - poses.front().t);
}

MotionSummary in_unit(MotionSummary motion, double factor) {
  for (Eigen::Vector3d& stretch : motion.stretches) stretch *= factor;
  motion.displacement *= factor;
  motion.length *= factor;
  return motion;
}

std::string figure_text(double x) {
  if (x == 0) return "0";
  const double size = std::abs(x);
  if (size >= 1e6 || size < 1e-4) return fmt::format("{:.3g}", x);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
  std::string out = fmt::format("{:.{}f}", x, decimals);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out;
}

MotionSummary summarize_motion(const std::vector<Pose>& poses, const Eigen::Vector3d& point, double tolerance) {
  MotionSummary out;
  if (poses.size() < 2) return out;
  std::vector<Eigen::Vector3d> points;
  for (const Pose& pose : poses) points.push_back(pose * point);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  double gross = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    out.length += (points[i] - points[i - 1]).norm();
    const Eigen::Vector3d w = rotation_vector((poses[i].q * poses[i - 1].q.conjugate()).normalized());
    turned += w;
    gross += w.norm();
  }
  out.displacement = points.back() - points.front();
  // Turns that cancel out do not count.
  out.turn = turned.norm();
  if (out.turn > 1e-3 * gross && out.turn > 0) out.axis = turned / out.turn;
  std::vector<Eigen::Vector3d> kept{points.front()};
  simplify(points, 0, points.size() - 1, tolerance, kept);
  for (std::size_t i = 1; i < kept.size(); ++i)
    if (const Eigen::Vector3d stretch = kept[i] - kept[i - 1]; stretch.norm() > tolerance || kept.size() > 2)
      out.stretches.push_back(stretch);
  if (out.stretches.empty() && out.displacement.norm() > 0 && !(out.turn * 180 / std::numbers::pi > kTurned))
    out.stretches.push_back(out.displacement);  // short, but the whole motion
  return out;
}

std::string axis_text(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  for (int k = 0; k < 3; ++k)
    if (std::abs(d[k]) > kOneAxis) return fmt::format("{}{}", d[k] > 0 ? '+' : '-', "XYZ"[k]);
  const auto rounded = [](double x) { return std::round(100 * x) / 100 + 0.0; };
  return fmt::format("({}, {}, {})", rounded(d.x()), rounded(d.y()), rounded(d.z()));
}

std::string direction_words(const Eigen::Vector3d& direction, const Eigen::Vector3d& drawn_up,
                            const Eigen::Quaterniond& lies) {
  const double length = direction.norm();
  if (!(length > 0) || !std::isfinite(length)) throw Error("a direction without length has no words");
  const Eigen::Vector3d seen = upright(drawn_up) * (lies * (direction / length));
  struct Axis {
    Eigen::Index k;
    const char *plus, *minus;
  };
  const Axis axes[3] = {{2, "up", "down"}, {0, "right", "left"}, {1, "to the back", "to the front"}};
  std::string words;
  for (const Axis& axis : axes)
    if (std::abs(seen[axis.k]) > kOneAxis) words = seen[axis.k] > 0 ? axis.plus : axis.minus;
  const bool several = words.empty();
  for (const Axis& axis : axes)
    if (several && std::abs(seen[axis.k]) > 0.2)  // a smaller share of the direction is not named
      words += (words.empty() ? "" : " and ") + std::string(seen[axis.k] > 0 ? axis.plus : axis.minus);
  const std::string axis = axis_text(direction);
  return words + (axis.starts_with('(') ? " " + axis : " (" + axis + ")");
}

std::string lie_words(const Eigen::Vector3d& up, const Eigen::Vector3d& drawn_up) {
  const Eigen::Vector3d seen = upright(drawn_up) * up;
  const char* side = std::abs(seen.z()) > kOneAxis   ? (seen.z() > 0 ? "as drawn" : "upside down")
                     : std::abs(seen.x()) > kOneAxis ? (seen.x() > 0 ? "on its left side" : "on its right side")
                     : std::abs(seen.y()) > kOneAxis ? (seen.y() > 0 ? "on its front" : "on its back")
                                                     : "turned";
  return fmt::format("{} ({} up)", side, axis_text(up));
}

std::string motion_words(const MotionSummary& motion, const std::string& unit, const Eigen::Vector3d& drawn_up,
                         const Eigen::Quaterniond& lies) {
  const std::string of_unit = unit.empty() ? "" : " " + unit;
  std::string out;
  if (motion.stretches.size() > 4 && !is_of_slides(motion)) {
    out = fmt::format("along its path, {}{} in all", figure_text(motion.length), of_unit);
    if (motion.displacement.norm() > 1e-3 * motion.length)
      out += fmt::format(", to a place {}{} {}", figure_text(motion.displacement.norm()), of_unit,
                         direction_words(motion.displacement, drawn_up, lies));
  } else {
    for (const Eigen::Vector3d& stretch : motion.stretches)
      out += fmt::format("{}{}{} {}", out.empty() ? "" : ", then ", figure_text(stretch.norm()), of_unit,
                         direction_words(stretch, drawn_up, lies));
  }
  if (motion.turn * 180 / std::numbers::pi < kTurned) return out.empty() ? "in its place" : out;
  const bool straight = motion.stretches.size() == 1;
  const double along = straight ? motion.axis.dot(motion.stretches.front().normalized()) : 0;
  const std::string turn = turn_words(motion.turn);
  if (std::abs(along) > kOneAxis)
    return out + fmt::format(", turning {} by {}", along > 0 ? "clockwise" : "counter-clockwise", turn);
  const std::string about =
      fmt::format("by {} clockwise about the axis that points {}", turn, direction_words(motion.axis, drawn_up, lies));
  return out.empty() ? "in its place, turning " + about : out + ", turning " + about;
}

}  // namespace dismantle
