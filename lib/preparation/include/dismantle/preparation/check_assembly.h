/// Checks an assembly for problems before planning.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/contact_class.h"
#include "dismantle/export.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// What a finding is about.
enum class FindingKind {
  unusable,   ///< the part cannot be planned with: not closed, no volume, unreadable numbers
  repaired,   ///< its surface had to be changed
  open,       ///< its surface is not closed: it is planned as a wall
  suspect,    ///< its surface has a problem, but is kept as it is
  duplicate,  ///< same geometry and place as another part
  overlap,    ///< two parts penetrate each other when assembled
  enclosed,   ///< a part lies inside the solid material of another
  isolated,   ///< it touches no other part
  flexible,   ///< a part counts as flexible, declared by the user or the file, or by its shape
  fastener,   ///< a screw does not hold as it stands: no nut, another thread, too short, on the ground of its hole
  input,      ///< about the files, or the assembly as a whole: what `dismantle plan` says, too
};

/// How bad a finding is.
enum class Severity {
  note,     ///< nothing to do
  warning,  ///< planning works, but its result may mislead
  error,    ///< a part is missing from the plan, or a pair hides a collision
};

/// One thing that is wrong with an input, or worth knowing.
struct Finding {
  FindingKind kind = FindingKind::unusable;
  Severity severity = Severity::error;
  std::vector<std::string> parts;         ///< one or two names
  std::string message;                    ///< what is wrong, one sentence
  std::string advice;                     ///< what to do next
  std::optional<double> depth;            ///< overlap, input units
  std::optional<Eigen::Vector3d> at;      ///< where, input coordinates
  std::string picture{};                  ///< file that shows the place; empty: none
  std::optional<ContactClass> contact{};  ///< of two parts that overlap
  std::vector<std::string> details{};     ///< each action that `message` sums up
  /// Pairs for which this is the same are one line for people: "overlap slightly, as parts without play do".
  std::string together{};
};

/// How two parts meet when assembled.
struct CheckedContact {
  std::string a, b;
  double depth = 0;    ///< input units; 0: they do not overlap, or coincide
  OverlapPlace place;  ///< input units; only its class where they do not overlap
};

/// Equal parts, and what they are.
struct CheckedKind {
  std::vector<std::string> parts;
  PartKind kind;
};

/// Equal screws that do the same; see fasteners::Fastening.
struct CheckedFastening {
  std::vector<std::string> screws;
  std::string size;                             ///< "M3x10"; empty: not known
  std::string text;                             ///< what they do, in words; not empty
  std::vector<std::string> clamps, into, only;  ///< names of parts
};

/// Result of check_assembly().
struct AssemblyCheck {
  std::vector<Finding> findings;  ///< errors first, then warnings, then notes; deeper overlaps first
  std::size_t parts = 0;          ///< in the input
  std::size_t usable = 0;
  std::vector<CheckedContact> contacts;  ///< pairs nearer than 1 % of the assembly's size, in the order of its parts
  std::vector<CheckedKind> kinds{};      ///< of parts whose kind was looked at, fasteners first; see Part::kind
  std::vector<CheckedFastening> fastenings{};  ///< of screws whose kind was looked at, in the order of the parts
  std::size_t count(Severity severity) const;
  /// Whether a plan can be trusted to be about the whole assembly: no error. A part that is left out is one, unless it
  /// is there already (a duplicate, a warning). Warnings alone are for people to look at.
  bool sound() const;
};

/// `report`: of the preparation that made `assembly`. An overlap that is deeper than a hundredth of the assembly's size
/// (0.1 of the 10 assembly units), or through which a part lies wholly inside another, is an error: its allowance would
/// hide collisions. Depths are exact to `tolerance` (assembly units, > 0). Deterministic on any number of threads.
/// @throws Error when `context` wants to stop.
DISMANTLE_API AssemblyCheck check_assembly(const Assembly& assembly, const PrepareReport& report, double tolerance,
                                           const RunContext& context);
/// Findings from the report alone, for an input that gave no assembly.
DISMANTLE_API AssemblyCheck check_parts(const PrepareReport& report);

/// Name in files and messages.
DISMANTLE_API std::string_view to_string(FindingKind kind);
/// Name in files and messages.
DISMANTLE_API std::string_view to_string(Severity severity);
/// For a terminal; UTF-8, ends with a line break. `verbose`: with the details of findings.
DISMANTLE_API std::string findings_text(const AssemblyCheck& check, const std::string& source, bool verbose = false);
/// One JSON object: {"parts", "usable", "errors", "warnings", "findings": [{"kind", "severity", "parts", "message",
/// "advice", "class", "depth", "at", "picture", "details"}], "contacts": [{"parts", "class", "depth", "at", "region",
/// "share", "axis"}], "kinds": [{"kind", "size", "confidence", "reason", "stated", "parts"}], "fasteners": [{"screws",
/// "size", "text", "clamps", "into", "only"}]}; the last five keys of a finding and the last five of a contact are left
/// out if they do not apply.
DISMANTLE_API std::string findings_json(const AssemblyCheck& check);

}  // namespace dismantle
