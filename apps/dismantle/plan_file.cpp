#include "dismantle/plan_file.h"

#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"

namespace dismantle::app {

Plan read_plan(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    const auto inside = file / "plan.json";
    throw InputError(file.string(), std::filesystem::exists(inside, error)
                                        ? "is a folder, not a plan file; did you mean " + inside.string() + "?"
                                        : "is a folder, not a plan file");
  }
  if (!std::filesystem::exists(file, error))
    throw InputError(file.string(), "cannot be read: no such file; 'dismantle plan INPUT -o DIR' writes DIR/plan.json");
  return plan_from_json(read_file(file), file.string());
}

std::string source_of(const Plan& plan, const std::filesystem::path& file, const std::string& named) {
  if (!named.empty()) return named;
  const std::filesystem::path source = plan.assembly.source;
  std::error_code error;
  for (const auto& path : {source, file.parent_path() / source})
    if (!source.empty() && std::filesystem::exists(path, error)) return path.string();
  throw InputError(file.string(), "the assembly '" + plan.assembly.source +
                                      "' that this plan is for is neither here nor beside the plan; name it with "
                                      "--assembly");
}

}  // namespace dismantle::app
