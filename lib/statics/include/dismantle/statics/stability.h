/// Statics of an assembly: `dismantle stability`.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/statics/contacts.h"
#include "dismantle/statics/flips.h"
#include "dismantle/statics/holds.h"
#include "dismantle/statics/limits.h"

namespace dismantle::statics {

class Bonds;

/// Standard gravity, m/s2.
inline constexpr double kGravity = 9.80665;

/// What is assumed about an assembly.
struct StabilityOptions {
  std::vector<bool> fixed{};                                ///< by part; empty: none
  bool table = true;                                        ///< a table touches the lowest point and tilts along
  double friction = 0.4;                                    ///< of all contacts
  std::vector<double> density{};                            ///< g/cm3, by part; empty: of the file, or 1
  std::vector<std::optional<double>> mass{};                ///< kg, by part; overrides densities
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();            ///< unit
  std::vector<std::pair<Eigen::Vector3d, double>> tilts{};  ///< axis (unit) and angle (rad), one after the other
  double touching = kTouching;                              ///< as in contacts.h
};

/// The contacts of an assembly as it is, in input units.
class DISMANTLE_API AssemblyPile {
 public:
  AssemblyPile(const Assembly& assembly, StabilityOptions options);
  ~AssemblyPile();
  /// The bodies are the parts in their order, and the table as the last one. Weights in newton, lengths in input units.
  /// `factor` multiplies the tolerance of contacts.
  Pile pile(double factor = 1) const;
  const StabilityOptions& options() const { return options_; }
  const Assembly& assembly() const { return assembly_; }
  bool unit_known() const;

 private:
  const Assembly& assembly_;
  StabilityOptions options_;
  std::vector<Shape> shapes_;
  std::unique_ptr<const Bonds> bonds_;
};

/// A part that moves, and where to.
struct PartMove {
  PartId part = 0;
  Eigen::Vector3d direction;  ///< unit
};

/// Everything that `dismantle stability` says.
struct StabilityReport {
  Pile pile;                             ///< at the stated tolerance and tilt
  Judgement judgement;                   ///< its verdict is `uncertain` if it changes with the tolerance
  std::vector<Verdict> at_tolerances{};  ///< at half, once and twice the tolerance of contacts
  /// At half and twice the tolerance, with the same verdict; uncertain: between what it changes, empty: not found.
  std::vector<Variant> variants{};
  Holds holds{};
  std::vector<PartMove> moves{};
  Motions falling{};               ///< the motion of `moves`; empty: nothing falls
  std::vector<std::string> why{};  ///< "'plate' tips towards -x: nothing is under its half towards -x": what begins it
  std::array<TiltLimit, 4> tilts{};  ///< about the axes of kTiltAxes
  std::vector<LeastPush> pushes{};   ///< smallest first
  /// Friction and verdict; none: not computed.
  std::vector<std::pair<double, std::optional<Verdict>>> by_friction{};
  std::vector<std::string> not_computed{};  ///< "holds": what did not fit the budget
};

inline constexpr std::array<std::string_view, 4> kTiltAxes = {"x", "y", "-x", "-y"};

/// Multiplications that the answers beside the verdict may take together: some 40 s.
inline constexpr double kExtraWork = 150e9;

/// Judges an assembly. `stop`: true ends it with what is known. The verdict with its certificate is always found out;
/// all else takes at most `work` multiplications.
DISMANTLE_API StabilityReport judge_assembly(const AssemblyPile& assembly, const std::function<bool()>& stop = {},
                                             double work = kExtraWork);

/// The report as JSON text: the verdict and all that depends on it.
DISMANTLE_API std::string report_json(const StabilityReport& report, const Assembly& assembly,
                                      const AssemblyPile& pile);
/// picture_json() of what falls and of the forces, in the input's coordinates.
DISMANTLE_API std::string picture_of(const StabilityReport& report, const Assembly& assembly);
/// The certificate as JSON text: the model and the forces or the motion.
DISMANTLE_API std::string certificate_json(const StabilityReport& report, const Assembly& assembly);
/// Checks a stability.json without the solver; the contacts are found again. Empty: it holds; otherwise what is wrong.
/// @throws InputError when it cannot be read.
DISMANTLE_API std::string check_stability_json(const std::string& text, const AssemblyPile& assembly);

}  // namespace dismantle::statics
