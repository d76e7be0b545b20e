#include "fastener_memo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dismantle/fasteners/name.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/face_axes.h"
#include "turned_first.h"

namespace dismantle::checks {
namespace {

using fasteners::Drive;
using fasteners::Kind;
using fasteners::Shape;

/// As the assembly says, else by shape and name.
PartKind kind_of(const Part& part, const Shape& shape) {
  if (part.kind) return *part.kind;
  fasteners::NameSays name;
  if (!part.product.empty()) name = fasteners::recognise_name(part.product);
  if (!name.kind) name = fasteners::recognise_name(part.name);
  return fasteners::combined(shape, name);
}

/// A circlip is cut from sheet and is no closed ring: most of its surface is two faces across its axis.
bool lay_circlip(const Mesh& mesh, double mm, tools::Fastener& fastener) {
  std::vector<geometry::FaceAxis> faces;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d normal = geometry::area_vector(mesh, t);
    const double size = normal.norm();
    if (size > 0) faces.push_back({normal / size, size});
    area += size;
  }
  auto axes = geometry::rounded_axes(faces);
  geometry::sort_by_area(axes, 1);
  if (axes.empty() || axes.front().area < 0.4 * area) return false;
  fastener.axis = axes.front().axis.normalized();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const Eigen::Vector3d u = fastener.axis.unitOrthogonal(), v = fastener.axis.cross(u);
  Eigen::Vector2d least = Eigen::Vector2d::Constant(low), most = -least;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    const Eigen::Vector2d flat(u.dot(p), v.dot(p));
    least = least.cwiseMin(flat);
    most = most.cwiseMax(flat);
    low = std::min(low, fastener.axis.dot(p));
    high = std::max(high, fastener.axis.dot(p));
  }
  const Eigen::Vector2d center = (least + most) / 2;
  middle = center.x() * u + center.y() * v;
  fastener.top = middle + high * fastener.axis;
  for (const Eigen::Vector3d& p : mesh.vertices)
    fastener.radius = std::max(fastener.radius, mm * (p - middle).cross(fastener.axis).norm());
  fastener.grip = mm * (high - low);
  fastener.size = 2 * fastener.radius;
  fastener.kind = Kind::ring;
  return true;
}

}  // namespace

FastenerMemo::FastenerMemo(const Assembly& assembly)
    : assembly_(assembly),
      boxes_(geometry::index_of_parts(assembly)),
      mm_(fasteners::millimetres_per_unit(assembly)),
      placements_(geometry::find_congruent(assembly.parts)),
      surface_once_(assembly.parts.size()),
      driven_once_(assembly.parts.size()),
      shape_once_(assembly.parts.size()),
      surfaces_(assembly.parts.size()),
      driven_(assembly.parts.size()),
      shapes_(assembly.parts.size()) {
  for (const Part& part : assembly.parts) meshes_.push_back(part.mesh);
}

bool FastenerMemo::is_of(const Assembly& assembly) const {
  return &assembly == &assembly_ &&
         std::equal(meshes_.begin(), meshes_.end(), assembly.parts.begin(), assembly.parts.end(),
                    [](const std::shared_ptr<const Mesh>& mesh, const Part& part) { return mesh == part.mesh; });
}

const TriangleBvh& FastenerMemo::surface(PartId part) const {
  std::call_once(surface_once_[part], [&] {
    const Part& p = assembly_.parts[part];
    surfaces_[part] =
        std::make_unique<TriangleBvh>(*p.mesh, geometry::Poll{}, p.open ? Surface::open : Surface::closed);
  });
  return *surfaces_[part];
}

const Driven* FastenerMemo::driven(PartId part) const {
  std::call_once(driven_once_[part], [&] { driven_[part] = look_at(assembly_.parts[part]); });
  return driven_[part] ? &*driven_[part] : nullptr;
}

Shape FastenerMemo::shape_of(PartId part) const {
  const auto& [original, pose] = placements_[part];
  std::call_once(shape_once_[original],
                 [&] { shapes_[original] = fasteners::recognise_shape(*assembly_.parts[original].mesh, mm_); });
  Shape shape = shapes_[original];
  shape.axis = pose.q * shape.axis;
  shape.top = pose * shape.top;
  return shape;
}

std::optional<Driven> FastenerMemo::look_at(const Part& part) const {
  const auto among = [](Kind kind) {
    return kind == Kind::screw || kind == Kind::nut || kind == Kind::ring || kind == Kind::pin || kind == Kind::bearing;
  };
  if (part.kind && !among(fasteners::kind_from_string(part.kind->kind).value_or(Kind::other))) return std::nullopt;
  Shape shape = shape_of(part.id);
  const PartKind said = kind_of(part, shape);
  const Kind kind = fasteners::kind_from_string(said.kind).value_or(Kind::other);
  const bool turned = kind == Kind::screw || kind == Kind::nut;
  if (!among(kind) || (part.open && !turned)) return std::nullopt;
  if (kind == Kind::pin || kind == Kind::bearing) return pressed_in(part, shape, said);
  Driven out;
  if (turned && shape.kind != kind && !part.open)
    if (auto form = fasteners::shape_as(kind, *part.mesh, mm_)) {
      shape = std::move(*form);
      out.by_name = true;
    }
  out.part = part.id;
  out.size = said.size;
  tools::Fastener& f = out.fastener;
  f.mm = mm_;
  f.kind = kind;
  if (kind == Kind::ring) {
    const bool open_ring = shape.kind == Kind::other || shape.kind == Kind::plate;
    if (!open_ring || !lay_circlip(*part.mesh, mm_, f)) return std::nullopt;
    out.either_side = true;
    out.height = f.grip;
    find_partners(out, shape);
    return out;
  }
  if (part.open || !(shape.height > 0) || !(shape.radius > 0)) {
    // Where it is tells what it is in; a tool needs its axis, too.
    out.unknown = part.open ? "its surface is not closed" : "it is known by its name only, and its shape has no axis";
    const Eigen::Vector3d size = part.mesh->box().size();
    shape = Shape{};
    shape.top = part.mesh->box().center();
    shape.radius = shape.shank_radius = size.minCoeff() / 2;
    f.top = shape.top;
    find_partners(out, shape);
    return out;
  }
  // The ring inside a lock nut turns with it.
  if (kind == Kind::nut && shape.kind != Kind::nut && shape.drive == Drive::none) return std::nullopt;
  f.top = shape.top;
  f.axis = shape.axis;
  f.drive = shape.drive;
  f.size = shape.drive_size;
  f.radius = shape.radius * mm_;
  f.grip = mm_ * (kind == Kind::nut ? shape.height : shape.head_height);
  const double length = mm_ * shape.height - (kind == Kind::nut ? 0 : f.grip);
  // A thread bears over two diameters at most; before that, a screw is put in by hand.
  f.travel = kind == Kind::nut ? length : std::min(length, 4 * mm_ * shape.shank_radius);
  if (kind == Kind::screw && f.grip == 0) f.travel = std::min(mm_ * shape.height, 4 * mm_ * shape.shank_radius);
  out.either_side = kind == Kind::nut;
  out.height = f.grip;
  find_partners(out, shape);
  return out;
}

/// How far the facets of a round surface are from its circle.
static double sagitta(const Mesh& mesh, const Shape& shape) {
  const auto from_axis = [&](const Eigen::Vector3d& p) { return (p - shape.top).cross(shape.axis).norm(); };
  const auto outer = [&](const Eigen::Vector3d& p) { return from_axis(p) > 0.99 * shape.radius; };
  double out = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = mesh.vertex(t, k), &b = mesh.vertex(t, (k + 1) % 3);
      // Across a face on the end an edge is a chord of any length.
      if (outer(a) && outer(b) && outer(mesh.vertex(t, (k + 2) % 3)) && from_axis((a + b) / 2) > 0.9 * shape.radius)
        out = std::max(out, shape.radius - from_axis((a + b) / 2));
    }
  return out;
}

std::optional<Driven> FastenerMemo::pressed_in(const Part& part, const Shape& shape, const PartKind& said) const {
  if (shape.kind == Kind::other || !(shape.height > 0) || !(shape.radius > 0)) return std::nullopt;
  Driven out;
  out.part = part.id;
  out.size = said.size;
  out.pressed = out.either_side = true;
  tools::Fastener& f = out.fastener;
  f.mm = mm_;
  f.kind = fasteners::kind_from_string(said.kind).value_or(Kind::pin);
  f.radius = shape.radius * mm_;
  f.size = 2 * f.radius;
  f.axis = shape.axis;
  // A tool that lies on its end does not touch what is flush with it.
  const double clear = 0.01 * shape.radius;
  f.top = shape.top + clear * f.axis;
  out.height = mm_ * (shape.height + 2 * clear);
  f.travel = mm_ * shape.height;
  const double facets = 2 * sagitta(*part.mesh, shape);  // of both parts
  for (const InitialOverlap& o : assembly_.overlaps) {
    if (o.a != part.id && o.b != part.id) continue;
    if (!o.place || o.place->contact != ContactClass::uniform_interference || !o.place->axis) continue;
    if (std::abs(o.place->axis->normalized().dot(shape.axis)) < 0.99) continue;
    out.partners.push_back(o.a == part.id ? o.b : o.a);
    out.sure = out.sure && o.depth > facets;
  }
  if (out.partners.empty()) return std::nullopt;
  return out;
}

void FastenerMemo::find_partners(Driven& driven, const Shape& shape) const {
  const tools::Fastener& f = driven.fastener;
  const double height = f.kind == Kind::ring ? f.grip / mm_ : shape.height;
  const double radius = f.kind == Kind::ring ? f.radius / mm_ : shape.shank_radius;
  const Eigen::Vector3d at = f.top - (f.kind == Kind::screw ? 0.85 : 0.5) * height * f.axis;
  std::vector<std::pair<double, PartId>> near;
  const double limit = 1.5 * radius;
  Aabb around{at, at};
  around.inflate(limit);
  for (const std::size_t id : boxes_.overlapping(around)) {
    const Part& part = assembly_.parts[id];
    if (part.id == driven.part || boxes_.box(id).squared_distance(at) > limit * limit) continue;
    const TriangleBvh& other = surface(part.id);
    // What is in a hole is nearer than what is around it.
    const double distance =
        f.kind != Kind::screw && !part.open && other.inside(at) ? 0 : other.closest(at, limit).distance;
    if (f.kind != Kind::screw && distance > 0.9 * radius) continue;
    if (distance <= limit) near.emplace_back(distance, part.id);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [distance, part] : near) driven.partners.push_back(part);
}

tools::Fastener FastenerMemo::driven_by(const Driven& driven, std::optional<PartId> partner, bool flipped) const {
  tools::Fastener f = driven.fastener;
  if (flipped) {
    f.top -= driven.height / mm_ * f.axis;
    f.axis = -f.axis;
  }
  if (!partner || f.kind != Kind::nut) return f;
  double high = 0;
  for (const Eigen::Vector3d& p : assembly_.parts[*partner].mesh->vertices) {
    const Eigen::Vector3d from = p - f.top;
    if (mm_ * from.cross(f.axis).norm() < 0.7 * f.radius) high = std::max(high, mm_ * from.dot(f.axis));
  }
  f.travel = std::max(f.travel, high);
  return f;
}

void FastenerMemo::find_fastenings() const {
  std::call_once(fastenings_once_, [&] {
    const std::size_t parts = assembly_.parts.size();
    const RunContext context;
    const auto shapes = fasteners::fastener_shapes(assembly_, context);
    fastenings_ = fasteners::fastenings_of(
        assembly_, shapes, [&](PartId id) -> const TriangleBvh& { return surface(id); }, context);
    patterns_ = fasteners::patterns_of(assembly_, fastenings_, shapes);
    fastening_of_.resize(parts);
    pattern_of_.resize(parts);
    for (std::size_t i = 0; i < patterns_.size(); ++i)
      for (const PartId screw : patterns_[i].screws) pattern_of_[screw] = i;
    screw_in_.resize(parts);
    nut_of_.resize(parts);
    for (std::size_t i = 0; i < fastenings_.size(); ++i) {
      const fasteners::Fastening& f = fastenings_[i];
      fastening_of_[f.screw] = i;
      if (!f.nut) continue;
      for (const PartId part : f.into) {
        const Driven* nut = driven(part);
        if (nut == nullptr || nut->fastener.kind != Kind::nut) continue;
        if (nut->fastener.drive == Drive::none && !nut->by_name) continue;  // it is in a slot
        if (!nut_of_[f.screw]) nut_of_[f.screw] = part;
        if (!screw_in_[part]) screw_in_[part] = f.screw;
      }
    }
  });
}

const fasteners::Fastening* FastenerMemo::fastening_of(PartId screw) const {
  find_fastenings();
  return fastening_of_[screw] ? &fastenings_[*fastening_of_[screw]] : nullptr;
}

const fasteners::Pattern* FastenerMemo::pattern_of(PartId screw) const {
  find_fastenings();
  return pattern_of_[screw] ? &patterns_[*pattern_of_[screw]] : nullptr;
}

std::optional<PartId> FastenerMemo::screw_in(PartId nut) const {
  find_fastenings();
  return screw_in_[nut];
}

std::optional<PartId> FastenerMemo::nut_of(PartId screw) const {
  find_fastenings();
  return nut_of_[screw];
}

std::optional<PartId> FastenerMemo::kept_by(const Driven& driven, std::span<const PlacedPart> there,
                                            const Pose& at) const {
  const tools::Fastener& f = driven.fastener;
  const bool corners =
      f.drive == Drive::outer_hex || f.drive == Drive::square || (f.kind == Kind::nut && driven.by_name);
  if (!corners) return std::nullopt;
  const Eigen::Vector3d u = f.axis.unitOrthogonal(), v = f.axis.cross(u);
  constexpr int angles = 36;  // the corners go round on this circle
  const double radius = 0.985 * f.radius / mm_;
  const Eigen::Vector3d middle = f.top - 0.5 * f.grip / mm_ * f.axis;
  const double reach = 1.001 * std::hypot(radius, 0.3 * f.grip / mm_);  // of the points below
  for (const PlacedPart& part : there) {
    if (part.part == driven.part || assembly_.parts[part.part].open) continue;
    const Pose to = part.pose.inverse() * at;
    if (boxes_.box(part.part).squared_distance(to * middle) > reach * reach || driven_by_thread(part.part)) continue;
    for (const double share : {0.2, 0.5, 0.8})
      for (int k = 0; k < angles; ++k) {
        const double angle = 2 * std::numbers::pi * k / angles;
        const Eigen::Vector3d p =
            f.top - share * f.grip / mm_ * f.axis + radius * (std::cos(angle) * u + std::sin(angle) * v);
        if (surface(part.part).inside(to * p)) return part.part;
      }
  }
  return std::nullopt;
}

bool FastenerMemo::driven_by_thread(PartId part) const {
  const Driven* other = driven(part);
  return other != nullptr && (other->fastener.kind == Kind::screw || other->fastener.kind == Kind::nut);
}

BlockedBy FastenerMemo::blocked(const Driven& driven, const tools::Fastener& fastener, bool flipped,
                                const tools::Use& use, std::size_t place, std::span<const PlacedPart> there,
                                const Pose& pose, bool hand) const {
  std::shared_ptr<Row> row;
  {
    const std::lock_guard lock(mutex_);
    auto& known = rows_[{driven.part, flipped, fastener.travel, place, hand}];
    if (!known) known = std::make_shared<Row>(assembly_.parts.size());
    row = known;
  }
  BlockedBy out;
  out.kept_ = row;
  out.moved_.resize(there.size());
  const Pose back = pose.inverse();
  for (std::size_t i = 0; i < there.size(); ++i) {
    const PartId part = there[i].part;
    const bool closed = !assembly_.parts[part].open;
    const bool in_place = there[i].pose == pose || (back * there[i].pose).is_identity(1e-12);
    if (in_place)
      std::call_once(row->once[part], [&] {
        row->arcs[part] = tools::blocked_angles(use, fastener, {&surface(part), closed}, hand);
      });
    else
      out.moved_[i] = tools::blocked_angles(use, fastener, {&surface(part), closed, back * there[i].pose}, hand);
    out.arcs_.push_back(in_place ? &row->arcs[part] : &out.moved_[i]);
  }
  return out;
}

std::span<const tools::Arcs> FastenerMemo::turned(const Driven& driven, const tools::Fastener& fastener, bool flipped,
                                                  const tools::Use& use, std::size_t place, PartId part,
                                                  bool hand) const {
  const std::lock_guard lock(mutex_);
  const auto [it, fresh] = turned_.try_emplace({{driven.part, flipped, fastener.travel, place, hand}, part});
  if (!fresh) return it->second;
  if (const auto axis = turning_axis(*assembly_.parts[part].mesh))
    for (int k = 1; k < 36; ++k) {
      const Pose pose = turned_about(*axis, k * std::numbers::pi / 18);
      it->second.push_back(
          tools::blocked_angles(use, fastener, {&surface(part), !assembly_.parts[part].open, pose}, hand));
    }
  return it->second;
}

tools::Access FastenerMemo::room(const tools::Fastener& fastener, const tools::Use& use, const BlockedBy& blocked,
                                 std::span<const PlacedPart> there, const Pose& pose) {
  tools::Access access = tools::room_for(use, fastener, blocked.arcs());
  access.handle = pose.q * access.handle;
  for (std::size_t& index : access.obstacles) index = there[index].part;
  return access;
}

}  // namespace dismantle::checks
