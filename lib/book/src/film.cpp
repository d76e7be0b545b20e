// The steps of a plan as an animated GIF.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dismantle/book/book.h"
#include "dismantle/errors.h"
#include "gif.h"
#include "illustrator.h"

namespace dismantle {
namespace {

constexpr int kFrames = 12, kFrameTime = 7, kPause = 60;  // of a step; 1/100 s

/// A bar at the lower edge: how much of the work is done.
void draw_bar(Image& image, double share) {
  const int high = std::max(3, image.height / 110), end = static_cast<int>(std::lround(share * image.width));
  for (int y = image.height - high; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.pixels[static_cast<std::size_t>(y) * image.width + x] = x < end ? 0xff3a6ea5u : 0xffe3e7ecu;
}

/// Pose of a mover at a place of its path: the index of a pose, and the share of the motion to the next one.
Pose pose_at(const BookMover& mover, double place) {
  const std::size_t k = std::min(static_cast<std::size_t>(place), mover.poses.size() - 1);
  const double share = place - static_cast<double>(k);
  return share > 0 && k + 1 < mover.poses.size() ? screw_interpolate(mover.poses[k], mover.poses[k + 1], share)
                                                 : mover.poses[k];
}

/// How far the parts of a step go from one pose to the next, turns included; `size`: of the assembly.
double travel(const BookStep& step, std::size_t from, double size) {
  double sum = 0;
  for (const BookMover& mover : step.movers) {
    const Pose &a = mover.poses[from], &b = mover.poses[from + 1];
    sum += (b * mover.center - a * mover.center).norm() + 0.2 * size * angle_between(a.q, b.q);
  }
  return sum;
}

/// The places of a step's paths to be shown, at even speed: from `furthest` away, or to there.
std::vector<double> shown_places(const BookStep& step, bool disassembly, double furthest, double size) {
  if (step.movers.empty()) return {0};
  const std::size_t last = step.movers.front().poses.size() - 1;
  const double seat = disassembly ? 0 : static_cast<double>(last), open = static_cast<double>(last) - seat;
  const auto far = [&](double place) {
    return std::ranges::any_of(step.movers, [&](const BookMover& m) {
      return (pose_at(m, place) * m.center - pose_at(m, seat) * m.center).norm() >= furthest;
    });
  };
  double away = open;
  for (std::size_t k = 1; k <= last && away == open; ++k)
    if (const double place = std::abs(seat - static_cast<double>(k)); far(place)) {
      double near = std::abs(seat - static_cast<double>(k - 1));
      away = place;
      for (int n = 0; n < 12; ++n) (far(0.5 * (near + away)) ? away : near) = 0.5 * (near + away);
    }
  const double first = std::min(seat, away), end = std::max(seat, away);
  // Length of the way up to each pose, and its inverse.
  std::vector<double> length(last + 1, 0);
  for (std::size_t k = 0; k < last; ++k) length[k + 1] = length[k] + travel(step, k, size);
  const auto length_at = [&](double place) {
    const std::size_t k = std::min(static_cast<std::size_t>(place), last == 0 ? 0 : last - 1);
    return last == 0 ? 0 : length[k] + (place - static_cast<double>(k)) * (length[k + 1] - length[k]);
  };
  const double whole = length_at(end) - length_at(first);
  std::vector<double> out;
  for (int n = 0; n <= kFrames; ++n) {
    const double goal = length_at(first) + whole * n / kFrames;
    const auto after = std::ranges::upper_bound(length, goal);
    const std::size_t k = after == length.begin() ? 0 : static_cast<std::size_t>(after - length.begin()) - 1;
    const double part = k < last && length[k + 1] > length[k] ? (goal - length[k]) / (length[k + 1] - length[k]) : 0;
    out.push_back(std::clamp(static_cast<double>(k) + part, first, end));
  }
  return out;
}

std::vector<PlacedPart> movers_of(const BookStep& step, double place) {
  std::vector<PlacedPart> out;
  for (const BookMover& mover : step.movers)
    for (const std::size_t part : mover.parts) out.push_back({part, pose_at(mover, place)});
  return out;
}

}  // namespace

std::string book_gif(const Plan& plan, const Assembly& assembly, const FilmOptions& options) {
  const Illustrator illustrator(assembly, options.frame.up);
  std::vector<BookStep> steps;
  for (const BookChapter& chapter : instructions(plan, assembly, options.disassembly))
    steps.insert(steps.end(), chapter.steps.begin(), chapter.steps.end());
  if (steps.empty()) throw InputError(plan.assembly.source, "the plan has no steps, so there is nothing to show");
  std::ranges::sort(steps, {}, &BookStep::number);
  const double size = assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff(), furthest = 1.2 * size;

  GifPalette palette;  // of small pictures of all steps
  for (const BookStep& step : steps) {
    const std::vector<double> places = shown_places(step, options.disassembly, furthest, size);
    Image small =
        illustrator.moment(step, movers_of(step, places[places.size() / 2]), {options.width / 3, options.height / 3});
    draw_bar(small, 0.5);
    palette.count(small);
  }
  GifWriter gif(options.width, options.height, palette.colours());
  for (std::size_t s = 0; s < steps.size(); ++s) {
    options.on_step(s + 1, steps.size());
    const std::vector<double> places = shown_places(steps[s], options.disassembly, furthest, size);
    for (std::size_t n = 0; n < places.size(); ++n) {
      Image image = illustrator.moment(steps[s], movers_of(steps[s], places[n]), {options.width, options.height});
      draw_bar(image, (double(s) + double(n + 1) / double(places.size())) / double(steps.size()));
      gif.add(image, n + 1 == places.size() ? kPause : kFrameTime);
    }
  }
  return gif.finish();
}

}  // namespace dismantle
