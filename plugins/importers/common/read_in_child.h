/// Reads a file by a program of its own, since the library that reads it may crash, hang or take all memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "child_process.h"
#include "dismantle/importer.h"

namespace dismantle::reader_process {

/// What is started, and what messages say of it.
struct ReaderProgram {
  std::filesystem::path path;
  std::string formats;     ///< "STEP files"
  std::string library;     ///< "Open CASCADE"
  std::string instead;     ///< what the user can do: "export it again", in the infinitive
  std::string missing;     ///< why the program may be missing, and what to do then
  std::string parameters;  ///< "importers.step": where time_limit and memory_limit are set
  std::string coarser;     ///< parameter that makes triangles fewer; empty: there is none
};

/// `name` beside the folder of the plugin that calls, or in lib/dismantle beside that of a program that has the
/// importer in it; in the build as in the install.
std::filesystem::path installed_reader(const std::string& name);

/// Starts the program with the file and `arguments`, and takes what it writes (stream_format.h).
/// @throws InputError that names the file, what happened, and what to do. @throws Error when the context wants to stop.
std::vector<RawPart> read_in_child(const std::filesystem::path& file, const ReaderProgram& program,
                                   const std::vector<std::string>& arguments, const ChildLimits& limits,
                                   std::uint64_t max_triangles, const RunContext& context);

}  // namespace dismantle::reader_process
