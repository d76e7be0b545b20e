/// The front door of Dismantle: from files and settings to a verified plan, and from a plan file back to its parts.
///
///     dismantle::Session session({.set = {"run.seed=7"}});           // plugins and configuration
///     const auto gearbox = session.load("gearbox.step");             // files -> assembly
///     const auto result = session.plan(gearbox);                     // assembly -> verified plan
///     write_results(result, *gearbox.assembly, "out");               // plan.json, index.html, ...
///     const auto saved = session.load_plan("out/plan.json");         // plan file -> plan and assembly
///     const bool valid = session.verify(saved.plan, saved.assembly).valid;
///
/// A session does not change after its construction: several threads may use it, and sessions do not influence each
/// other. What belongs to one job (time limit, request to stop, progress, messages) is its RunContext:
///
///     dismantle::RunContext job = session.context();
///     job.on_progress = [](const dismantle::ProgressEvent& event) { ... };
///     job.cancel.cancel();                                           // from any thread or signal handler
///     session.plan(gearbox, job);
///
/// docs/use-as-a-library.md has a whole program.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/engine/run.h"
#include "dismantle/export.h"
#include "dismantle/host/config.h"
#include "dismantle/host/registry.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/run_context.h"
#include "dismantle/verification/check_plan.h"

namespace dismantle {

/// An assembly that is ready to plan with, and what was done to its files.
struct LoadedAssembly {
  std::shared_ptr<const Assembly> assembly;
  PrepareReport report;
  /// The settings that shaped it.
  ParamSet prepared_with{};            ///< section `assembly:`
  std::vector<std::string> flexible{};  ///< `constraints.flexible`
  std::vector<NamedOverlap> overlap{};  ///< `constraints.overlap`
};

/// What Session::load() may be told.
struct LoadRequest {
  std::string part{};               ///< InputError before any work if the input has no usable part of this name
  PrepareReport* report = nullptr;  ///< also receives the report; filled as far as known when load() throws
};

/// What Session::plan() is asked for.
struct PlanRequest {
  std::string part{};  ///< only the path of this part, all others fixed; empty: the whole assembly
  /// Called after each step, from the thread of plan(). What it throws is logged.
  StepObserver on_step{};
  /// A plan for the same input to go on from; null: none. Its first `resume_steps` steps are verified again and kept.
  const Plan* resume = nullptr;
  std::size_t resume_steps = Disassembly::kNow;
  /// The same, as steps of the assembly, such as edited() gives; null: none. Not together with `resume`.
  const Disassembly* steps = nullptr;
};

/// A plan file together with its assembly.
struct LoadedPlan {
  Plan plan;
  Assembly assembly;  ///< the parts in the plan, with the plan's scale
};

/// How strictly a plan is verified.
struct VerifyRequest {
  std::optional<double> tolerance{};  ///< assembly units, > 0; none: tolerance_of()
  double effort = 1;                  ///< multiplies the tests and patches that each proof may take
};

/// Plugins and configuration, and the work that is done with them. A job without a RunContext uses all cores, or
/// `run.threads`; loading and planning end after `run.timeout`, everything else has no limit.
class DISMANTLE_API Session {
 public:
  /// Finds the plugins and reads the configuration. `plugins`: where to look for them; null: the built-in ones and those
  /// of $DISMANTLE_PLUGIN_PATH. @throws ConfigError with all errors of the configuration.
  explicit Session(const ConfigSource& settings = {}, std::shared_ptr<Registry> plugins = nullptr);
  /// A session that reads and verifies plans: it has no configuration and loads no planner. Its config(), load() and
  /// plan() throw std::logic_error.
  static Session reader(std::shared_ptr<Registry> plugins = nullptr);

  const Registry& registry() const { return *registry_; }
  const RunConfig& config() const;
  /// The configuration as a file for `folder` that gives the same plan; see resolved_yaml().
  std::string resolved(const std::filesystem::path& folder) const;
  /// The context of one job, whose clock starts now. Call it on the thread that does the work.
  RunContext context() const;

  /// Does what can fail before there is an assembly. @throws PluginError when a chosen plugin cannot be created, Error
  /// when the sequence planner does not keep constraints and there are some. plan() checks the same.
  void check(const PlanRequest& request = {}) const;

  /// Reads and prepares a folder of mesh files (one part each), or one file with several parts. Warnings are logged.
  /// @throws InputError, ConfigError for names of parts that the input lacks; Error when the context wants to stop.
  LoadedAssembly load(const std::filesystem::path& input, const std::optional<RunContext>& context = {},
                      const LoadRequest& request = {}) const;
  /// The same for parts that do not come from files. `source`: their name in plans and messages.
  LoadedAssembly load(InputParts parts, const std::string& source, const std::optional<RunContext>& context = {},
                      const LoadRequest& request = {}) const;
  /// The parts of an input as its importers give them.
  InputParts read(const std::filesystem::path& input, const RunContext& context) const;

  /// Takes the assembly apart, until the end, the time limit or the request to stop: the result holds every finished
  /// step. @throws Error when the assembly was prepared with other settings; InputError for unknown parts;
  /// StepRefused for a step to go on from; as check().
  RunResult plan(const LoadedAssembly& assembly, const std::optional<RunContext>& context = {},
                 const PlanRequest& request = {}) const;
  /// The plan that states these steps and nothing else: what can be saved before plan() returns. Throws as plan().
  Plan plan_of(const Disassembly& so_far, const LoadedAssembly& assembly, const PlanRequest& request = {}) const;

  /// Reads a plan and its input, with the parameters of importers, the repair and the scale that the plan states.
  /// `input`: the assembly if it has moved; empty: as stated in the plan.
  /// @throws InputError naming what does not match the plan; Error when the context wants to stop.
  LoadedPlan load_plan(const std::filesystem::path& file, const std::string& input = {},
                       const std::optional<RunContext>& context = {}) const;
  /// The assembly of a plan that is in memory.
  Assembly assembly_of(const Plan& plan, const std::filesystem::path& input,
                       const std::optional<RunContext>& context = {}) const;
  /// The same for parts that do not come from files.
  Assembly assembly_of(const Plan& plan, InputParts parts, const std::string& source,
                       const std::optional<RunContext>& context = {}) const;
  /// The parts of an input as they were read for the plan.
  InputParts read(const std::filesystem::path& input, const Plan& plan, const RunContext& context) const;

  /// Checks a plan against the original triangles, independently of its planner. What makes the check less strict than
  /// usual is logged as a warning. PlanCheck::problems says so if the context stopped it.
  PlanCheck verify(const Plan& plan, const Assembly& assembly, const std::optional<RunContext>& context = {},
                   const VerifyRequest& request = {}) const;

 private:
  explicit Session(std::shared_ptr<Registry> plugins);
  std::shared_ptr<const Assembly> declared(const LoadedAssembly& loaded) const;
  RunOptions options_for(const LoadedAssembly& loaded, const Assembly& assembly, const std::string& part) const;

  std::shared_ptr<Registry> registry_;
  std::shared_ptr<const RunConfig> config_;  // null: a reader
};

/// @throws InputError naming the file and the problem.
DISMANTLE_API Plan read_plan(const std::filesystem::path& file);
/// The input of a plan: `named` unless it is empty, else the path in the plan, relative to the working directory or to
/// the plan file. @throws InputError when there is no such file.
DISMANTLE_API std::string source_of(const Plan& plan, const std::filesystem::path& file, const std::string& named = {});

/// Writes plan.json, plan.glb, precedence.dot and index.html to a folder, which is made if needed; returns the names of
/// the files that were written: index.html is left out when this build has no viewer. @throws Error.
DISMANTLE_API std::vector<std::string> write_results(const RunResult& result, const Assembly& assembly,
                                                     const std::filesystem::path& folder);
/// The page that shows a plan in a browser, one file that needs no network. @throws Error with kNoViewer.
/// `settings`: quoted in advice.
DISMANTLE_API std::string page_of(const Plan& plan, const Assembly& assembly, const ExplainSettings& settings = {});
/// The values in resolved.yaml beside a plan file; none if there is no such file.
DISMANTLE_API ExplainSettings settings_beside(const std::filesystem::path& plan);
/// False: this build has no viewer, and writes no pages.
DISMANTLE_API bool has_viewer();
/// Message of a build without the viewer, with the remedy.
inline constexpr const char* kNoViewer =
    "this program was built without the viewer; install nodejs and npm and build again (docs/viewer.md)";

}  // namespace dismantle
