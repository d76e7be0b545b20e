#include "dismantle/plan_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/catch_up.h"
#include "dismantle/plan_io/page.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/write_file.h"
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
    write_file(folder / "index.html", to_page(result.plan, assembly, *page_template));
    files.insert(files.begin(), "index.html");
  } else {
    console.warning(std::string("index.html was not written: ") + kNoViewer);
  }
  return files;
}

Saver::Saver(fs::path file, Plan plan, Console& console, When when)
    : file_(std::move(file)), console_(console), latest_(std::move(plan)), when_(when) {}

void Saver::save() {
  const std::lock_guard lock(mutex_);
  write_file(file_, to_json(latest_));
}

void Saver::operator()(const Plan& plan) {
  {
    const std::lock_guard lock(mutex_);
    catch_up(latest_, plan);  // copying the whole plan each time would cost quadratic time
    const auto now = std::chrono::steady_clock::now();
    if (!saved_once_ || when_ == When::every_step || now - saved_ >= std::chrono::seconds(1)) {
      write_file(file_, to_json(plan));
      saved_once_ = true;
      saved_ = now;
    }
  }
  report(plan);  // after saving, so that no reported step is lost
}

Plan Saver::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

void Saver::report(const Plan& plan) {
  const PlanStep& step = plan.disassembly.back();
  std::string out, part_way;
  for (const auto& move : step.moves) {
    const bool leaves = std::any_of(step.separates.begin(), step.separates.end(), [&](const auto& group) {
      return std::find(group.begin(), group.end(), move.part) != group.end();
    });
    std::string& names = leaves ? out : part_way;
    names += (names.empty() ? "" : ", ") + move.part;
  }
  if (!out.empty()) out += " out";
  if (!part_way.empty()) out += (out.empty() ? "" : ", ") + part_way + " moved part-way";
  console_.line(fmt::format("step {}: {}, {} left ({:.2f} s)", step.step, out, plan.remaining.size(), step.seconds));
}

}  // namespace dismantle::app
