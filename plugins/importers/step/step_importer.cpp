#include "step_importer.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>

#include "child_process.h"
#include "dismantle/errors.h"
#include "stream_reader.h"

namespace dismantle::step_import {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOtherFormat =
    "open it in the CAD program and export it again (AP214 or AP242), or export the parts as meshes (3MF, STL)";

/// `<folder of the plugin>/../step_reader`, in the build as in the install.
fs::path installed_reader() {
  static const char anchor = 0;
  Dl_info info = {};
  if (::dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr) return "step_reader";
  std::error_code ec;
  const fs::path plugin = fs::canonical(info.dli_fname, ec);
  return (ec ? fs::path(info.dli_fname) : plugin).parent_path().parent_path() / "step_reader";
}

/// Refuses what is no whole STEP file before another process is started for it.
void check_ends(const fs::path& file) {
  constexpr std::streamoff kLook = 1 << 16;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
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
  if (part(0, std::min(size, kLook)).find("ISO-10303-21") == std::string::npos)
    throw InputError(file.string(), "this is no STEP file: it does not begin with ISO-10303-21");
  const std::streamoff tail = std::min(size, kLook);
  if (part(size - tail, tail).find("END-ISO-10303-21") == std::string::npos)
    throw InputError(file.string(),
                     "the file is cut off: its end, END-ISO-10303-21, is missing; export or copy it again");
}

/// Plain text: Open CASCADE colours its messages, and quotes the file, which may come from anybody, as it is.
std::string without_control_characters(const std::string& text) {
  std::string plain;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\x1b' && k + 1 < text.size() && text[k + 1] == '[') {  // up to the letter that ends the sequence
      k += 2;
      while (k < text.size() && !(text[k] >= '@' && text[k] <= '~')) ++k;
      continue;
    }
    plain += std::iscntrl(static_cast<unsigned char>(text[k])) != 0 ? ' ' : text[k];
  }
  return plain;
}

/// The last lines that are worth showing.
std::string last_words(const std::string& messages) {
  std::string text = messages;
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (int lines = 0; lines < 2; ++lines) {
    const auto at = text.rfind('\n', lines == 0 ? std::string::npos : text.find_last_of('\n') - 1);
    if (at == std::string::npos || lines == 1) {
      if (at != std::string::npos) text.erase(0, at + 1);
      break;
    }
  }
  text = without_control_characters(text);
  if (text.size() > 300) text.erase(0, text.size() - 300);
  return text;
}

class Reading {
 public:
  Reading(const fs::path& file, const StepParams& params, const fs::path& reader, const RunContext& context)
      : file_(file),
        params_(params),
        reader_(reader),
        context_(context),
        stream_(static_cast<std::uint64_t>(params.triangle_limit),
                [&](const std::string& phase, std::size_t done, std::size_t total) {
                  context_.progress(phase, done, total, file_.filename().string());
                }) {}

  std::vector<RawPart> run() {
    check_reader();
    const ChildLimits limits{params_.time_limit, static_cast<std::uint64_t>(params_.memory_limit * 1024 * 1024)};
    const std::vector<std::string> arguments = {
        fs::absolute(file_).string(), fmt::format("{}", params_.linear_deflection),
        fmt::format("{}", params_.assembly_deflection), fmt::format("{}", params_.angular_deflection),
        fmt::format("{}", params_.triangle_limit)};
    const ChildEnd end = run_child(
        reader_, arguments, limits, [&] { return context_.should_stop(); },
        [&](std::span<const std::byte> bytes) { return stream_.feed(bytes); });
    if (context_.should_stop()) throw Error("stopped while reading " + file_.string());
    check_end(end);
    for (const auto& warning : stream_.warnings())
      context_.log(LogLevel::warning, fmt::format("{}: {}", file_.filename().string(), warning));
    auto parts = stream_.take_parts();
    if (parts.empty()) fail("there is no body in it: nothing but curves, points or empty products");
    context_.log(LogLevel::info, fmt::format("{}: {} bodies, lengths in {}", file_.filename().string(), parts.size(),
                                             parts.front().unit));
    return parts;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

  void check_reader() const {
    if (::access(reader_.c_str(), X_OK) == 0) return;
    fail(fmt::format(
        "STEP files cannot be read: this Dismantle was built without Open CASCADE ({} is missing). Install the "
        "package libocct-data-exchange-dev, configure and build again, or export the parts as meshes (3MF, STL)",
        reader_.string()));
  }

  void check_end(const ChildEnd& end) const {
    switch (end.how) {
      case ChildEnd::How::not_started:
        fail(fmt::format("{} cannot be started: {}", reader_.string(), std::strerror(end.code)));
      case ChildEnd::How::timed_out:
        fail(fmt::format("reading it took longer than {:g} s: raise importers.step.time_limit, or {}",
                         params_.time_limit, kOtherFormat));
      case ChildEnd::How::crashed:
        if (out_of_memory(end)) fail_for_memory();
        fail(fmt::format("Open CASCADE crashed on it (signal {}, {}): {}", end.code, ::strsignal(end.code),
                         kOtherFormat));
      case ChildEnd::How::stopped:
        fail(
            fmt::format("what the reader of STEP files sent cannot be used ({}): {}", stream_.problem(), kOtherFormat));
      case ChildEnd::How::exited:
        break;
    }
    if (const auto& failure = stream_.failure()) {
      if (failure->kind == Failure::out_of_memory) fail_for_memory();
      if (failure->kind == Failure::too_many_triangles)
        fail(fmt::format("{}: raise importers.step.linear_deflection or importers.step.triangle_limit", failure->text));
      fail(fmt::format("{}{}", failure->text, said(end)));
    }
    if (stream_.complete() && end.code == 0) return;
    if (out_of_memory(end)) fail_for_memory();
    if (end.code == 127)
      fail(fmt::format("{} cannot be started{}: install Open CASCADE (libocct-data-exchange-dev) again",
                       reader_.string(), said(end)));
    fail(fmt::format("the reader of STEP files ended early (status {}){}: {}", end.code, said(end), kOtherFormat));
  }

  /// What the loader and Open CASCADE write when there is no memory left.
  static bool out_of_memory(const ChildEnd& end) {
    for (const char* text :
         {"bad_alloc", "OutOfMemory", "annot allocate memory", "failed to map segment", "out of memory"})
      if (end.messages.find(text) != std::string::npos) return true;
    return false;
  }

  [[noreturn]] void fail_for_memory() const {
    fail(
        fmt::format("reading it takes more memory than {:g} MiB: raise importers.step.memory_limit, raise "
                    "importers.step.linear_deflection, or {}",
                    params_.memory_limit, kOtherFormat));
  }

  static std::string said(const ChildEnd& end) {
    const std::string words = last_words(end.messages);
    return words.empty() ? "" : fmt::format(" ({})", words);
  }

  const fs::path& file_;
  const StepParams& params_;
  const fs::path& reader_;
  const RunContext& context_;
  StreamReader stream_;
};

}  // namespace

void StepParams::describe(Schema<StepParams>& s) {
  s.add("linear_deflection", &StepParams::linear_deflection,
        {.unit = "1",
         .min = 1e-6,
         .max = 0.5,
         .doc = "Largest distance between a body and its triangles, as a share of the diagonal of the body's box."});
  s.add(
      "assembly_deflection", &StepParams::assembly_deflection,
      {.unit = "1",
       .min = 0,
       .max = 0.5,
       .doc = "The same as a share of the diagonal of the whole assembly; the smaller of both counts. 0 = no bound."});
  s.add("angular_deflection", &StepParams::angular_deflection,
        {.unit = "rad",
         .min = 0.01,
         .max = 1.5,
         .doc = "Largest angle between the directions of a curve, or normals of a surface, at neighbouring vertices."});
  s.add("triangle_limit", &StepParams::triangle_limit,
        {.unit = "1", .min = 1, .max = 1e9, .doc = "A file that gives more triangles is refused."});
  s.add("time_limit", &StepParams::time_limit,
        {.unit = "s", .min = 0, .max = 1e6, .doc = "Reading a file is given up after this time; 0 = no limit."});
  s.add("memory_limit", &StepParams::memory_limit,
        {.unit = "MiB", .min = 0, .max = 1e7, .doc = "Address space of the process that reads a file; 0 = no limit."});
}

StepImporter::StepImporter(const StepParams& params) : StepImporter(params, installed_reader()) {}

StepImporter::StepImporter(const StepParams& params, fs::path reader) : params_(params), reader_(std::move(reader)) {}

std::vector<std::string> StepImporter::extensions() const { return {"step", "stp", "p21"}; }

std::vector<RawPart> StepImporter::read(const fs::path& file, const RunContext& context) {
  check_ends(file);
  return Reading(file, params_, reader_, context).run();
}

}  // namespace dismantle::step_import
