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

/// The poses of a step to be shown, as indices into those of each mover: from `furthest` away, or to there.
std::vector<std::vector<std::size_t>> shown_poses(const BookStep& step, bool disassembly, double furthest) {
  std::vector<std::vector<std::size_t>> out(kFrames + 1);
  for (const BookMover& mover : step.movers) {
    const std::size_t last = mover.poses.size() - 1, place = disassembly ? 0 : last;
    std::size_t away = disassembly ? last : 0;
    for (std::size_t k = 0; k <= last; ++k) {
      const std::size_t at = disassembly ? k : last - k;
      if ((mover.poses[at] * mover.center - mover.poses[place] * mover.center).norm() < furthest) continue;
      away = at;
      break;
    }
    const double from = double(disassembly ? place : away), to = double(disassembly ? away : place);
    for (int n = 0; n <= kFrames; ++n)
      out[static_cast<std::size_t>(n)].push_back(
          static_cast<std::size_t>(std::lround(from + (to - from) * n / kFrames)));
  }
  return out;
}

std::vector<PlacedPart> movers_of(const BookStep& step, const std::vector<std::size_t>& poses) {
  std::vector<PlacedPart> out;
  for (std::size_t m = 0; m < step.movers.size(); ++m)
    for (const std::size_t part : step.movers[m].parts) out.push_back({part, step.movers[m].poses[poses[m]]});
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
  const double furthest = 1.2 * (assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff());

  GifPalette palette;  // of small pictures of all steps
  for (const BookStep& step : steps) {
    const auto poses = shown_poses(step, options.disassembly, furthest);
    Image small =
        illustrator.moment(step, movers_of(step, poses[kFrames / 2]), {options.width / 3, options.height / 3});
    draw_bar(small, 0.5);
    palette.count(small);
  }
  GifWriter gif(options.width, options.height, palette.colours());
  for (std::size_t s = 0; s < steps.size(); ++s) {
    options.on_step(s + 1, steps.size());
    const auto poses = shown_poses(steps[s], options.disassembly, furthest);
    for (std::size_t n = 0; n < poses.size(); ++n) {
      if (n > 0 && poses[n] == poses[n - 1]) continue;
      Image image = illustrator.moment(steps[s], movers_of(steps[s], poses[n]), {options.width, options.height});
      draw_bar(image, (double(s) + double(n) / kFrames) / double(steps.size()));
      gif.add(image, n + 1 == poses.size() ? kPause : kFrameTime);
    }
  }
  return gif.finish();
}

}  // namespace dismantle
