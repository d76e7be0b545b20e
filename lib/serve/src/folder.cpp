#include "folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

#include "access.h"
#include "dismantle/errors.h"

namespace dismantle::serve {
namespace {

namespace fs = std::filesystem;

// Links are not followed: what they point to may be elsewhere.
bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::symlink_status(path, none).type() == fs::file_type::regular;
}
bool is_folder(const fs::path& path) {
  std::error_code none;
  return fs::symlink_status(path, none).type() == fs::file_type::directory;
}

constexpr const char* kPlanEnd = ".plan";

bool is_of_plans(const std::string& name) {
  return name.ends_with(kPlanEnd) || name.find(std::string(kPlanEnd) + ".") != std::string::npos;
}

/// Product and number of a folder with an earlier plan: `gear.plan.2`.
std::optional<std::pair<std::string, int>> earlier_plan(const std::string& name) {
  const std::string mark = std::string(kPlanEnd) + ".";
  const std::size_t at = name.rfind(mark);
  if (at == std::string::npos) return {};
  int number = 0;
  const char* const end = name.data() + name.size();
  const auto [last, error] = std::from_chars(name.data() + at + mark.size(), end, number);
  if (error != std::errc() || last != end || number <= 0) return {};
  return std::pair(name.substr(0, at), number);
}

}  // namespace

std::string extension_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string out = dot == std::string::npos ? "" : name.substr(dot);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

Folder::Folder(fs::path path, std::set<std::string> extensions)
    : path_(std::move(path)), extensions_(std::move(extensions)) {}

std::vector<Entry> Folder::entries() const {
  std::vector<fs::path> files, folders, plans;
  for (const auto& item : fs::directory_iterator(path_)) {
    const std::string name = item.path().filename().string();
    if (!plain_name(name)) continue;
    if (is_file(item.path()) && extensions_.contains(extension_of(name))) files.push_back(item.path());
    if (is_folder(item.path())) (is_of_plans(name) ? plans : folders).push_back(item.path());
  }
  // As `plan --each` names products: a file without its extension, unless several have that name.
  std::map<std::string, int> uses;
  for (const auto& file : files) ++uses[file.stem().string()];
  for (const auto& folder : folders) ++uses[folder.filename().string()];
  std::map<std::string, Entry> out;
  for (const auto& folder : folders) out[folder.filename().string()].input = folder;
  for (const auto& file : files) {
    const std::string stem = file.stem().string();
    out[uses[stem] > 1 ? file.filename().string() : stem].input = file;
  }
  std::map<std::string, int> earlier;
  for (const auto& folder : plans) {
    const std::string name = folder.filename().string();
    if (const auto plan = earlier_plan(name)) ++earlier[plan->first];
    if (name.ends_with(kPlanEnd) && is_file(folder / "plan.json"))
      out[name.substr(0, name.size() - std::string_view(kPlanEnd).size())].has_plan = true;
  }
  std::vector<Entry> entries;
  for (auto& [name, entry] : out) {
    entry.name = name;
    entry.earlier = earlier[name];
    entries.push_back(entry);
  }
  return entries;
}

std::optional<Entry> Folder::entry(const std::string& name) const {
  for (const Entry& entry : entries())
    if (entry.name == name) return entry;
  return {};
}

bool Folder::has_file(const fs::path& path) const { return is_file(path); }

std::optional<fs::path> Folder::constraints(const std::string& name) const {
  const fs::path file = path_ / (name + ".constraints.yaml");
  return is_file(file) ? std::optional(file) : std::nullopt;
}

std::optional<fs::path> Folder::settings(const std::string& name) const {
  if (const auto file = constraints(name)) return file;
  const fs::path file = path_ / (name + ".yaml");
  return is_file(file) ? std::optional(file) : std::nullopt;
}

std::optional<fs::path> Folder::notes(const std::string& name) const {
  const fs::path file = path_ / (name + ".notes.yaml");
  return is_file(file) ? std::optional(file) : std::nullopt;
}

std::optional<fs::path> Folder::plan_file(const std::string& name, const std::string& file) const {
  constexpr std::string_view given[] = {"index.html",     "plan.json",     "plan.glb",
                                        "precedence.dot", "resolved.yaml", "book.pdf"};
  if (std::ranges::find(given, file) == std::end(given)) return {};
  const fs::path folder = plan(name);
  return is_folder(folder) && is_file(folder / file) ? std::optional(folder / file) : std::nullopt;
}

nlohmann::json Folder::summary(const std::string& name) const {
  const auto file = plan_file(name, "plan.json");
  std::error_code gone;  // a job may just install another plan
  if (!file) return nlohmann::json::object();
  const auto time = fs::last_write_time(*file, gone);
  const auto size = gone ? 0 : fs::file_size(*file, gone);
  if (gone) return nlohmann::json::object();
  const std::lock_guard lock(mutex_);
  Known& known = known_[name];
  if (known.summary.is_object() && known.time == time && known.size == size) return known.summary;
  known = {time, size, nlohmann::json::object()};
  std::ifstream in(*file, std::ios::binary);
  const auto plan = nlohmann::json::parse(in, nullptr, false);
  if (!plan.is_object() || !plan.contains("assembly") || !plan.contains("disassembly")) {
    known.summary = {{"status", "unreadable"}};
    return known.summary;
  }
  known.summary = {{"status", plan.value("status", "")},
                   {"time", std::to_string(time.time_since_epoch().count())},
                   {"parts", plan["assembly"].value("parts", nlohmann::json::array()).size()},
                   {"steps", plan["disassembly"].size()}};
  return known.summary;
}

std::vector<int> Folder::numbers_of_earlier(const std::string& name) const {
  std::vector<int> out;
  for (const auto& item : fs::directory_iterator(path_)) {
    const auto plan = earlier_plan(item.path().filename().string());
    if (plan && plan->first == name && is_folder(item.path())) out.push_back(plan->second);
  }
  std::ranges::sort(out);
  return out;
}

void Folder::install(const std::string& name) {
  const std::lock_guard lock(mutex_);
  try {
    const std::vector<int> numbers = numbers_of_earlier(name);
    const auto kept = [&](int number) { return path_ / fmt::format("{}{}.{}", name, kPlanEnd, number); };
    if (is_folder(plan(name))) {
      fs::rename(plan(name), kept(numbers.empty() ? 1 : numbers.back() + 1));
      if (numbers.size() >= kMaxEarlier) fs::remove_all(kept(numbers.front()));
    }
    fs::rename(fresh(name), plan(name));
  } catch (const fs::filesystem_error& e) {
    throw Error(fmt::format("the plan cannot be put in its place: {}", e.what()));
  }
}

void Folder::discard(const std::string& name) const {
  std::error_code error;
  fs::remove_all(fresh(name), error);
  if (error) throw Error(fmt::format("{} cannot be removed: {}", fresh(name).string(), error.message()));
}

bool Folder::undo(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const std::vector<int> numbers = numbers_of_earlier(name);
  if (numbers.empty()) return false;
  try {
    fs::remove_all(plan(name));
    fs::rename(path_ / fmt::format("{}{}.{}", name, kPlanEnd, numbers.back()), plan(name));
  } catch (const fs::filesystem_error& e) {
    throw Error(fmt::format("the earlier plan cannot be put back: {}", e.what()));
  }
  return true;
}

}  // namespace dismantle::serve
