#include "dismantle/plan_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/page.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/settings_beside.h"
#include "dismantle/viewer_template.h"

namespace dismantle::app {

namespace fs = std::filesystem;

void remove_old_results(const fs::path& folder, const fs::path& input) {
  for (const char* name : {"index.html", "plan.json", "plan.glb", "precedence.dot", "resolved.yaml"}) {
    const fs::path file = folder / name;
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::equivalent(file, input, error)) continue;
    if (!fs::remove(file, error) || error)
      throw Error(fmt::format("{}: the file of an earlier run cannot be removed: {}", file.string(), error.message()));
  }
}

std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly, const fs::path& folder,
                                       Console& console) {
  write_file(folder / "plan.json", to_json(result.plan));
  const auto glb = to_glb(result.plan, assembly);
  write_file(folder / "plan.glb", std::string(glb.begin(), glb.end()));
  write_file(folder / "precedence.dot", to_dot(result.plan, result.precedence));
  std::vector<std::string> files = {"plan.json", "plan.glb", "precedence.dot", "resolved.yaml"};
  if (const auto page_template = viewer_template()) {
    const ExplainSettings settings = settings_beside(folder / "plan.json");
    write_file(folder / "index.html", to_page(result.plan, assembly, *page_template, settings));
    files.insert(files.begin(), "index.html");
  } else {
    console.warning(std::string("index.html was not written: ") + kNoViewer);
  }
  return files;
}

Saver::Saver(fs::path file, const Assembly& assembly, const RunOptions& options, Console& console, When when)
    : file_(std::move(file)),
      assembly_(assembly),
      options_(options),
      console_(console),
      latest_(options.start.empty() ? Disassembly(assembly.parts.size())
                                    : Disassembly(assembly.parts.size(), options.start)),
      when_(when) {}

void Saver::save() { write_file(file_, to_json(latest())); }

void Saver::operator()(const Disassembly& so_far, const DisassemblyStep& newest) {
  {
    const std::lock_guard lock(mutex_);
    latest_.follow(so_far);
    const auto now = std::chrono::steady_clock::now();
    if (!saved_once_ || when_ == When::every_step || now - saved_ >= std::chrono::seconds(1)) {
      write_file(file_, to_json(plan_of(latest_, assembly_, options_)));
      saved_once_ = true;
      saved_ = now;
    }
  }
  report(newest, so_far.steps().size());  // after saving, so that no reported step is lost
}

Plan Saver::latest() const {
  const std::lock_guard lock(mutex_);
  return plan_of(latest_, assembly_, options_);
}

void Saver::report(const DisassemblyStep& step, std::size_t number) const {
  std::string out, part_way;
  for (const PartId id : step.parts) {
    std::string& names = step.leaves(id) ? out : part_way;
    names += (names.empty() ? "" : ", ") + assembly_.parts[id].name;
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
