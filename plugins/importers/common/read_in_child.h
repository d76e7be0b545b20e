/// Reads a file in a child process, because the reading library may crash, hang or use all memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dismantle/importer.h"

namespace dismantle::reader_process {

struct ReaderLimits {
  double seconds = 0;        ///< of wall-clock time and of CPU time; 0 = no limit
  std::uint64_t memory = 0;  ///< bytes of address space; 0 = no limit
};

/// The program to start, and its texts in messages.
struct ReaderProgram {
  std::filesystem::path path;
  std::string formats;     ///< "STEP files"
  std::string library;     ///< "Open CASCADE"
  std::string instead;     ///< what the user can do: "export it again", in the infinitive
  std::string missing;     ///< why the program may be missing, and the remedy
  std::string parameters;  ///< "importers.step": where time_limit and memory_limit are set
  std::string coarser;     ///< parameter that reduces the number of triangles; empty: none
};

/// Path of the reader program `name`: beside the folder of the calling plugin, or in lib/dismantle beside the folder of
/// a program that contains the importer. The same in the build tree and in the install.
std::filesystem::path installed_reader(const std::string& name);

/// Starts the program with the file and `arguments`, and reads its output (stream_format.h).
/// @throws InputError with the file, the failure and the remedy. @throws Error when the context requests a stop.
std::vector<RawPart> read_in_child(const std::filesystem::path& file, const ReaderProgram& program,
                                   const std::vector<std::string>& arguments, const ReaderLimits& limits,
                                   std::uint64_t max_triangles, const RunContext& context);

}  // namespace dismantle::reader_process
