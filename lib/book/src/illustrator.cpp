#include "illustrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "dismantle/plan_io/explode.h"

namespace dismantle {
namespace {

/// Paler colour for parts that do not move, so that moving parts stand out.
Eigen::Vector3f pale(const Eigen::Vector3f& c) { return 0.55f * c + Eigen::Vector3f::Constant(0.45f); }

/// Lets the drawing vanish towards the rim: it goes on there. `share` of the height.
void fade_out(Image& image, double share) {
  const double rim = share * image.height;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double d = (0.5 + std::min({x, y, image.width - 1 - x, image.height - 1 - y})) / rim;
      if (d >= 1) continue;
      std::uint32_t& p = image.pixels[static_cast<std::size_t>(y) * image.width + x];
      std::uint32_t faded = 0;
      for (int shift = 0; shift < 32; shift += 8)  // premultiplied: all channels alike
        faded |= static_cast<std::uint32_t>(std::lround(d * d * (3 - 2 * d) * ((p >> shift) & 255u))) << shift;
      p = faded;
    }
}

}  // namespace

std::string Viewpoint::words() const {
  return std::string("from the ") + (back ? "back " : "front ") + (left ? "left" : "right") +
         (below ? ", from below" : "");
}

Illustrator::Illustrator(const Assembly& assembly, const Eigen::Vector3d& up)
    : assembly_(assembly), placements_(geometry::find_congruent(assembly.parts)) {
  frame_.up = up;
  std::set<std::array<int, 3>> different;
  for (const Part& part : assembly.parts)
    if (part.colour) different.insert({part.colour->r, part.colour->g, part.colour->b});
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    const Part& part = assembly.parts[i];
    centers_.push_back(assembly.normalization.to_input(part.mesh->box().center()));
    meshes_.emplace_back();
    if (placements_[i].original == i) {
      Mesh local = *part.mesh;
      for (auto& v : local.vertices) v = assembly.normalization.to_input(v) - centers_[i];
      meshes_.back() = shade(local);
    }
    // If all parts have the same colour, the CAD program has probably not assigned any.
    Eigen::Vector3f colour(0.62f, 0.68f, 0.75f);
    if (part.colour && different.size() > 1)
      colour = Eigen::Vector3f(part.colour->r, part.colour->g, part.colour->b) / 255.0f;
    colours_.push_back(0.8f * colour + Eigen::Vector3f::Constant(0.14f));  // keeps edges visible on black parts
  }
}

DrawnBody Illustrator::body_of(const PlacedPart& placed, bool marked) const {
  const geometry::ShapePlacement& placement = placements_[placed.part];
  const Pose shape = assembly_.normalization.pose_to_input(placement.pose);
  const Pose local{centers_[placement.original], Eigen::Quaterniond::Identity()};
  return {&meshes_[placement.original], placed.pose * shape * local,
          marked ? style_.accent : pale(colours_[placed.part]), marked};
}

Eigen::Matrix3d Illustrator::axes_of(const Viewpoint& view, const Eigen::Quaterniond& lies) const {
  // Z up, seen from -Y; then turned for input with another direction up.
  const Eigen::Vector3d viewer =
      Eigen::Vector3d(view.left ? -0.62 : 0.62, view.back ? 0.78 : -0.78, view.below ? -0.62 : 0.62).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(viewer).normalized();
  Eigen::Matrix3d axes;
  axes << right.transpose(), viewer.cross(right).transpose(), viewer.transpose();
  return axes * (upright(frame_.up) * lies).toRotationMatrix();
}

std::vector<Eigen::Vector3d> Illustrator::corners(const std::vector<PlacedPart>& parts) const {
  std::vector<Eigen::Vector3d> out;
  for (const PlacedPart& placed : parts) {
    const DrawnBody body = body_of(placed, false);
    for (const auto& v : body.mesh->positions) out.push_back(body.pose * v.cast<double>());
  }
  return out;
}

Camera Illustrator::camera_for(const std::vector<Eigen::Vector3d>& points, const Eigen::Matrix3d& axes, int width,
                               int height) const {
  Aabb box;
  for (const auto& p : points) box.extend(axes * p);
  Camera out;
  out.axes = axes;
  if (box.empty()) return out;
  out.target = axes.transpose() * box.center();
  const Eigen::Vector3d size = style_.margin * box.size().cwiseMax(1e-9 * box.size().maxCoeff() + 1e-300);
  out.scale = std::min(width / size.x(), height / size.y());
  return out;
}

Picture Illustrator::scene(const std::vector<PlacedPart>& parts, const PictureSize& size,
                           const PartNumbers& numbers) const {
  std::vector<DrawnBody> bodies;
  for (const PlacedPart& placed : parts) {
    bodies.push_back(body_of(placed, false));
    bodies.back().colour = colours_[placed.part];
  }
  const Camera camera = camera_for(corners(parts), axes_of({}), size.width, size.height);
  Picture out{draw(bodies, camera, size.width, size.height, style_.lines), {}, {}};
  if (!numbers.empty()) {
    std::vector<std::size_t> all;
    for (const PlacedPart& placed : parts) all.push_back(placed.part);
    number_parts(out, bodies, all, camera, numbers, {});
  }
  return out;
}

void Illustrator::number_parts(Picture& picture, const std::vector<DrawnBody>& bodies,
                               const std::vector<std::size_t>& parts, const Camera& camera, const PartNumbers& numbers,
                               const std::vector<std::size_t>& held) const {
  const Image& image = picture.image;
  const std::vector<Sight> seen = sights(bodies, camera, image.width, image.height);
  // One circle for all parts of a number, at the one that is seen best.
  std::map<std::pair<bool, std::size_t>, std::size_t> best;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const std::size_t number = numbers[parts[b]];
    if (number == 0 || seen[b].pixels < 12) continue;
    const bool hold = std::ranges::find(held, parts[b]) != held.end();
    const auto [it, fresh] = best.try_emplace({hold, number}, b);
    if (!fresh && seen[b].pixels > seen[it->second].pixels) it->second = b;
  }
  std::vector<Balloon> wanted;
  for (const auto& [key, b] : best) wanted.push_back({key.second, seen[b].at, seen[b].at, key.first});
  if (wanted.size() <= style_.most_balloons) picture.balloons = placed_balloons(std::move(wanted), image);
}

void Illustrator::ring_specks(Picture& picture, const std::vector<PlacedPart>& parts, const Camera& camera) const {
  const int width = picture.image.width, height = picture.image.height;
  Aabb box;
  for (const auto& p : corners(parts)) box.extend(camera.project(p, width, height));
  const double radius = box.empty() ? 0 : 0.5 * box.size().head<2>().norm();
  if (radius > 0 && 2 * radius < style_.speck * width)
    picture.rings.emplace_back(box.center().head<2>(), radius + 0.02 * width);
}

std::vector<PlacedPart> Illustrator::movers_at(const BookStep& step,
                                               const std::vector<std::size_t>& pose_indices) const {
  std::vector<PlacedPart> out;
  for (std::size_t m = 0; m < step.movers.size(); ++m)
    for (const std::size_t part : step.movers[m].parts) out.push_back({part, step.movers[m].poses[pose_indices[m]]});
  return out;
}

Eigen::Vector3d Illustrator::stretch(const BookMover& mover, std::size_t away, std::size_t place, double extent) const {
  const Eigen::Vector3d from = mover.poses[place] * mover.center, to = mover.poses[away] * mover.center;
  const double distance = (to - from).norm();
  if (distance >= style_.nearest * extent || !(distance > 1e-6 * extent)) return Eigen::Vector3d::Zero();
  return (style_.nearest * extent / distance - 1) * (to - from);
}

Viewpoint Illustrator::best_view(const BookStep& step, const std::vector<PlacedPart>& away,
                                 const std::vector<PlacedPart>& placed) const {
  const auto [width, height] = style_.view_test;
  const auto seen = [&, width = width, height = height](const std::vector<PlacedPart>& movers, const Viewpoint& view) {
    std::vector<DrawnBody> bodies, alone;
    std::vector<PlacedPart> all = step.standing;
    all.insert(all.end(), movers.begin(), movers.end());
    for (const PlacedPart& p : step.standing) bodies.push_back(body_of(p, false));
    for (const PlacedPart& p : movers) bodies.push_back(body_of(p, true));
    for (const PlacedPart& p : movers) alone.push_back(body_of(p, true));
    // Zoom in on the moving parts: in a picture of the whole assembly, a screw is smaller than a pixel.
    const Camera camera = camera_for(corners(movers), axes_of(view, frame_.lies(step.up)), width, height);
    const std::size_t whole = visible_pixels(alone, camera, width, height);
    return whole == 0 ? 0.0 : double(visible_pixels(bodies, camera, width, height)) / double(whole);
  };
  Viewpoint best;
  double most = 0;
  for (const bool below : {false, true})
    for (const bool back : {false, true})
      for (const bool left : {false, true}) {
        const Viewpoint view{left, back, below};
        const double score = seen(placed, view) + 0.7 * seen(away, view);
        if (view.usual() || score > style_.better_view * most) {
          best = view;
          most = std::max(score, 0.05);
        }
      }
  return best;
}

/// The poses of a step that show each mover in its place and away from it.
struct Illustrator::Arrangement {
  std::vector<std::size_t> at_place, at_away;  // by mover: index of its pose
  std::vector<Eigen::Vector3d> further;        // by mover: how far it is drawn beyond its pose
  std::vector<PlacedPart> placed, away;
  Eigen::Matrix3d axes;
};

double Illustrator::extent_of(const BookStep& step, bool disassembly) const {
  Aabb all;
  for (const auto& v : corners(step.standing)) all.extend(v);
  for (const BookMover& mover : step.movers)
    for (const std::size_t part : mover.parts)
      for (const auto& v : corners({{part, disassembly ? mover.poses.front() : mover.poses.back()}})) all.extend(v);
  return all.empty() ? 0 : all.size().norm();
}

/// Equal parts that move alike are drawn equally far from their places.
void Illustrator::align(const BookStep& step, Arrangement& arrangement) {
  std::vector<Eigen::Vector3d> away;
  double furthest = 0;
  for (std::size_t m = 0; m < step.movers.size(); ++m) {
    const BookMover& mover = step.movers[m];
    const auto at = [&](std::size_t pose) -> Eigen::Vector3d { return mover.poses[pose] * mover.center; };
    away.push_back(at(arrangement.at_away[m]) - at(arrangement.at_place[m]) + arrangement.further[m]);
    furthest = std::max(furthest, away.back().norm());
  }
  for (std::size_t m = 0; m < away.size(); ++m)
    if (const double d = away[m].norm(); d > 0) arrangement.further[m] += (furthest / d - 1) * away[m];
}

/// Away are the ends of the paths, unless a path is long.
Illustrator::Arrangement Illustrator::arranged(const BookStep& step, bool disassembly) const {
  Arrangement out;
  const double extent = extent_of(step, disassembly);
  for (const BookMover& mover : step.movers) {
    const std::size_t last = mover.poses.size() - 1, place = disassembly ? 0 : last;
    std::size_t away = disassembly ? last : 0;
    const Eigen::Vector3d goal = mover.poses[place] * mover.center;
    for (std::size_t k = 0; k <= last; ++k) {  // from its place along the path
      const std::size_t at = disassembly ? k : last - k;
      if ((mover.poses[at] * mover.center - goal).norm() < style_.furthest * extent) continue;
      away = at;
      break;
    }
    out.at_place.push_back(place);
    out.at_away.push_back(away);
    out.further.push_back(stretch(mover, away, place, extent));
  }
  if (!step.joined.empty()) align(step, out);
  out.placed = movers_at(step, out.at_place);
  out.away = movers_at(step, out.at_away);
  for (std::size_t m = 0, p = 0; m < step.movers.size(); ++m)
    for (std::size_t k = 0; k < step.movers[m].parts.size(); ++k) out.away[p++].pose.t += out.further[m];
  return out;
}

std::vector<DrawnBody> Illustrator::bodies_with(const BookStep& step, const std::vector<PlacedPart>& movers) const {
  std::vector<DrawnBody> bodies;
  for (const PlacedPart& p : step.standing) bodies.push_back(body_of(p, false));
  for (const PlacedPart& p : movers) bodies.push_back(body_of(p, true));
  return bodies;
}

StepPictures Illustrator::step(const BookStep& step, bool disassembly, double scale, const PartNumbers& numbers,
                               const std::vector<std::size_t>& held) const {
  const auto scaled = [scale](const PictureSize& size) {
    return PictureSize{static_cast<int>(scale * size.width), static_cast<int>(scale * size.height)};
  };
  Arrangement arrangement = arranged(step, disassembly);
  StepPictures out;
  out.stretched = std::any_of(arrangement.further.begin(), arrangement.further.end(),
                              [](const Eigen::Vector3d& v) { return !v.isZero(0); });
  out.view = best_view(step, arrangement.away, arrangement.placed);
  arrangement.axes = axes_of(out.view, frame_.lies(step.up));
  out.apart = draw_apart(step, arrangement, disassembly, scaled(style_.step), numbers, held);
  out.placed = draw_placed(step, arrangement, scaled(style_.placed));
  return out;
}

/// Shows all parts. Zooms in if the moving parts would be too small.
Picture Illustrator::draw_apart(const BookStep& step, const Arrangement& arrangement, bool disassembly,
                                const PictureSize& size, const PartNumbers& numbers,
                                const std::vector<std::size_t>& held) const {
  std::vector<Eigen::Vector3d> moving = corners(arrangement.away), all = corners(step.standing);
  const auto there = corners(arrangement.placed);
  moving.insert(moving.end(), there.begin(), there.end());
  all.insert(all.end(), moving.begin(), moving.end());
  Camera camera = camera_for(all, arrangement.axes, size.width, size.height);
  const Camera near = camera_for(moving, arrangement.axes, size.width, size.height);
  const bool zoomed = camera.scale < style_.smallest * near.scale;
  if (zoomed) {
    camera = near;
    camera.scale *= 2 * style_.smallest;
  }
  const std::vector<DrawnBody> bodies = bodies_with(step, arrangement.away);
  Picture out;
  out.image = draw(bodies, camera, size.width, size.height, style_.lines);
  if (zoomed) fade_out(out.image, style_.fade);
  if (!numbers.empty()) {
    std::vector<std::size_t> parts;
    PartNumbers shown(numbers.size(), 0);
    for (const PlacedPart& p : step.standing) parts.push_back(p.part);
    for (const PlacedPart& p : arrangement.away) {
      parts.push_back(p.part);
      shown[p.part] = numbers[p.part];
    }
    for (const std::size_t part : held) shown[part] = numbers[part];
    number_parts(out, bodies, parts, camera, shown, held);
  }
  for (std::size_t m = 0; m < step.movers.size(); ++m) {
    const BookMover& mover = step.movers[m];
    const auto [from, to] = std::minmax(arrangement.at_away[m], arrangement.at_place[m]);
    const auto shown_at = [&](const Eigen::Vector3d& p) {
      return Eigen::Vector2d(camera.project(p, size.width, size.height).head<2>());
    };
    std::vector<Eigen::Vector2d> line;
    for (std::size_t k = from; k <= to; ++k) line.push_back(shown_at(mover.poses[k] * mover.center));
    const Eigen::Vector3d end = mover.poses[arrangement.at_away[m]] * mover.center + arrangement.further[m];
    line.insert(disassembly ? line.end() : line.begin(), shown_at(end));
    out.arrows.push_back(std::move(line));
  }
  ring_specks(out, arrangement.away, camera);
  return out;
}

/// With the tools.
Picture Illustrator::draw_placed(const BookStep& step, const Arrangement& arrangement, const PictureSize& size) const {
  std::vector<Eigen::Vector3d> whole = corners(step.standing);
  const auto there = corners(arrangement.placed);
  whole.insert(whole.end(), there.begin(), there.end());
  std::vector<DrawnBody> bodies = bodies_with(step, arrangement.placed);
  std::vector<ShadedMesh> tools;
  tools.reserve(step.tools.size());  // bodies point to them
  for (const DrawnTool& tool : step.tools) {
    Mesh solid = mesh_of(tool, tool.tool);
    whole.insert(whole.end(), solid.vertices.begin(), solid.vertices.end());
    for (auto& v : solid.vertices) v -= tool.origin;
    tools.push_back(shade(solid));
    bodies.push_back({&tools.back(), {tool.origin, Eigen::Quaterniond::Identity()}, style_.tool, false});
  }
  const Camera camera = camera_for(whole, arrangement.axes, size.width, size.height);
  Picture out;
  out.image = draw(bodies, camera, size.width, size.height, style_.lines);
  ring_specks(out, arrangement.placed, camera);
  return out;
}

Image Illustrator::moment(const BookStep& step, const std::vector<PlacedPart>& movers, const PictureSize& size) const {
  std::vector<Eigen::Vector3d> whole;  // the same camera in all steps
  const Aabb& box = assembly_.input_box;
  for (int c = 0; c < 8; ++c)
    whole.emplace_back((c & 1) ? box.hi.x() : box.lo.x(), (c & 2) ? box.hi.y() : box.lo.y(),
                       (c & 4) ? box.hi.z() : box.lo.z());
  Camera camera = camera_for(whole, axes_of({}, frame_.lies(step.up)), size.width, size.height);
  camera.scale *= style_.film;
  return draw(bodies_with(step, movers), camera, size.width, size.height, style_.lines);
}

std::string caption_of(const StepPictures& pictures, const BookWords& words) {
  std::string out;
  if (!pictures.view.usual())
    out = fmt::format(fmt::runtime(words.label("seen {}")), words.text(pictures.view.words()));
  if (pictures.stretched) out += (out.empty() ? "" : "; ") + words.label("drawn further apart than needed");
  return out;
}

BookPictures front_pictures(const Plan& plan, const Assembly& assembly, const Illustrator& illustrator,
                            const PartNumbers& numbers) {
  const std::vector<Eigen::Vector3d> offsets = exploded_offsets(plan, assembly);
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) index_of.emplace(assembly.parts[i].name, i);
  std::vector<PlacedPart> whole, exploded;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::size_t part = index_of.at(plan.assembly.parts[i].name);
    whole.push_back({part, Pose{}});
    exploded.push_back({part, {offsets[i], Eigen::Quaterniond::Identity()}});
  }
  const PictureSize& size = illustrator.style().front;
  return {illustrator.scene(whole, size), illustrator.scene(exploded, size, numbers)};
}

}  // namespace dismantle
