/// Piles of what has been built: some parts of an assembly, wherever they are.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/disassembly.h"
#include "dismantle/export.h"
#include "dismantle/statics/contacts.h"
#include "dismantle/statics/stability.h"

namespace dismantle::statics {

/// Gaps that count as touching. CAD leaves play: a part that has some falls a little, and then it rests.
enum class Gaps {
  tight,  ///< StabilityOptions::touching
  play,   ///< ten times as much: what stands now settles by less than that
};

/// A pile of placed parts. Parts that are bonded, directly or through others, are one body, and so are those that a
/// screw presses together, once all of them are there.
struct BuiltPile {
  Pile pile;                           ///< weights in newton, lengths in assembly units; the last body is the table
  std::vector<std::uint32_t> body_of;  ///< by index into the parts that were given
};

/// Makes piles of the parts of one assembly. Contacts are found once for each relative pose of two parts. Functions may
/// be called from several threads.
class DISMANTLE_API BuiltPiles {
 public:
  /// Keeps the meshes, not the assembly. Options: `fixed`, `friction`, `density`, `mass`, `touching`.
  BuiltPiles(const Assembly& assembly, StabilityOptions options);
  ~BuiltPiles();

  /// True for the assembly it was made of, and for copies of it: the same meshes, of the same kinds.
  bool is_of(const Assembly& assembly) const;

  /// `parts` in ascending order of ids. The table has the unit normal `up` and touches the lowest point; `table` false:
  /// there is none.
  BuiltPile pile(std::span<const PlacedPart> parts, const Eigen::Vector3d& up, Gaps gaps = Gaps::tight,
                 bool table = true) const;

  /// The largest gap that counts as touching, for a part as large as the assembly. Assembly units.
  double gap(Gaps gaps) const { return touching(gaps) * size_; }

  /// The lowest point of `parts` along `up`.
  double bottom(std::span<const PlacedPart> parts, const Eigen::Vector3d& up) const;

  /// Adds to the pile of `parts` what a hand does that presses `moving` onto them: `share` times the weight of `moving`
  /// along `direction`, on the contacts that stop it, or, if there is none, on those that lie along it, by friction.
  void press(BuiltPile& built, std::span<const PlacedPart> parts, std::span<const PlacedPart> moving,
             const Eigen::Vector3d& direction, double share, Gaps gaps = Gaps::tight) const;

  /// How many bodies do not stand if the others, and the table, do not move? A lower bound of the holds that `parts`
  /// need, but for what is wedged. Only bodies with a part of `of` are looked at. Answers are kept: each depends on the
  /// neighbours of a body.
  std::size_t unsupported(std::span<const PlacedPart> parts, std::span<const PlacedPart> of,
                          const Eigen::Vector3d& up) const;

 private:
  struct Neighbour {
    PartId part;
    std::optional<double> bond;  // Bonds::depth()
  };
  void find_neighbours(const Assembly& assembly);
  const Neighbour* neighbour(PartId a, PartId b) const;
  const Shape& shape(PartId part) const;
  double height(const PlacedPart& part, const Eigen::Vector3d& up) const;
  double bottom_of(std::span<const PlacedPart> parts, const Eigen::Vector3d& up) const;
  Body body(const PlacedPart& part) const;
  /// Contacts of a on b; Contact::a and b are not set.
  std::vector<Contact> contacts(const PlacedPart& a, const PlacedPart& b, Gaps gaps) const;
  /// Relative poses on a grid, in steps of it: translation, then rotation. All 0: as assembled.
  using GridPose = std::array<std::int64_t, 7>;
  GridPose on_grid(const PlacedPart& a, const PlacedPart& b) const;
  using Contacts = std::shared_ptr<const std::vector<Contact>>;
  /// In the frame of b. They are kept.
  Contacts contacts_at(PartId a, PartId b, Gaps gaps, const GridPose& pose) const;
  double touching(Gaps gaps) const;
  bool bonded(PartId a, PartId b) const;
  /// By part: where it is; null: it is not there.
  std::vector<const PlacedPart*> places(std::span<const PlacedPart> parts) const;
  /// Whether a lies to b as it does when assembled.
  bool in_place(const PlacedPart& a, const PlacedPart& b) const;
  /// Whether a screw presses them together: all of them are there, as assembled.
  bool is_clamped(const std::vector<PartId>& group, const std::vector<const PlacedPart*>& there) const;
  bool one_unit(PartId a, PartId b) const;
  bool stands(std::vector<PlacedPart> body, std::vector<PlacedPart> near, Eigen::Vector3d up, double table,
              bool in_place) const;
  bool stands_on(std::span<const PlacedPart> unit, std::span<const PlacedPart> near, const Eigen::Vector3d& up,
                 double table, Gaps gaps) const;
  void add_table(std::span<const PlacedPart> parts, double lowest, const Eigen::Vector3d& up, Gaps gaps,
                 BuiltPile& built) const;

  StabilityOptions options_;
  double newton_ = 1;  // of a volume of 1 with a density of 1 g/cm3
  double size_ = 1;
  std::vector<std::shared_ptr<const Mesh>> meshes_;
  std::vector<Aabb> boxes_;
  std::vector<double> volumes_;
  std::vector<std::pair<std::string, std::string>> kinds_;  // Part::kind: what it is, and its size
  std::vector<std::vector<PartId>> clamped_;                // Bonds::clamped()
  std::vector<std::vector<std::size_t>> clamped_of_;        // by part: indices of clamped_
  std::vector<std::optional<PartId>> units_;                // Part::unit
  std::vector<std::vector<Neighbour>> neighbours_;          // by part: those whose boxes are near, ascending
  mutable std::vector<std::once_flag> shape_once_;
  mutable std::vector<std::unique_ptr<const Shape>> shapes_;
  mutable std::mutex mutex_;  // of what follows; answers are found without it
  mutable std::map<std::tuple<PartId, PartId, Gaps, GridPose>, Contacts> contacts_;
  mutable std::map<std::vector<double>, bool> alone_;
};

}  // namespace dismantle::statics
