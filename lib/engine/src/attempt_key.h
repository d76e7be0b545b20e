/// Identity of a question to the oracle: the same parts at the same poses are the same question, in whatever
/// order they are listed.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "dismantle/path_oracle.h"
#include "dismantle/preparation/sha256.h"

namespace dismantle {

/// SHA-256 of the moving and the fixed parts, their poses and the goal; without the depth.
using SceneDigest = Sha256Digest;

struct AttemptKey {
  SceneDigest scene{};
  unsigned max_depth = 0;
  SceneDigest after{};  ///< of the question whose search is gone on with; zero: it begins anew
  auto operator<=>(const AttemptKey&) const = default;
};

/// Moving and fixed parts by ascending id, those of the goal too, quaternions with the sign that makes them unique, no
/// negative zeros.
/// @throws std::invalid_argument when no part moves, a part is listed twice or unknown, a pose is not
/// finite, or one of the goal does not move or moves alone.
Attempt canonical(const Attempt& attempt, std::size_t part_count);

/// Digest of a canonical scene.
SceneDigest digest_of(const Attempt& canonical_attempt);

/// Digest of a question as a whole, for those that go on where it ended.
SceneDigest digest_of(const AttemptKey& key);

/// Digest of what two attempts have in common of which one may resume the other: the moving parts and the goal.
SceneDigest digest_of_moving(const Attempt& canonical_attempt);

/// May the search for `now` go on from what the one for `earlier` has reached? Both canonical: the same parts move from
/// the same places, to the same end, and every part that is fixed now was fixed there then.
bool may_follow(const Attempt& now, const Attempt& earlier);

/// Number of the random stream that belongs to the question: the same on every machine and in any order of asking, and
/// whether the search begins anew or goes on.
std::uint64_t stream_of(const AttemptKey& key);

/// Ids of `placed`, in order.
std::vector<PartId> ids_of(const std::vector<PlacedPart>& placed);

}  // namespace dismantle
