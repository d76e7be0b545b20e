#include "step_importer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "compressed.h"
#include "dismantle/errors.h"
#include "external_files.h"
#include "read_in_child.h"

namespace dismantle::step_import {
namespace {

namespace fs = std::filesystem;

/// Refuses truncated files and files of other formats before a process is started for them. `in`: the text of `file`.
void check_ends(std::istream& in, const fs::path& file) {
  const std::streamoff look = 1 << 16;  // bytes at both ends; comments may stand there
  in.seekg(0, std::ios::end);
  const std::streamoff size = in.tellg();
  const auto part = [&](std::streamoff from, std::streamoff length) {
    std::string text(static_cast<std::size_t>(std::max<std::streamoff>(0, length)), '\0');
    in.clear();
    in.seekg(from);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
  };
  if (part(0, std::min(size, look)).find("ISO-10303-21") == std::string::npos)
    throw InputError(file.string(), "this is no STEP file: it does not begin with ISO-10303-21");
  const std::streamoff tail = std::min(size, look);
  if (part(size - tail, tail).find("END-ISO-10303-21") == std::string::npos)
    throw InputError(file.string(),
                     "the file is cut off: its end, END-ISO-10303-21, is missing; export or copy it again");
}

void check_ends(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  if (!is_compressed(file)) return check_ends(in, file);
  std::istringstream text(unpacked(file));
  check_ends(text, file);
}

}  // namespace

void StepParameters::describe(Schema<StepParameters>& s) {
  s.add("linear_deflection", &StepParameters::linear_deflection,
        {.unit = "1",
         .min = 1e-6,
         .max = 0.5,
         .doc = "Largest distance between a body and its triangles, as a share of the diagonal of the body's box."});
  s.add("assembly_deflection", &StepParameters::assembly_deflection,
        {.unit = "1",
         .min = 0,
         .max = 0.5,
         .doc =
             "The same as a share of the diagonal of the whole assembly; the smaller distance applies. 0 = no bound."});
  s.add("angular_deflection", &StepParameters::angular_deflection,
        {.unit = "rad",
         .min = 0.01,
         .max = 1.5,
         .doc = "Largest angle between the directions of a curve, or normals of a surface, at neighbouring vertices."});
  s.add("triangle_limit", &StepParameters::triangle_limit,
        {.unit = "1", .min = 1, .max = 1e9, .doc = "Files with more triangles are refused."});
  s.add("time_limit", &StepParameters::time_limit,
        {.unit = "s", .min = 0, .max = 1e6, .doc = "Time limit for reading a file; 0 = no limit."});
  s.add("memory_limit", &StepParameters::memory_limit,
        {.unit = "MiB",
         .min = 0,
         .max = 1e7,
         .doc = "Address space limit of the process that reads a file; 0 = no limit."});
}

StepImporter::StepImporter(const StepParameters& params)
    : StepImporter(params, reader_process::installed_reader("step_reader")) {}

StepImporter::StepImporter(const StepParameters& params, fs::path reader)
    : params_(params), reader_(std::move(reader)) {}

std::vector<std::string> StepImporter::extensions() const { return {"step", "stp", "p21", "stpz"}; }

std::vector<fs::path> StepImporter::referenced_files(const fs::path& file) const { return external_files(file).read; }

std::vector<RawPart> StepImporter::read(const fs::path& file, const RunContext& context) {
  check_ends(file);
  // Open CASCADE would open them, and wait for a pipe.
  if (const ExternalFiles others = external_files(file); !others.refused.empty())
    throw InputError(file.string(), fmt::format("it refers to '{}', which is no regular file in its folder: refused",
                                                others.refused.front()));
  const reader_process::ReaderProgram program{
      .path = reader_,
      .formats = "STEP files",
      .library = "Open CASCADE",
      .instead =
          "open it in the CAD program and export it again (AP214 or AP242), or export the parts as meshes (3MF, STL)",
      .missing =
          "this Dismantle was built without Open CASCADE. Install the package libocct-data-exchange-dev, "
          "configure and build again, or export the parts as meshes (3MF, STL)",
      .parameters = "importers.step",
      .coarser = "linear_deflection"};
  const std::vector<std::string> arguments = {
      fmt::format("{}", params_.linear_deflection), fmt::format("{}", params_.assembly_deflection),
      fmt::format("{}", params_.angular_deflection), fmt::format("{}", params_.triangle_limit)};
  const reader_process::ReaderLimits limits{params_.time_limit,
                                            static_cast<std::uint64_t>(params_.memory_limit * 1024 * 1024)};
  return read_in_child(file, program, arguments, limits, static_cast<std::uint64_t>(params_.triangle_limit), context);
}

}  // namespace dismantle::step_import
