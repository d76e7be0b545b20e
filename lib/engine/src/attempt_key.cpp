#include "attempt_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

namespace dismantle {

namespace {

/// True if q must be negated to make its first non-zero coefficient (w, x, y, z) positive.
bool has_wrong_sign(const Eigen::Quaterniond& q) {
  for (const double c : {q.w(), q.x(), q.y(), q.z()})
    if (c != 0) return c < 0;
  return false;
}

void canonicalise(std::vector<PlacedPart>& parts, std::vector<bool>& seen) {
  for (auto& p : parts) {
    if (p.part >= seen.size()) throw std::invalid_argument(fmt::format("attempt names the unknown part {}", p.part));
    if (seen[p.part]) throw std::invalid_argument(fmt::format("attempt names part {} twice", p.part));
    seen[p.part] = true;
    if (!p.pose.t.allFinite() || !p.pose.q.coeffs().allFinite())
      throw std::invalid_argument(fmt::format("pose of part {} is not finite", p.part));
    p.pose = canonical(p.pose);
  }
  const auto by_part = [](const PlacedPart& a, const PlacedPart& b) { return a.part < b.part; };
  if (!std::is_sorted(parts.begin(), parts.end(), by_part)) std::sort(parts.begin(), parts.end(), by_part);
}

void append(std::string& bytes, std::uint64_t word) {
  for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<char>((word >> shift) & 0xff));
}

void append(std::string& bytes, const Eigen::Vector3d& v) {
  for (const double c : v) append(bytes, std::bit_cast<std::uint64_t>(c));
}

void append(std::string& bytes, const std::vector<PlacedPart>& parts) {
  append(bytes, parts.size());
  for (const auto& p : parts) {
    append(bytes, p.part);
    for (const double c :
         {p.pose.t.x(), p.pose.t.y(), p.pose.t.z(), p.pose.q.w(), p.pose.q.x(), p.pose.q.y(), p.pose.q.z()})
      append(bytes, std::bit_cast<std::uint64_t>(c));
  }
}

void append(std::string& bytes, const Goal& goal) {
  if (goal.placement) bytes.push_back('p');
  if (!goal.without.empty()) {
    bytes.push_back('w');
    append(bytes, goal.without.size());
    for (const Eigen::Vector3d& d : goal.without) append(bytes, d);
    append(bytes, std::bit_cast<std::uint64_t>(goal.angle));
  }
  if (goal.any_of.empty()) return;
  bytes.push_back('l');
  for (const PartId id : goal.any_of) append(bytes, id);
}

/// What makes it a question for another answer; nothing for the usual one.
void append_alternative(std::string& bytes, const Attempt& attempt) {
  if (attempt.seed == 0 && attempt.improve_steps == 0) return;
  bytes.push_back('a');
  append(bytes, attempt.seed);
  append(bytes, attempt.improve_steps);
}

void check(const Goal& goal) {
  if (goal.without.empty()) return;
  if (goal.placement) throw std::invalid_argument("attempt for a placement that excludes directions of leaving");
  if (!(goal.angle > 0 && goal.angle < M_PI))
    throw std::invalid_argument(fmt::format("attempt with the angle {}, not between 0 and pi", goal.angle));
  for (const Eigen::Vector3d& d : goal.without)
    if (!(std::abs(d.norm() - 1) < 1e-6))
      throw std::invalid_argument("attempt without a direction that is no unit vector");
}

SceneDigest sha256(const std::string& bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digest();
}

void mix(PlacesDigest& digest, PartId part, const Pose& pose) {
  auto& [a, b, count] = digest;
  const auto add = [&](std::uint64_t word) {
    a = (a ^ word) * 0x9e3779b97f4a7c15ULL;
    a ^= a >> 29;
    b = (b + word) * 0xbf58476d1ce4e5b9ULL;
    b ^= b >> 31;
  };
  add(part);
  for (const double c : {pose.t.x(), pose.t.y(), pose.t.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()})
    add(std::bit_cast<std::uint64_t>(c));
  ++count;
}

}  // namespace

PlacesDigest digest_of(std::span<const PartId> parts, std::span<const Pose> poses) {
  PlacesDigest digest{};
  for (const PartId id : parts) mix(digest, id, poses[id]);
  return digest;
}

PlacesDigest digest_of(std::span<const PlacedPart> parts) {
  PlacesDigest digest{};
  for (const PlacedPart& p : parts) mix(digest, p.part, p.pose);
  return digest;
}

Pose canonical(Pose pose) {
  if (has_wrong_sign(pose.q)) pose.q.coeffs() = -pose.q.coeffs();
  pose.q.coeffs().array() += 0.0;  // -0 becomes +0
  pose.t.array() += 0.0;
  return pose;
}

Attempt canonical(const Attempt& attempt, std::size_t part_count) {
  if (attempt.moving.empty()) throw std::invalid_argument("attempt in which no part moves");
  Attempt result = attempt;
  std::vector<bool> seen(part_count, false);
  canonicalise(result.moving, seen);
  canonicalise(result.fixed, seen);
  check(result.goal);
  if (result.goal.any_of.empty()) return result;
  if (result.goal.placement || result.moving.size() < 2)
    throw std::invalid_argument("attempt in which one of several parts is to leave, but only one moves or all stay");
  std::sort(result.goal.any_of.begin(), result.goal.any_of.end());
  result.goal.any_of.erase(std::unique(result.goal.any_of.begin(), result.goal.any_of.end()), result.goal.any_of.end());
  for (const PartId id : result.goal.any_of)
    if (std::none_of(result.moving.begin(), result.moving.end(), [id](const PlacedPart& p) { return p.part == id; }))
      throw std::invalid_argument(fmt::format("attempt in which part {} is to leave, but does not move", id));
  return result;
}

SceneDigest digest_of(const Attempt& canonical_attempt) {
  std::string bytes;
  bytes.reserve(64 * (canonical_attempt.moving.size() + canonical_attempt.fixed.size()) + 16);
  append(bytes, canonical_attempt.moving);
  append(bytes, canonical_attempt.fixed);
  append(bytes, canonical_attempt.goal);
  append_alternative(bytes, canonical_attempt);
  return sha256(bytes);
}

SceneDigest digest_of_moving(const Attempt& canonical_attempt) {
  std::string bytes;
  append(bytes, canonical_attempt.moving);
  append(bytes, canonical_attempt.goal);
  append_alternative(bytes, canonical_attempt);
  return sha256(bytes);
}

SceneDigest digest_of(const AttemptKey& key) {
  std::string bytes(key.scene.begin(), key.scene.end());
  append(bytes, key.max_depth);
  if (key.after != SceneDigest{}) bytes.append(key.after.begin(), key.after.end());
  return sha256(bytes);
}

bool may_follow(const Attempt& now, const Attempt& earlier) {
  const auto same = [](const PlacedPart& a, const PlacedPart& b) {
    return a.part == b.part && a.pose.t == b.pose.t && a.pose.q.coeffs() == b.pose.q.coeffs();
  };
  const auto before = [](const PlacedPart& p, PartId id) { return p.part < id; };
  return now.goal == earlier.goal && now.seed == earlier.seed && now.improve_steps == earlier.improve_steps &&
         std::equal(now.moving.begin(), now.moving.end(), earlier.moving.begin(), earlier.moving.end(), same) &&
         std::all_of(now.fixed.begin(), now.fixed.end(), [&](const PlacedPart& s) {
           const auto then = std::lower_bound(earlier.fixed.begin(), earlier.fixed.end(), s.part, before);
           return then != earlier.fixed.end() && same(*then, s);
         });
}

std::uint64_t stream_of(const AttemptKey& key) {
  const SceneDigest digest = digest_of(AttemptKey{key.scene, key.max_depth, {}});
  std::uint64_t stream = 0;
  for (int i = 0; i < 8; ++i) stream |= static_cast<std::uint64_t>(digest[static_cast<std::size_t>(i)]) << (8 * i);
  return stream;
}

}  // namespace dismantle
