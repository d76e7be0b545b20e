/// What the assembler knows of its parts while it puts them together.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "assembler.h"
#include "dismantle/part_set.h"
#include "placed_paths.h"

namespace dismantle {

/// a * b, to the last bit. Most parts are never turned, and the layout turns none.
inline Pose product(const Pose& a, const Pose& b) {
  static const Eigen::Vector4d identity = Eigen::Quaterniond::Identity().coeffs();
  if (a.q.coeffs() != identity || b.q.coeffs() != identity) return a * b;
  return {(b.t.array() + 0.0).matrix() + a.t, a.q};
}

/// The disassembly, and where its groups lie before assembly. "Place" of a group: its displacement from its pose in the
/// disassembly. Groups of the start stay where they are.
struct Assembler::Scenery {
  const Disassembly& done;
  const std::vector<DisassemblyStep>& steps;
  std::vector<Pose> place;           ///< [group]
  std::vector<std::string> missing;  ///< [group]: why it is not in the layout; empty: it is
  std::size_t changes = 0;           ///< of the places since the groups were placed

  explicit Scenery(const Disassembly& disassembly) : done(disassembly), steps(disassembly.steps()) {
    place.resize(done.groups().size()), missing.resize(done.groups().size());
  }

  bool of_start(std::size_t group) const { return group < done.start_groups(); }
  void leave_out(std::size_t group, std::string why) {
    missing[group] = std::move(why);
    place[group] = place[done.left_group(group - done.start_groups())];
    ++changes;
  }
  /// The reversed disassembly path of step `i`, at the place of the group that its parts are inserted into.
  Path insertion(std::size_t i) const { return backwards(displaced(place[done.left_group(i)], *steps[i].path)); }
};

/// Where the parts are at the time of a transfer. Those of the step before are kept: few of them move in a step.
class Assembler::PartPlaces {
 public:
  /// All parts but those of step `i`. Groups that are not in the layout are left out, except the one that the step adds
  /// to. `of_its_group` false: without that one, too.
  std::vector<PlacedPart> others(const Scenery& scenery, std::size_t i, bool of_its_group = true) {
    const Disassembly& done = scenery.done;
    if (stands_.size() != done.parts() || changes_ != scenery.changes || i + 1 < after_) {
      stands_.assign(done.parts(), {});
      for (PartId id = 0; id < done.parts(); ++id) place(scenery, id, i + 1);
    } else {
      for (std::size_t k = after_; k <= i; ++k)
        for (const PartId id : scenery.steps[k].parts) place(scenery, id, i + 1);
    }
    after_ = i + 1;
    changes_ = scenery.changes;
    const std::size_t left = done.left_group(i);
    std::vector<PlacedPart> all;
    all.reserve(done.parts());
    for (const Stand& s : stands_)
      if (s.group != Disassembly::kAbsent && (s.group == left ? of_its_group : s.shown) &&
          !contains(scenery.steps[i].parts, s.at.part))
        all.push_back(s.at);
    return all;
  }

 private:
  struct Stand {
    PlacedPart at;
    std::size_t group = 0;
    bool shown = true;  ///< its group is in the layout
  };
  void place(const Scenery& scenery, PartId id, std::size_t after) {
    Stand& s = stands_[id];
    s.group = scenery.done.group(id, after);
    if (s.group == Disassembly::kAbsent) return;
    s.shown = scenery.missing[s.group].empty();
    s.at = {id, product(scenery.place[s.group], scenery.done.pose(id, after))};
  }

  std::vector<Stand> stands_;  // by part, after `after_` steps
  std::size_t after_ = 0, changes_ = 0;
};

}  // namespace dismantle
