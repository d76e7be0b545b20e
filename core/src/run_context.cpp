#include "dismantle/run_context.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace dismantle {

namespace {

/// Finaliser and increment of SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t split_mix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ull;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

}  // namespace

Deadline Deadline::after_seconds(double s) {
  Deadline d;
  const Clock::time_point now = Clock::now();
  const double room = std::chrono::duration<double>(Clock::time_point::max() - now).count();
  // Half the room keeps the conversion to ticks away from overflow; that is still over a century.
  if (std::isnan(s) || s >= 0.5 * room) return d;
  d.at_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s > 0 ? s : 0));
  return d;
}

Deadline Deadline::earlier(const Deadline& other) const { return at_ <= other.at_ ? *this : other; }

double Deadline::seconds_left() const {
  if (at_ == Clock::time_point::max()) return std::numeric_limits<double>::infinity();
  return std::chrono::duration<double>(at_ - Clock::now()).count();
}

Rng::Rng(std::uint64_t seed) : seed_(seed) {
  std::uint64_t state = seed;
  for (auto& word : s_) word = split_mix(state);
}

std::uint64_t Rng::next() {  // xoshiro256** 1.0 (Blackman, Vigna)
  const std::uint64_t result = std::rotl(s_[1] * 5, 7) * 9;
  const std::uint64_t t = s_[1] << 17;
  s_[2] ^= s_[0];
  s_[3] ^= s_[1];
  s_[1] ^= s_[2];
  s_[0] ^= s_[3];
  s_[2] ^= t;
  s_[3] = std::rotl(s_[3], 45);
  return result;
}

double Rng::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Rng::uniform(double lo, double hi) {
  const double x = lo + uniform() * (hi - lo);
  return x < hi ? x : lo;  // rounding may reach hi, which is not in the range
}

std::uint64_t Rng::below(std::uint64_t n) {
  const std::uint64_t surplus = (0 - n) % n;  // 2^64 mod n values at the bottom would favour small results
  std::uint64_t x = next();
  while (x < surplus) x = next();
  return x % n;
}

double Rng::normal() {
  // Box-Muller without a cached second value, so that the generator has no other state.
  const double u = 1.0 - uniform();
  const double v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

Rng Rng::fork(std::uint64_t stream) const {
  std::uint64_t state = seed_;
  const std::uint64_t a = split_mix(state);
  state = stream ^ 0x6a09e667f3bcc909ull;  // so that stream s of seed s is not a special case
  const std::uint64_t b = split_mix(state);
  state = a ^ std::rotl(b, 32);
  return Rng(split_mix(state));
}

}  // namespace dismantle
