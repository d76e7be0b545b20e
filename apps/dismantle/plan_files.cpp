#include "plan_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/write_file.h"
#include "finished_run.h"

namespace dismantle::app {

namespace fs = std::filesystem;

void remove_old_results(const fs::path& folder, const fs::path& input) {
  for (const char* name : {"index.html", "plan.json", "plan.glb", "precedence.dot", "resolved.yaml", kFinishedRun}) {
    const fs::path file = folder / name;
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::equivalent(file, input, error)) continue;
    if (!fs::remove(file, error) || error)
      throw Error(fmt::format("{}: the file of an earlier run cannot be removed: {}", file.string(), error.message()));
  }
}

std::vector<std::string> write_all(const RunResult& result, const Assembly& assembly, const fs::path& folder,
                                   Console& console) {
  std::vector<std::string> files = write_results(result, assembly, folder);
  if (!has_viewer()) console.warning(std::string("index.html was not written: ") + kNoViewer);
  files.emplace_back("resolved.yaml");
  return files;
}

Saver::Saver(fs::path file, const Session& session, const LoadedAssembly& loaded, std::string part, Console& console)
    : file_(std::move(file)),
      session_(session),
      loaded_(loaded),
      part_(std::move(part)),
      console_(console),
      latest_(loaded.assembly->parts.size()) {
  latest();
}

void Saver::save_every_step() {
  every_step_ = true;
  write_file(file_, to_json(latest()));
}

void Saver::operator()(const Disassembly& so_far, const DisassemblyStep& newest) {
  {
    const std::lock_guard lock(mutex_);
    latest_.follow(so_far);
    const auto now = std::chrono::steady_clock::now();
    if (!saved_once_ || every_step_ || now >= next_save_) {
      write_file(file_, to_json(session_.plan_of(latest_, loaded_, {.part = part_})));
      const auto saved = std::chrono::steady_clock::now();
      saved_once_ = true;
      next_save_ = now + std::max<std::chrono::steady_clock::duration>(std::chrono::seconds(1), 20 * (saved - now));
    }
  }
  report(newest, so_far.steps().size());  // after saving, so that no reported step is lost
}

Plan Saver::latest() const {
  const std::lock_guard lock(mutex_);
  return session_.plan_of(latest_, loaded_, {.part = part_});
}

void Saver::report(const DisassemblyStep& step, std::size_t number) const {
  std::string out, part_way;
  for (const PartId id : step.parts) {
    std::string& names = step.leaves(id) ? out : part_way;
    names += (names.empty() ? "" : ", ") + loaded_.assembly->parts[id].name;
  }
  if (!out.empty()) out += " out";
  if (!part_way.empty()) out += (out.empty() ? "" : ", ") + part_way + " moved part-way";
  std::size_t left = 0;
  const std::vector<std::vector<PartId>>& groups = latest_.groups();
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (g == 0 || groups[g].size() > 1) left += groups[g].size();
  console_.line(fmt::format("step {}: {}, {} left ({:.2f} s)", number, out, left, step.seconds));
}

}  // namespace dismantle::app
