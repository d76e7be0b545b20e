/// Identity of a question to the oracle: the same parts at the same poses are the same question, in any order.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "dismantle/path_oracle.h"
#include "dismantle/preparation/sha256.h"

namespace dismantle {

/// SHA-256 of the moving and the fixed parts, their poses, the goal, and what asks for another answer (Attempt::seed,
/// improve_steps); without the depth.
using SceneDigest = Sha256Digest;

struct AttemptKey {
  SceneDigest scene{};
  unsigned max_depth = 0;
  SceneDigest after{};  ///< digest of the question whose search is resumed; zero: the search begins anew
  auto operator<=>(const AttemptKey&) const = default;
};

/// Sorts moving, fixed and goal parts by id, makes the signs of quaternions unique, and removes negative zeros.
/// @throws std::invalid_argument when no part moves, a part is listed twice or unknown, a pose is not finite, or a part
/// of the goal does not move or moves alone, or directions that are excluded are no unit vectors.
Attempt canonical(const Attempt& attempt, std::size_t part_count);

/// As it stands in a canonical attempt.
Pose canonical(Pose pose);

/// Digest of a canonical scene.
SceneDigest digest_of(const Attempt& canonical_attempt);

/// Digest of a whole question, for questions that resume its search.
SceneDigest digest_of(const AttemptKey& key);

/// Digest of the moving parts and the goal, which two attempts must share for one to resume the other.
SceneDigest digest_of_moving(const Attempt& canonical_attempt);

/// May the search for `now` resume the one for `earlier`? Both are canonical. True if the same parts move from the same
/// poses to the same goal, and every part that is fixed now was fixed at the same pose then.
bool may_follow(const Attempt& now, const Attempt& earlier);

/// Stands for placed parts that are not kept any more: differs for other parts, other poses, or another order. Much
/// cheaper than SHA-256, and no protection against someone who looks for two lists with the same value.
using PlacesDigest = std::array<std::uint64_t, 3>;
/// `poses`: by part, canonical.
PlacesDigest digest_of(std::span<const PartId> parts, std::span<const Pose> poses);
PlacesDigest digest_of(std::span<const PlacedPart> canonical_parts);

/// Random stream of the question: the same on every machine, in any order of asking, and for new and resumed searches.
std::uint64_t stream_of(const AttemptKey& key);

}  // namespace dismantle
