#include "dismantle/statics/built.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bonds.h"
#include "dismantle/geometry/disjoint_sets.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/geometry/swept_boxes.h"

namespace dismantle::statics {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kSamePose = 1e-9;         // of the size of the assembly, and in radians
constexpr std::size_t kMostKept = 100000;  // lists of contacts
constexpr double kPlay = 10;               // Gaps::play
constexpr double kSeat = 0.3;              // cosine: a contact that stops a motion; otherwise it lies along it
constexpr double kAlmostNoWeight = 1e-6;   // kg, of a part without a volume

/// How a lies to b.
Pose relative(const PlacedPart& a, const PlacedPart& b) { return b.pose.inverse() * a.pose; }

void move_by(const Pose& pose, Contact& c) {
  c.normal = pose.q * c.normal;
  for (Vec3& p : c.points) p = pose * p;
}

/// What bonds depend on.
std::pair<std::string, std::string> kind_of(const Part& part) {
  return part.kind ? std::pair(part.kind->kind, part.kind->size) : std::pair<std::string, std::string>();
}

}  // namespace

BuiltPiles::BuiltPiles(const Assembly& assembly, StabilityOptions options)
    : options_(std::move(options)), shape_once_(assembly.parts.size()) {
  const std::size_t count = assembly.parts.size();
  options_.fixed.resize(count, false);
  options_.mass.resize(count);
  if (options_.density.empty())
    for (const Part& p : assembly.parts) options_.density.push_back(p.density.value_or(1));
  newton_ = 1000 * std::pow(metres_in(assembly.unit.empty() ? "mm" : assembly.unit) / assembly.normalization.scale, 3) *
            kGravity;
  Aabb all;
  for (const Part& p : assembly.parts) {
    meshes_.push_back(p.mesh);
    volumes_.push_back(p.volume);
    kinds_.push_back(kind_of(p));
    units_.push_back(p.unit);
    boxes_.push_back(p.mesh->box());
    all.extend(boxes_.back());
  }
  size_ = count == 0 ? 1 : all.size().norm();
  shapes_.resize(count);
  find_neighbours(assembly);
}

/// Pairs whose boxes are near, by a sweep along the first axis, and those of one unit.
void BuiltPiles::find_neighbours(const Assembly& assembly) {
  const auto count = static_cast<PartId>(meshes_.size());
  neighbours_.resize(count);
  const Bonds bonds(assembly);
  clamped_ = bonds.clamped();
  clamped_of_.resize(count);
  for (std::size_t k = 0; k < clamped_.size(); ++k)
    for (const PartId part : clamped_[k]) clamped_of_[part].push_back(k);
  std::vector<double> sizes;
  std::vector<std::pair<double, PartId>> begins;
  std::map<PartId, std::vector<PartId>> of_unit;
  for (PartId p = 0; p < count; ++p) {
    sizes.push_back(boxes_[p].size().norm());
    // No pair is near beyond the gap for the larger of the two, which each part may be.
    begins.emplace_back(boxes_[p].lo.x() - kPlay * options_.touching * sizes[p], p);
    if (units_[p]) of_unit[*units_[p]].push_back(p);
  }
  std::sort(begins.begin(), begins.end());
  std::vector<std::pair<PartId, PartId>> pairs;
  std::vector<PartId> open;  // that end beyond where the sweep is
  for (const auto& [begin, a] : begins) {
    std::erase_if(open,
                  [&, at = begin](PartId b) { return boxes_[b].hi.x() + kPlay * options_.touching * sizes[b] < at; });
    for (const PartId b : open) {
      Aabb near = boxes_[std::min(a, b)];
      near.inflate(kPlay * options_.touching * std::min(sizes[a], sizes[b]));
      if (near.overlaps(boxes_[std::max(a, b)])) pairs.emplace_back(std::min(a, b), std::max(a, b));
    }
    open.push_back(a);
  }
  for (const auto& [unit, members] : of_unit)
    for (std::size_t i = 0; i < members.size(); ++i)
      for (std::size_t j = i + 1; j < members.size(); ++j) pairs.emplace_back(members[i], members[j]);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [a, b] : pairs) {
    const double gap = kPlay * options_.touching * std::min(sizes[a], sizes[b]);
    std::optional<double> bond = bonds.depth(a, b, gap / (2 * kPlay));
    if (one_unit(a, b) && !bond) bond = 0;
    neighbours_[a].push_back({b, bond});
    neighbours_[b].push_back({a, bond});
  }
}

BuiltPiles::~BuiltPiles() = default;

bool BuiltPiles::is_of(const Assembly& assembly) const {
  return std::equal(meshes_.begin(), meshes_.end(), assembly.parts.begin(), assembly.parts.end(),
                    [](const auto& mesh, const Part& p) { return mesh == p.mesh; }) &&
         std::equal(kinds_.begin(), kinds_.end(), assembly.parts.begin(), assembly.parts.end(),
                    [](const auto& kind, const Part& p) {
                      return p.kind ? kind.first == p.kind->kind && kind.second == p.kind->size : kind.first.empty();
                    }) &&
         std::equal(units_.begin(), units_.end(), assembly.parts.begin(), assembly.parts.end(),
                    [](const auto& unit, const Part& p) { return unit == p.unit; });
}

bool BuiltPiles::one_unit(PartId a, PartId b) const { return units_[a] && units_[a] == units_[b]; }

const Shape& BuiltPiles::shape(PartId part) const {
  std::call_once(shape_once_[part], [&] { shapes_[part] = std::make_unique<const Shape>(*meshes_[part]); });
  return *shapes_[part];
}

double BuiltPiles::height(const PlacedPart& part, const Vec3& up) const {
  const Vec3 own = part.pose.q.conjugate() * up;
  int axis = 0;
  if (own.cwiseAbs().maxCoeff(&axis) > 1 - 1e-15) {
    const Aabb& box = boxes_[part.part];
    return up.dot(part.pose.t) + (own[axis] > 0 ? box.lo[axis] : -box.hi[axis]);
  }
  return lowest({&shape(part.part), part.pose}, up);
}

Body BuiltPiles::body(const PlacedPart& part) const {
  const Shape& s = shape(part.part);
  double weight = options_.density[part.part] * newton_ * (s.volume() > 0 ? s.volume() : volumes_[part.part]);
  if (options_.mass[part.part]) weight = *options_.mass[part.part] * kGravity;
  if (!(weight > 0)) weight = kAlmostNoWeight * kGravity;
  return {weight, part.pose * s.center(), s.radius(), static_cast<bool>(options_.fixed[part.part])};
}

const BuiltPiles::Neighbour* BuiltPiles::neighbour(PartId a, PartId b) const {
  const auto& near = neighbours_[a];
  const auto at =
      std::lower_bound(near.begin(), near.end(), b, [](const Neighbour& n, PartId id) { return n.part < id; });
  return at != near.end() && at->part == b ? &*at : nullptr;
}

bool BuiltPiles::bonded(PartId a, PartId b) const {
  const Neighbour* near = neighbour(a, b);
  return near != nullptr && near->bond;
}

bool BuiltPiles::in_place(const PlacedPart& a, const PlacedPart& b) const {
  const Pose to_b = relative(a, b);
  return to_b.t.norm() <= kSamePose * size_ && to_b.q.vec().norm() <= kSamePose;
}

std::vector<const PlacedPart*> BuiltPiles::places(std::span<const PlacedPart> parts) const {
  std::vector<const PlacedPart*> there(meshes_.size(), nullptr);
  for (const PlacedPart& p : parts) there[p.part] = &p;
  return there;
}

bool BuiltPiles::is_clamped(const std::vector<PartId>& group, const std::vector<const PlacedPart*>& there) const {
  const PlacedPart* first = there[group.front()];
  return first != nullptr && std::ranges::all_of(group, [&](PartId part) {
           return there[part] != nullptr && in_place(*there[part], *first);
         });
}

double BuiltPiles::touching(Gaps gaps) const { return (gaps == Gaps::play ? kPlay : 1) * options_.touching; }

/// Without the last digits, which differ between a plan and its file: where points of symmetric parts are equally far
/// apart, rounding decides which of them are taken as contacts, and proofs refer to contacts.
BuiltPiles::GridPose BuiltPiles::on_grid(const PlacedPart& a, const PlacedPart& b) const {
  if (in_place(a, b)) return {};
  const Pose p = relative(a, b);
  const double length = kSamePose * size_;
  return {std::llround(p.t.x() / length),    std::llround(p.t.y() / length),    std::llround(p.t.z() / length),
          std::llround(p.q.w() / kSamePose), std::llround(p.q.x() / kSamePose), std::llround(p.q.y() / kSamePose),
          std::llround(p.q.z() / kSamePose)};
}

BuiltPiles::Contacts BuiltPiles::contacts_at(PartId a, PartId b, Gaps gaps, const GridPose& at) const {
  const std::tuple key(a, b, gaps, at);
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = contacts_.find(key); known != contacts_.end()) return known->second;
  }
  const Neighbour* near = neighbour(a, b);
  std::optional<double> bond = near == nullptr ? std::nullopt : near->bond;
  Pose pose;
  if (at != GridPose{}) {
    if (bond) bond = 0;
    const auto value = [&](std::size_t k) { return static_cast<double>(at[k]) * kSamePose; };
    pose.t = size_ * Vec3(value(0), value(1), value(2));
    pose.q = Eigen::Quaterniond(value(3), value(4), value(5), value(6)).normalized();
  } else if (bond) {
    gaps = Gaps::tight;  // a wider gap finds more, but takes narrow regions for rims: it must not undo a bond
  }
  std::vector<Contact> found = pair_contacts({&shape(a), pose}, {&shape(b), {}}, touching(gaps), bond);
  for (Contact& c : found) c.friction = options_.friction;
  const std::lock_guard lock(mutex_);
  if (contacts_.size() >= kMostKept) contacts_.clear();
  return contacts_.emplace(key, std::make_shared<const std::vector<Contact>>(std::move(found))).first->second;
}

std::vector<Contact> BuiltPiles::contacts(const PlacedPart& a, const PlacedPart& b, Gaps gaps) const {
  std::vector<Contact> result = *contacts_at(a.part, b.part, gaps, on_grid(a, b));
  if (!b.pose.is_identity())
    for (Contact& c : result) move_by(b.pose, c);
  return result;
}

void BuiltPiles::add_table(std::span<const PlacedPart> parts, double lowest, const Vec3& up, Gaps gaps,
                           BuiltPile& built) const {
  const std::uint32_t table = static_cast<std::uint32_t>(built.pile.bodies.size() - 1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (height(parts[i], up) > lowest + touching(gaps) * shape(parts[i].part).radius()) continue;
    const Pose& pose = parts[i].pose;
    const Vec3 own = (pose.q.conjugate() * up)
                         .unaryExpr([](double x) { return std::round(x / kSamePose) * kSamePose; })
                         .normalized();
    Contact c = contact_with_table({&shape(parts[i].part), {}}, own, lowest - up.dot(pose.t), touching(gaps));
    if (c.points.empty()) continue;
    move_by(pose, c);
    c.normal = up;
    c.a = built.body_of[i];
    c.b = table;
    c.friction = options_.friction;
    built.pile.contacts.push_back(std::move(c));
  }
}

BuiltPile BuiltPiles::pile(std::span<const PlacedPart> parts, const Vec3& up, Gaps gaps, bool table) const {
  const std::size_t count = parts.size();
  std::vector<Aabb> boxes;
  for (const PlacedPart& p : parts) {
    boxes.push_back(geometry::box_under(boxes_[p.part], p.pose));
    boxes.back().inflate(touching(gaps) * boxes.back().size().norm());
  }
  struct Found {
    std::size_t a, b;
    std::vector<Contact> contacts;
  };
  std::vector<Found> found;
  DisjointSets rigid(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) {
      if (one_unit(parts[i].part, parts[j].part)) {
        rigid.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
        continue;
      }
      if (!boxes[i].overlaps(boxes[j])) continue;
      std::vector<Contact> own = contacts(parts[i], parts[j], gaps);
      if (own.empty()) continue;
      if (bonded(parts[i].part, parts[j].part))
        rigid.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
      else
        found.push_back({i, j, std::move(own)});
    }
  const std::vector<const PlacedPart*> there = places(parts);
  for (const std::vector<PartId>& group : clamped_)
    if (is_clamped(group, there))
      for (const PartId part : group)
        rigid.join(static_cast<std::uint32_t>(there[part] - parts.data()),
                   static_cast<std::uint32_t>(there[group.front()] - parts.data()));
  BuiltPile built;
  built.pile.down = -up;
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [at, is_new] = number.try_emplace(rigid.root(i), static_cast<std::uint32_t>(number.size()));
    built.body_of.push_back(at->second);
    const Body own = body(parts[i]);
    if (is_new) {
      built.pile.bodies.push_back(own);
      continue;
    }
    Body& all = built.pile.bodies[at->second];
    const Vec3 center = (all.weight * all.center + own.weight * own.center) / (all.weight + own.weight);
    all.radius = std::max(all.radius + (all.center - center).norm(), own.radius + (own.center - center).norm());
    all.center = center;
    all.weight += own.weight;
    all.fixed = all.fixed || own.fixed;
  }
  built.pile.bodies.push_back({0, Vec3::Zero(), 1, true});
  for (Found& f : found)
    for (Contact& c : f.contacts) {
      c.a = built.body_of[f.a];
      c.b = built.body_of[f.b];
      if (c.a != c.b) built.pile.contacts.push_back(std::move(c));
    }
  if (table) add_table(parts, bottom_of(parts, up), up, gaps, built);
  return built;
}

double BuiltPiles::bottom_of(std::span<const PlacedPart> parts, const Vec3& up) const {
  double low = std::numeric_limits<double>::infinity();
  for (const PlacedPart& p : parts) low = std::min(low, height(p, up));
  return low;
}

double BuiltPiles::bottom(std::span<const PlacedPart> parts, const Vec3& up) const { return bottom_of(parts, up); }

void BuiltPiles::press(BuiltPile& built, std::span<const PlacedPart> parts, std::span<const PlacedPart> moving,
                       const Vec3& direction, double share, Gaps gaps) const {
  struct Touch {
    std::size_t part;
    Contact contact;
  };
  std::vector<Touch> seats, sides;
  double weight = 0;
  for (const PlacedPart& m : moving) {
    weight += body(m).weight;
    Aabb box = geometry::box_under(boxes_[m.part], m.pose);
    box.inflate(touching(gaps) * box.size().norm());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!box.overlaps(geometry::box_under(boxes_[parts[i].part], parts[i].pose))) continue;
      for (Contact& c : contacts(m, parts[i], gaps)) {
        const double against = -c.normal.dot(direction);  // the normal points into `moving`
        if (against > kSeat)
          seats.push_back({i, std::move(c)});
        else if (against > -kSeat)
          sides.push_back({i, std::move(c)});
      }
    }
  }
  const std::vector<Touch>& carrying = seats.empty() ? sides : seats;
  double all = 0;
  for (const Touch& t : carrying) all += static_cast<double>(t.contact.points.size());
  for (const Touch& t : carrying) {
    const double count = static_cast<double>(t.contact.points.size());
    Vec3 center = Vec3::Zero();
    for (const Vec3& p : t.contact.points) center += p / count;
    built.pile.pushes.push_back({built.body_of[t.part], center, share * weight * count / all * direction});
  }
}

}  // namespace dismantle::statics
