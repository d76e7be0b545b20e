#include "read_in_child.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstring>
#include <span>

#include "dismantle/errors.h"
#include "dismantle/process/child.h"
#include "stream_reader.h"

namespace dismantle::reader_process {
namespace {

namespace fs = std::filesystem;

/// Plain text without escape sequences: libraries colour their messages and quote the untrusted file unchanged.
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

/// The last lines, for a message.
std::string last_lines(const std::string& messages) {
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

/// Recognises the messages of the loader and the libraries when memory has run out.
bool out_of_memory(const process::End& end) {
  for (const char* text :
       {"bad_alloc", "OutOfMemory", "annot allocate memory", "failed to map segment", "out of memory"})
    if (end.last_words.find(text) != std::string::npos) return true;
  return false;
}

std::string said(const process::End& end) {
  const std::string words = last_lines(end.last_words);
  return words.empty() ? "" : fmt::format(" ({})", words);
}

/// Throws the errors of a failed read.
class Failures {
 public:
  Failures(const fs::path& file, const ReaderProgram& program, const ReaderLimits& limits)
      : file_(file), program_(program), limits_(limits) {}

  void check_program() const {
    if (::access(program_.path.c_str(), X_OK) != 0)
      fail(fmt::format("{} cannot be read ({} is missing): {}", program_.formats, program_.path.string(),
                       program_.missing));
  }

  /// `phase`: the last one that the program reported.
  void check(const process::End& end, const StreamReader& stream, const std::string& phase) const {
    if (end.out_of_wall || end.out_of_cpu)
      fail(fmt::format("reading it took longer than {:g} s: raise {}.time_limit, or {}", limits_.seconds,
                       program_.parameters, program_.instead));
    if (end.stopped)
      fail(fmt::format("what the reader of {} sent cannot be used ({}): {}", program_.formats, stream.problem(),
                       program_.instead));
    if (end.signal != 0) {
      if (out_of_memory(end)) fail_for_memory();
      fail(fmt::format("{} crashed on it{} (signal {}, {}){}: {}", program_.library,
                       phase.empty() ? "" : " while " + phase, end.signal, ::strsignal(end.signal), said(end),
                       program_.instead));
    }
    if (const auto& failure = stream.failure()) {
      if (failure->kind == Failure::out_of_memory) fail_for_memory();
      if (failure->kind == Failure::too_many_triangles)
        fail(program_.coarser.empty() ? failure->text
                                      : fmt::format("{}: raise {}.{} or {}.triangle_limit", failure->text,
                                                    program_.parameters, program_.coarser, program_.parameters));
      fail(fmt::format("{}{}", failure->text, said(end)));
    }
    if (stream.complete() && end.status == 0) return;
    if (out_of_memory(end)) fail_for_memory();
    if (end.status == 127)
      fail(
          fmt::format("{} cannot be started{}: install {} again", program_.path.string(), said(end), program_.library));
    fail(fmt::format("the reader of {} ended early (status {}){}: {}", program_.formats, end.status, said(end),
                     program_.instead));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(file_.string(), problem); }

  [[noreturn]] void fail_for_memory() const {
    const std::string coarser =
        program_.coarser.empty() ? "" : fmt::format("raise {}.{}, ", program_.parameters, program_.coarser);
    fail(fmt::format("reading it takes more memory than {:g} MiB: raise {}.memory_limit, {}or {}",
                     static_cast<double>(limits_.memory) / (1024 * 1024), program_.parameters, coarser,
                     program_.instead));
  }

  const fs::path& file_;
  const ReaderProgram& program_;
  const ReaderLimits& limits_;
};

}  // namespace

fs::path installed_reader(const std::string& name) {
  static const char anchor = 0;
  Dl_info info = {};
  if (::dladdr(&anchor, &info) == 0 || info.dli_fname == nullptr) return name;
  std::error_code ec;
  const fs::path found = fs::canonical(info.dli_fname, ec);
  const fs::path above = (ec ? fs::path(info.dli_fname) : found).parent_path().parent_path();
  const fs::path beside = above / "lib" / "dismantle" / name;
  return fs::exists(above / name, ec) || !fs::exists(beside, ec) ? above / name : beside;
}

std::vector<RawPart> read_in_child(const fs::path& file, const ReaderProgram& program,
                                   const std::vector<std::string>& arguments, const ReaderLimits& limits,
                                   std::uint64_t max_triangles, const RunContext& context) {
  const std::string name = file.filename().string();
  const Failures failures(file, program, limits);
  failures.check_program();
  std::string last_phase;
  StreamReader stream(max_triangles, [&](const std::string& phase, std::size_t done, std::size_t total) {
    last_phase = phase;
    context.progress(phase, done, total, name);
  });
  process::Program reader;
  reader.command = {program.path.string(), fs::absolute(file).string()};
  reader.command.insert(reader.command.end(), arguments.begin(), arguments.end());
  reader.limits = {.wall = limits.seconds, .cpu = limits.seconds > 0 ? limits.seconds + 1 : 0, .memory = limits.memory};
  reader.output = [&](std::span<const std::byte> bytes) { return stream.feed(bytes); };
  process::End end;
  try {
    end = process::run(reader, [&] { return context.should_stop(); });
  } catch (const Error& e) {
    throw InputError(file.string(), e.what());
  }
  if (context.should_stop()) throw Error("stopped while reading " + file.string());
  failures.check(end, stream, last_phase);
  for (const auto& warning : stream.warnings()) context.log(LogLevel::warning, fmt::format("{}: {}", name, warning));
  for (const auto& note : stream.notes()) context.log(LogLevel::info, fmt::format("{}: {}", name, note));
  auto parts = stream.take_parts();
  if (parts.empty())
    throw InputError(file.string(), "there is no body in it: nothing but curves, points or empty products");
  context.log(LogLevel::info, fmt::format("{}: {} bodies, lengths in {}", name, parts.size(), parts.front().unit));
  return parts;
}

}  // namespace dismantle::reader_process
