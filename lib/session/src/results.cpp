// The files that show a plan.
#include <dlfcn.h>

#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/plan_io/page.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/session/session.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

/// The viewer's page without a plan: its place relative to this library, in the install or in a build tree. Empty when
/// there is none.
fs::path viewer_file() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&has_viewer), &info) == 0 || info.dli_fname == nullptr)
    throw Error("the place of the library libdismantle_session is not known");
  const fs::path folder = fs::canonical(info.dli_fname).parent_path();
  std::error_code none;
  for (const char* place : {DISMANTLE_VIEWER, "../share/dismantle/viewer.html"})
    if (fs::exists(folder / place, none)) return (folder / place).lexically_normal();
  return {};
}

}  // namespace

bool has_viewer() { return !viewer_file().empty(); }

std::string page_of(const Plan& plan, const Assembly& assembly, const ExplainSettings& settings) {
  const fs::path file = viewer_file();
  if (file.empty()) throw Error(kNoViewer);
  const std::string page = read_file(file);
  if (page.empty()) throw Error(file.string() + " is empty");
  return to_page(plan, assembly, page, settings);
}

std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly, const fs::path& folder) {
  std::vector<std::string> files = {"plan.json", "plan.glb", "precedence.dot"};
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot be made: " + error.message());
  write_file(folder / "plan.json", to_json(result.plan));
  const auto glb = to_glb(result.plan, assembly);
  write_file(folder / "plan.glb", std::string(glb.begin(), glb.end()));
  write_file(folder / "precedence.dot", to_dot(result.plan, result.precedence));
  if (!has_viewer()) return files;
  write_file(folder / "index.html", page_of(result.plan, assembly, settings_beside(folder / "plan.json")));
  files.insert(files.begin(), "index.html");
  return files;
}

}  // namespace dismantle
