/// Reading a STEP file by the reader program of this build, and changing one as text.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/run_context.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import::testing {

struct Read {
  std::vector<RawPart> parts;
  std::string log;  ///< One line for each message.
};

inline Read read(const std::filesystem::path& file, const StepParameters& params = {}) {
  Read out;
  RunContext context;
  context.on_log = [&](LogLevel, std::string_view text) { out.log += std::string(text) + "\n"; };
  out.parts = StepImporter(params, STEP_READER).read(file, context);
  return out;
}

inline std::vector<std::string> names(const Read& in) {
  std::vector<std::string> out(in.parts.size());
  std::ranges::transform(in.parts, out.begin(), &RawPart::name);
  return out;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What `file` is written as.
inline std::string text_of(StepFile& file, const Scratch& scratch, const char* unit = "MM") {
  file.write(scratch / "written.step", unit);
  return bytes_of(scratch / "written.step");
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace dismantle::step_import::testing
