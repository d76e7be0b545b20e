#include "dismantle/bench/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/write_file.h"
#include "launch/shell.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

/// Output (standard error included) and exit status of a command.
std::pair<std::string, int> output_of(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw Error(fmt::format("cannot start: {}", command));
  std::string text;
  std::array<char, 4096> buffer;
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  return {text, ::pclose(pipe)};
}

}  // namespace

std::string slurm_script(const SlurmJob& job) {
  const fs::path folder = fs::absolute(job.folder);
  // Slurm parses the script before any shell does: text after a line break in a name would count as another option.
  for (const std::string& name : {job.suite.string(), folder.string()})
    if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
      throw Error(fmt::format("the name '{}' has control characters, and cannot stand in a Slurm script", name));
  std::string out = "#!/bin/bash\n";
  out += fmt::format("#SBATCH --job-name=dismantle-{}\n", job.suite.stem().string());
  out += fmt::format("#SBATCH --array=1-{}\n", job.tasks);
  out += fmt::format("#SBATCH --cpus-per-task={}\n", job.jobs);
  out += fmt::format("#SBATCH --output={}\n", (folder / "slurm-%A_%a.log").string());
  out += "#SBATCH --requeue\n";
  for (const auto& option : job.options) out += fmt::format("#SBATCH {}\n", option);
  out += "# Each task is a shard with a database of its own. Submitted again, it goes on where it stopped.\n";
  for (const char* name : {"DISMANTLE_PLUGIN_PATH", "DISMANTLE_DATA"})
    if (const char* value = std::getenv(name)) out += fmt::format("export {}={}\n", name, shell_quoted(value));
  std::string arguments;
  for (const auto& argument : job.arguments) arguments += " " + shell_quoted(argument);
  out += fmt::format("exec {} bench {} -o {} --shard \"$SLURM_ARRAY_TASK_ID/{}\" --jobs {}{}\n",
                     shell_quoted(job.program.string()), shell_quoted(fs::absolute(job.suite).string()),
                     shell_quoted(folder.string()), job.tasks, job.jobs, arguments);
  return out;
}

Submitted submit(const SlurmJob& job) {
  Submitted out;
  out.script = job.folder / "slurm.sh";
  write_file(out.script, slurm_script(job));
  const auto [text, status] = output_of("sbatch --parsable " + shell_quoted(out.script.string()));
  if (status != 0)
    throw Error(fmt::format("{} was written but not submitted: sbatch says: {}", out.script.string(), text));
  out.id = text.substr(0, text.find_first_of(";\n"));
  return out;
}

}  // namespace dismantle::bench
