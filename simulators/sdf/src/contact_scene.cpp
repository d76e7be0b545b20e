#include "dismantle/sdf/contact_scene.h"

#include <algorithm>
#include <utility>

namespace dismantle::sdf {
namespace {

Aabb world_box(const Aabb& local, const Pose& pose) {
  const Eigen::Vector3d center = pose * local.center();
  const Eigen::Vector3d half = pose.q.toRotationMatrix().cwiseAbs() * (0.5 * local.size());
  return {center - half, center + half};
}

double box_gap(const Aabb& a, const Aabb& b) { return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0.0).norm(); }

}  // namespace

void ContactScene::set_members(std::vector<Member> moving, std::vector<Member> fixed) {
  moving_ = moving.size();
  members_ = std::move(moving);
  members_.insert(members_.end(), fixed.begin(), fixed.end());
  odometer_.assign(moving_, 0.0);
  world_.resize(members_.size());
  boxes_.resize(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    world_[i] = members_[i].pose * members_[i].placed->rest;
    boxes_[i] = world_box(members_[i].placed->shape->box, world_[i]);
  }
  for (std::uint32_t a = 0; a < moving_; ++a)
    for (std::uint32_t b = a + 1; b < members_.size(); ++b) {
      pairs_.emplace_back();
      pairs_.back().a = a;
      pairs_.back().b = b;
    }
}

void ContactScene::add_point(PartId part, PartId other, const Eigen::Vector3d& point) {
  rest_ = nullptr;
  const auto add = [&](const ContactPair& pair, DirectedContacts& set, const Member& owner, const Member& surface) {
    set.extra.push_back(owner.placed->rest.inverse() * point);
    set.extra_own.push_back(assembled_depth(pair, owner, surface, set.extra.back()));
  };
  for (auto& pair : pairs_) {
    const Member &a = members_[pair.a], &b = members_[pair.b];
    if (a.part == part && b.part == other) add(pair, pair.ab, a, b);
    if (b.part == part && a.part == other) add(pair, pair.ba, b, a);
  }
}

void ContactScene::update_pair(ContactPair& pair, std::vector<ContactPoint>& out) {
  const double odometer = odometer_[pair.a] + (pair.b < moving_ ? odometer_[pair.b] : 0.0);
  if (pair.wake > odometer) return;
  const double gap = box_gap(boxes_[pair.a], boxes_[pair.b]), slack = gap + pair.everywhere - margin_;
  if (gap > 0 && slack > 0) {  // overlapping boxes give no bound
    pair.wake = odometer + slack;
    return;
  }
  pair.wake = 0;
  scan(pair, pair.ab, pair.a, pair.b, odometer, out);
  scan(pair, pair.ba, pair.b, pair.a, odometer, out);
}

/// The first update with every part in assembled position: copies the pairs measured by another scene.
void ContactScene::begin_at_rest(std::vector<ContactPoint>& out) {
  for (auto& pair : pairs_) {
    const Member &a = members_[pair.a], &b = members_[pair.b];
    const auto& known = rest_->of(a.part, b.part, [&](RestContacts::Entry& entry) {
      ContactScene alone(
          {a}, {b}, model_, margin_, [&](PartId, PartId) { return pair.allowed - depths_.threshold; }, depths_);
      alone.surroundings_ = surroundings_;
      alone.update({a.pose}, entry.points);
      entry.pair = std::move(alone.pairs_.front());
    });
    const std::uint32_t ia = pair.a, ib = pair.b;
    pair = known.pair;
    pair.a = ia;
    pair.b = ib;
    const int moving_b = ib < moving_ ? static_cast<int>(ib) : -1;
    for (const ContactPoint& c : known.points) {
      out.push_back(c);
      out.back().owner = c.owner == 0 ? static_cast<int>(ia) : moving_b;
      out.back().surface = c.surface == 0 ? static_cast<int>(ia) : moving_b;
    }
  }
}

void ContactScene::update(const std::vector<Pose>& poses, std::vector<ContactPoint>& out) {
  out.clear();
  if (rest_ != nullptr) {
    bool assembled = true;
    for (std::size_t i = 0; i < members_.size() && assembled; ++i) {
      const Pose& p = i < moving_ ? poses[i] : members_[i].pose;
      assembled = p.t == Eigen::Vector3d::Zero() && p.q.coeffs() == Eigen::Quaterniond::Identity().coeffs();
    }
    if (assembled) begin_at_rest(out);
    rest_ = nullptr;
    if (assembled) return;
  }
  for (std::size_t i = 0; i < moving_; ++i) {
    const Pose next = poses[i] * members_[i].placed->rest;
    const Eigen::Vector3d c = members_[i].placed->shape->mass.center;
    const double turn = angle_between(world_[i].q, next.q);
    odometer_[i] += (next * c - world_[i] * c).norm() + turn * radius(i);
    world_[i] = next;
    boxes_[i] = world_box(members_[i].placed->shape->box, next);
  }
  for (auto& pair : pairs_) update_pair(pair, out);
}

ContactScene ContactScene::with_margin(double margin) const {
  ContactScene other = *this;
  other.margin_ = margin;
  other.rest_ = nullptr;
  for (ContactPair& pair : other.pairs_) {
    pair.wake = 0;
    for (DirectedContacts* set : {&pair.ab, &pair.ba}) {
      DirectedContacts fresh;
      fresh.extra = std::move(set->extra);
      fresh.extra_own = std::move(set->extra_own);
      *set = std::move(fresh);
    }
  }
  return other;
}

}  // namespace dismantle::sdf
