/// The folder that is served: its products, their plans, and the earlier plans of each.
///
///     gear.step                 a product (also a folder of meshes)
///     gear.yaml                 settings of the user, may be missing
///     gear.constraints.yaml     constraints that were chosen in the page
///     gear.notes.yaml           notes on steps, may be missing
///     gear.plan/                the plan; book.pdf, if it was asked for
///     gear.plan.1/, ...         earlier ones, for undo
///     gear.plan.new/            what a running job writes
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dismantle::serve {

/// One product of the folder.
struct Entry {
  std::string name;
  std::filesystem::path input;  ///< empty: only its plan is there
  bool has_plan = false;
  int earlier = 0;  ///< number of earlier plans
};

/// Symbolic links are no part of it. Its functions may be called from several threads.
class Folder {
 public:
  static constexpr int kMaxEarlier = 20;  ///< older plans are deleted

  /// @param extensions of files that can be read, in lower case, with the dot.
  Folder(std::filesystem::path path, std::set<std::string> extensions);

  const std::filesystem::path& path() const { return path_; }
  const std::set<std::string>& extensions() const { return extensions_; }
  std::vector<Entry> entries() const;
  /// Nothing for a name that the folder does not have, whatever it looks like.
  std::optional<Entry> entry(const std::string& name) const;

  std::filesystem::path plan(const std::string& name) const { return path_ / (name + ".plan"); }
  std::filesystem::path fresh(const std::string& name) const { return path_ / (name + ".plan.new"); }
  /// A file, not a link to one.
  bool has_file(const std::filesystem::path& path) const;
  /// The constraints that were chosen in the page; nothing: none.
  std::optional<std::filesystem::path> constraints(const std::string& name) const;
  /// Settings to plan with; nothing: the defaults.
  std::optional<std::filesystem::path> settings(const std::string& name) const;

  /// Notes on steps for the instructions; nothing: none.
  std::optional<std::filesystem::path> notes(const std::string& name) const;

  /// A file of a plan that may be given away; nothing when it is not there or no such file.
  std::optional<std::filesystem::path> plan_file(const std::string& name, const std::string& file) const;
  /// Number of parts and steps, the status, and a text that is another one for another plan. An empty object without a
  /// readable plan.
  nlohmann::json summary(const std::string& name) const;

  /// Makes the fresh plan the plan, and keeps the one before. @throws Error.
  void install(const std::string& name);
  /// Deletes the fresh plan. @throws Error.
  void discard(const std::string& name) const;
  /// Makes the latest earlier plan the plan. False: there is none. @throws Error.
  bool undo(const std::string& name);

 private:
  struct Known {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    nlohmann::json summary;
  };
  std::vector<int> numbers_of_earlier(const std::string& name) const;

  std::filesystem::path path_;
  std::set<std::string> extensions_;
  mutable std::mutex mutex_;  // of what follows, and of changes on the disk
  mutable std::map<std::string, Known> known_;
};

/// The name in lower case from the last dot on; empty without one.
std::string extension_of(const std::string& name);

}  // namespace dismantle::serve
