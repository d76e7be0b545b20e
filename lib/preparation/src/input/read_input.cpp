#include "dismantle/preparation/read_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/preparation/sha256.h"
#include "input/folder.h"
#include "input/readers.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

std::string too_many(std::uint64_t count, const std::string& where, std::int64_t limit) {
  return fmt::format(
      "{} triangles{} are more than the limit of {} (assembly.max_triangles): simplify the meshes or raise the limit",
      count, where, limit);
}

/// Thrown above the limit of triangles; refuses the whole input.
class TooLarge : public InputError {
 public:
  using InputError::InputError;
};

class Reader {
 public:
  Reader(const ReadOptions& options, const RunContext& context, InputParts& out)
      : options_(options), context_(context), out_(out) {}

  /// All parts of one file, checked; adds its bytes to the fingerprint.
  std::vector<RawPart> read(const fs::path& file, Importer& importer) {
    stop_if_told(file);
    std::error_code ec;
    const auto bytes = fs::file_size(file, ec);
    if (ec) throw InputError(file.string(), fmt::format("cannot be read: {}", ec.message()));
    if (bytes == 0) throw InputError(file.string(), "the file is empty");
    // No format takes less than four bytes a triangle.
    if (bytes / 4 > static_cast<std::uint64_t>(options_.max_triangles)) {
      const auto count = importer.count_triangles(file);
      if (count && *count > static_cast<std::uint64_t>(options_.max_triangles))
        throw TooLarge(file.string(), too_many(*count, "", options_.max_triangles));
    }
    hash_.add_file(file);
    for (const auto& other : importer.referenced_files(file)) hash_.add_file(other);
    std::vector<RawPart> parts = importer.read(file, listening());
    stop_if_told(file);
    if (parts.empty()) throw InputError(file.string(), "the file holds no mesh");
    for (auto& part : parts) {
      total_ += part.mesh.triangles.size();
      part.name = valid_utf8(part.name);
      part.file = valid_utf8(file.filename().string());
      part.problem = valid_utf8(part.problem);
      for (auto& parent : part.parents) parent = valid_utf8(parent);
      part.product = valid_utf8(part.product);
    }
    return parts;
  }

  /// One file of a folder. An unreadable file becomes an unusable part.
  RawPart read_whole(const fs::path& file, Importer& importer) {
    try {
      return joined(read(file, importer), file);
    } catch (const TooLarge&) {
      throw;
    } catch (const InputError& e) {
      RawPart broken;
      broken.file = valid_utf8(file.filename().string());
      broken.problem = e.what();
      // The subject is the file, which the part's name already tells.
      if (const std::string subject = e.subject() + ": "; broken.problem.starts_with(subject))
        broken.problem.erase(0, subject.size());
      broken.problem = fmt::format("{} cannot be read: {}", broken.file, valid_utf8(broken.problem));
      return broken;
    }
  }

  void add_folder(const fs::path& folder, const Readers& readers) {
    FolderContents contents = contents_of(
        folder, [&](const std::string& extension) { return readers.contains(extension); }, readable(readers));
    const auto& files = contents.meshes;
    if (files.empty())
      throw InputError(folder.string(),
                       fmt::format("no mesh file in this folder ({}){}", readable(readers),
                                   contents.sub_folders ? "; sub-folders are not read, `dismantle plan --each` plans "
                                                          "each of them by itself"
                                                        : ""));
    std::map<std::string, int> stems;
    for (const auto& file : files) ++stems[valid_utf8(file.stem().string())];
    std::size_t done = 0;
    for (const auto& file : files) {
      context_.progress("read", done++, files.size(), file.filename().string());
      RawPart whole = read_whole(file, *readers.at(lower_extension(file)));
      check_total(file);
      whole.name = valid_utf8(file.stem().string());
      if (stems[whole.name] > 1) {
        out_.warnings.push_back(
            fmt::format("several files are called '{}': this one is part '{}'", whole.name, whole.file));
        whole.name = whole.file;
      }
      for (RawPart& part : left_) part.name = fmt::format("{}/{}", whole.name, part.name.empty() ? "part" : part.name);
      out_.parts.push_back(std::move(whole));
      std::ranges::move(left_, std::back_inserter(out_.parts));
      left_.clear();
    }
    if (several_ > 1 && 2 * several_ >= files.size())
      out_.warnings.push_back(fmt::format(
          "{} of the {} files hold several bodies each, and the folder is taken as one assembly with a part "
          "for each file; if each file is an assembly of its own: dismantle plan --each {} -o DIR",
          several_, files.size(), valid_utf8(folder.string())));
    for (RawPart& part : contents.rest) out_.parts.push_back(std::move(part));
    context_.progress("read", done, files.size());
  }

  void add_file(const fs::path& file, const Readers& readers) {
    const auto found = readers.find(lower_extension(file));
    if (found == readers.end())
      throw InputError(file.string(), fmt::format("no importer reads files with the ending '{}' ({})",
                                                  file.extension().string(), readable(readers)));
    context_.progress("read", 0, 1, file.filename().string());
    out_.parts = read(file, *found->second);
    order_ = found->second->reference_order(file, context_);
    check_total(file);
    for (auto& part : out_.parts)
      if (part.name.empty()) part.name = valid_utf8(file.stem().string());
    context_.progress("read", 1, 1);
  }

  std::string fingerprint() { return hash_.hex(); }

  /// With the final names of the parts.
  std::vector<PlanReferenceStep> order() const {
    std::vector<PlanReferenceStep> named;
    for (const ReferenceStep& step : order_) {
      PlanReferenceStep& out = named.emplace_back(PlanReferenceStep{step.step, {}, valid_utf8(step.group), step.up});
      for (const std::uint32_t part : step.parts) out.parts.push_back(out_.parts.at(part).name);
    }
    return named;
  }

 private:
  void stop_if_told(const fs::path& file) const {
    if (context_.should_stop()) throw Error("stopped while reading " + file.string());
  }

  void check_total(const fs::path& file) const {
    if (total_ > static_cast<std::uint64_t>(options_.max_triangles))
      throw TooLarge(file.string(), too_many(total_, " up to this file", options_.max_triangles));
  }

  /// The context for an importer: its warnings and notes are findings about the input.
  RunContext listening() {
    RunContext context = context_;
    context.on_log = [this](LogLevel level, std::string_view text) {
      if (level != LogLevel::warning && level != LogLevel::info) return context_.log(level, text);
      const std::lock_guard lock(mutex_);
      (level == LogLevel::warning ? out_.warnings : out_.notes).push_back(valid_utf8(text));
    };
    return context;
  }

  /// All bodies of a file as one part; those that cannot be used go to `left_`, unless there are no others.
  RawPart joined(std::vector<RawPart> parts, const fs::path& file) {
    if (std::ranges::count_if(parts, [](const RawPart& part) { return part.problem.empty(); }) > 1) ++several_;
    RawPart whole;
    whole.file = valid_utf8(file.filename().string());
    bool first = true;
    for (auto& part : parts) {
      if (!part.problem.empty()) {
        left_.push_back(std::move(part));
        continue;
      }
      if (first) {
        whole.colour = part.colour;
        whole.unit = part.unit;
        whole.mesh = std::move(part.mesh);
        first = false;
        continue;
      }
      if (whole.colour != part.colour) whole.colour.reset();  // there is no one colour for all
      append(whole.mesh, part.mesh);
    }
    if (!first) return whole;
    // The file is the part that is missing.
    auto reason = std::ranges::find_if(left_, [](const RawPart& part) { return !part.by_meaning; });
    if (reason == left_.end()) reason = left_.begin();
    whole.problem = reason->problem;
    whole.by_meaning = reason->by_meaning;
    left_.erase(reason);
    return whole;
  }

  static void append(Mesh& to, const Mesh& from) {
    const auto base = static_cast<std::uint32_t>(to.vertices.size());
    to.vertices.insert(to.vertices.end(), from.vertices.begin(), from.vertices.end());
    for (const auto& t : from.triangles) to.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }

  const ReadOptions& options_;
  const RunContext& context_;
  InputParts& out_;
  Sha256 hash_;
  std::uint64_t total_ = 0;
  std::mutex mutex_;  // importers may warn from several threads
  std::vector<RawPart> left_;
  std::size_t several_ = 0;  // files of a folder with several bodies
  std::vector<ReferenceStep> order_;
};

}  // namespace

InputParts read_input(const fs::path& input, const std::vector<std::shared_ptr<Importer>>& importers,
                      const ReadOptions& options, const RunContext& context) {
  if (input.empty()) throw InputError("", "no input was named");
  std::error_code ec;
  const auto status = fs::status(input, ec);
  if (status.type() == fs::file_type::not_found) throw InputError(input.string(), "there is no such file or folder");
  if (ec) throw InputError(input.string(), fmt::format("cannot be read: {}", ec.message()));
  InputParts out;
  const Readers readers = readers_of(importers);
  Reader reader(options, context, out);
  if (fs::is_directory(status))
    reader.add_folder(input, readers);
  else if (fs::is_regular_file(status))
    reader.add_file(input, readers);
  else
    throw InputError(input.string(), "this is neither a regular file nor a folder");
  make_names_unique(out.parts, out.warnings);
  out.sha256 = reader.fingerprint();
  out.reference_order = reader.order();
  return out;
}

std::vector<ReferenceStep> reference_order_of(const std::vector<PlanReferenceStep>& named, const Assembly& assembly) {
  std::map<std::string, PartId> ids;
  for (const Part& part : assembly.parts) ids.emplace(part.name, part.id);
  std::vector<ReferenceStep> order;
  for (const PlanReferenceStep& step : named) {
    ReferenceStep out{step.step, {}, step.group, step.up};
    for (const std::string& name : step.parts)
      if (const auto known = ids.find(name); known != ids.end()) out.parts.push_back(known->second);
    std::sort(out.parts.begin(), out.parts.end());
    if (!out.parts.empty()) order.push_back(std::move(out));
  }
  return order;
}

void add_findings(const InputParts& input, PrepareReport& report) {
  report.warnings.insert(report.warnings.begin(), input.warnings.begin(), input.warnings.end());
  report.whole.insert(report.whole.begin(), input.warnings.begin(), input.warnings.end());
  report.notes.insert(report.notes.begin(), input.notes.begin(), input.notes.end());
}

}  // namespace dismantle
