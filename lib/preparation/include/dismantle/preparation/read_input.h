/// Reads the raw parts of the user's input, through the given importers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/importer.h"
#include "dismantle/plan.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/run_context.h"

namespace dismantle {

/// Limits for reading files.
struct ReadOptions {
  std::int64_t max_triangles = 5'000'000;  ///< all files together; give it PrepareOptions::max_triangles
};

/// What was read. `parts` are in natural order of file names ("2" before "10"), then file order, with unique names.
struct InputParts {
  std::vector<RawPart> parts;
  std::string
      sha256;  ///< of the bytes of all files read, and of those they refer to, in the order of `parts`; lower-case hex
  std::vector<std::string> warnings;  ///< of the importers, and what was renamed
  std::vector<std::string> notes;     ///< of the importers: nothing is wrong
  /// How the author of a single file builds it, by names of `parts`; empty: not stated.
  std::vector<PlanReferenceStep> reference_order{};
};

/// That order for the parts of the assembly: steps that put in no part that is there are left out.
DISMANTLE_API std::vector<ReferenceStep> reference_order_of(const std::vector<PlanReferenceStep>& named,
                                                            const Assembly& assembly);

/// Folder: each mesh file is one part, even with several bodies, named like the file without extension. An
/// unreadable file becomes a part with a `problem`, and so does what may be input and is not read: sub-folders with
/// files that could be read, files of unknown formats, bodies of a file beside others that cannot be used. Single file:
/// its parts, named as in the file. Names are made valid UTF-8 and unique ("a.obj" and "a.stl" for two files of one
/// stem, "nut#2" for a second node).
/// @throws InputError naming the input, or the file in it: missing, no importer for its extension, no parts, too large,
/// or a broken single file.
/// @throws Error when `context` wants to stop.
DISMANTLE_API InputParts read_input(const std::filesystem::path& input,
                                    const std::vector<std::shared_ptr<Importer>>& importers,
                                    const ReadOptions& options = {}, const RunContext& context = {});

/// Adds what was found about the files to what preparation found about the parts, for `dismantle check` and reports.
DISMANTLE_API void add_findings(const InputParts& input, PrepareReport& report);

/// Order for names: runs of digits compare as numbers, all else bytewise; a strict total order.
DISMANTLE_API bool natural_less(std::string_view a, std::string_view b);

/// `bytes` with every byte sequence that is not UTF-8 replaced by U+FFFD and control characters (C0, DEL, C1) by '_'.
DISMANTLE_API std::string valid_utf8(std::string_view bytes);

/// Makes the names of `parts` non-empty and unique: a repeated name gets "#2", "#3"...
/// What was changed is appended to `warnings`.
DISMANTLE_API void make_names_unique(std::vector<RawPart>& parts, std::vector<std::string>& warnings);

}  // namespace dismantle
