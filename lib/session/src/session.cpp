// Files and configuration -> assembly -> plan.
#include "dismantle/session/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

#include "dismantle/errors.h"
#include "dismantle/executor.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/host/suggest.h"
#include "dismantle/preparation/flexible_parts.h"
#include "dismantle/session/objective.h"
#include "importers.h"
#include "kept_components.h"
#include "planning_setup.h"

namespace dismantle {
namespace {

std::vector<std::string> names_of(const std::vector<RawPart>& parts) {
  std::vector<std::string> names;
  for (const auto& raw : parts) names.push_back(raw.name);
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void check_part(const std::string& part, const std::vector<RawPart>& parts, const std::string& input) {
  const std::vector<std::string> names = names_of(parts);
  for (const auto& raw : parts)
    if (raw.name == part && !raw.problem.empty())
      throw InputError(input, fmt::format("part '{}' cannot be used: {}", part, raw.problem));
  if (part.empty() || contains(names, part)) return;
  std::string text = fmt::format("has no part '{}'", part);
  if (const auto near = nearest(part, names)) {
    text += fmt::format("; did you mean '{}'?", *near);
  } else {
    text += "; its parts:";
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 20); ++i)
      text += fmt::format("{} '{}'", i ? "," : "", names[i]);
    if (names.size() > 20) text += fmt::format(" and {} more", names.size() - 20);
  }
  throw InputError(input, text);
}

/// Removes the parts that `constraints.ignore` names.
std::vector<ExcludedPart> take_ignored(const std::vector<std::string>& ignore, std::vector<RawPart>& parts) {
  std::vector<ExcludedPart> out;
  for (const auto& raw : parts)
    if (contains(ignore, raw.name))
      out.push_back({raw.name, "the configuration says to ignore it (constraints.ignore)", true});
  std::erase_if(parts, [&](const RawPart& raw) { return contains(ignore, raw.name); });
  return out;
}

/// Sequence planners that keep constraints: "'blocking', 'ndbg'". Those that are made of others depend on these, and
/// those that force steps plan nothing by themselves.
std::string constraint_keepers(const Registry& registry) {
  std::string out;
  for (const RegisteredType* type : registry.types(PluginKind::sequence_planner)) {
    const std::vector<ParamSpec>& parameters = type->type.params;
    if (std::any_of(parameters.begin(), parameters.end(), [](const ParamSpec& p) { return p.required; })) continue;
    const SequencePlannerTraits traits = registry.create<SequencePlanner>(type->type.id)->traits();
    if (traits.keeps_constraints && !traits.forces)
      out += fmt::format("{}'{}'", out.empty() ? "" : ", ", type->type.id);
  }
  return out.empty() ? "none of those that were found does" : "these do: " + out;
}

PlanningSetup checked_setup(const RunConfig& config, const Registry& registry, const std::string& part,
                            const Eigen::Vector3d& up) {
  PlanningSetup setup = planning_setup_of(config, registry, up);
  const NamedConstraints& c = config.constraints;
  const bool constrained = !(c.base.empty() && c.together.empty() && c.before.empty() && c.target.empty());
  if (part.empty() && constrained && !setup.sequence_planner->traits().keeps_constraints)
    throw Error(fmt::format("there are constraints, and sequence planner '{}' does not keep any; {}",
                            config.sequence_planner.type, constraint_keepers(registry)));
  return setup;
}

RunContext context_of(unsigned threads, double timeout) {
  RunContext context;
  if (timeout > 0) context.deadline = Deadline::after_seconds(timeout);
  context.threads = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  if (context.threads > 1) context.executor = std::make_shared<Executor>(context.threads);
  return context;
}

}  // namespace

Session::Session(const ConfigSource& settings, std::shared_ptr<Registry> plugins)
    : registry_(plugins != nullptr ? std::move(plugins) : std::make_shared<Registry>()),
      config_(std::make_shared<const RunConfig>(load_config(settings, *registry_))) {}

Session::Session(std::shared_ptr<Registry> plugins) : registry_(std::move(plugins)) { registry_->scan(); }

Session Session::reader(std::shared_ptr<Registry> plugins) {
  return Session(plugins != nullptr ? std::move(plugins) : std::make_shared<Registry>());
}

const RunConfig& Session::config() const {
  if (config_ == nullptr) throw std::logic_error("a session that reads plans has no configuration");
  return *config_;
}

std::string Session::resolved(const std::filesystem::path& folder) const {
  return resolved_yaml(config(), *registry_, folder);
}

RunContext Session::context() const {
  return config_ == nullptr ? context_of(0, 0) : context_of(config_->run.threads, config_->run.timeout);
}

InputParts Session::read(const std::filesystem::path& input, const RunContext& context) const {
  ReadOptions options;
  options.max_triangles = config().assembly.max_triangles;
  return read_input(input, importers_of(*registry_, import_params_of(config(), *registry_)), options, context);
}

LoadedAssembly Session::load(const std::filesystem::path& input, const std::optional<RunContext>& given,
                             const LoadRequest& request) const {
  const RunContext context = given ? *given : this->context();
  return load(read(input, context), input.string(), context, request);
}

LoadedAssembly Session::load(InputParts parts, const std::string& source, const std::optional<RunContext>& given,
                             const LoadRequest& request) const {
  RunContext context = given ? *given : this->context();
  const NamedConstraints& constraints = config().constraints;
  for (const auto& warning : parts.warnings) context.log(LogLevel::warning, warning);
  for (const auto& note : parts.notes) context.log(LogLevel::info, note);
  check_part(request.part, parts.parts, source);
  check_constraint_names(config(), names_of(parts.parts), source);
  const std::vector<ExcludedPart> ignored = take_ignored(constraints.ignore, parts.parts);
  LoadedAssembly out;
  PrepareReport& report = request.report != nullptr ? *request.report : out.report;
  Assembly assembly = [&] {
    try {
      return prepare_assembly(std::move(parts.parts), source, parts.sha256, config().assembly, context, report);
    } catch (const InputError&) {
      add_findings(parts, report);
      throw;
    }
  }();
  add_findings(parts, report);
  fasteners::recognise_kinds(assembly, context);
  assembly.import_params = import_params_of(config(), *registry_);
  assembly.reference_order = reference_order_of(parts.reference_order, assembly);
  declare_overlaps(constraints, assembly);
  report.flexible = with_declared(std::move(report.flexible), constraints.flexible, assembly);
  assembly.excluded.insert(assembly.excluded.end(), ignored.begin(), ignored.end());
  state_kinds(config().parts, assembly);
  out.assembly = std::make_shared<const Assembly>(std::move(assembly));
  if (request.report != nullptr) out.report = report;
  out.prepared_with = config().sections.at("assembly");
  out.flexible = constraints.flexible;
  out.overlap = constraints.overlap;
  return out;
}

/// The assembly with the overlaps that this configuration declares. @throws Error when it was prepared for another one.
std::shared_ptr<const Assembly> Session::declared(const LoadedAssembly& loaded) const {
  const NamedConstraints& named = config().constraints;
  std::vector<std::string> names;
  for (const Part& part : loaded.assembly->parts) names.push_back(part.name);
  std::string differ;
  const auto add = [&](const std::string& what) { differ += (differ.empty() ? "" : ", ") + what; };
  for (const auto& [name, value] : config().sections.at("assembly"))
    if (const auto known = loaded.prepared_with.find(name);
        known == loaded.prepared_with.end() || known->second != value)
      add("assembly." + name);
  for (const std::string& name : named.ignore)
    if (contains(names, name)) add(fmt::format("constraints.ignore ('{}')", name));
  const bool alike = named.flexible == loaded.flexible && named.overlap == loaded.overlap;
  if (!alike && !(loaded.flexible.empty() && loaded.overlap.empty())) add("constraints.flexible, constraints.overlap");
  if (!differ.empty())
    throw Error(
        fmt::format("the configuration prepares the assembly differently from the one that was given ({}): load the "
                    "assembly with the configuration that it is planned with",
                    differ));
  for (const auto& part : loaded.assembly->excluded) names.push_back(part.name);
  check_constraint_names(config(), names, loaded.assembly->source);
  if (alike) return loaded.assembly;
  auto out = std::make_shared<Assembly>(*loaded.assembly);  // meshes are shared
  declare_overlaps(named, *out);
  return out;
}

RunOptions Session::options_for(const LoadedAssembly& loaded, const Assembly& assembly, const std::string& part) const {
  RunOptions out = run_options_of(config());
  const Eigen::Vector3d up = up_of(out.layout, assembly);
  out.layout.up = fmt::format("{},{},{}", up.x(), up.y(), up.z());
  out.only_part = part;
  if (part.empty()) out.constraints = constraints_of(config().constraints, assembly);
  out.flexible = with_declared(loaded.report.flexible, config().constraints.flexible, assembly);
  return out;
}

void Session::check(const PlanRequest& request) const {
  checked_setup(config(), *registry_, request.part, Eigen::Vector3d::UnitZ());  // whatever is up
}

/// The steps of an earlier plan that a run goes on from.
static Disassembly steps_of(const Plan& plan, const Assembly& assembly, const PlanRequest& request) {
  if (!request.part.empty()) throw Error("a plan of one part does not go on from another plan");
  if (plan.assembly.sha256 != assembly.sha256)
    throw InputError(assembly.source, "the plan to go on from was made for other files (their SHA-256 differs)");
  if (request.resume_steps != Disassembly::kNow && request.resume_steps > plan.disassembly.size())
    throw Error(fmt::format("the plan to go on from has {} steps, {} cannot be kept", plan.disassembly.size(),
                            request.resume_steps));
  return disassembly_of(plan, assembly, request.resume_steps);
}

/// With what is kept together as one body each.
static std::shared_ptr<const Assembly> with_units(std::shared_ptr<const Assembly> assembly,
                                                  const Constraints& constraints) {
  if (constraints.together.empty()) return assembly;
  auto out = std::make_shared<Assembly>(*assembly);  // meshes are shared
  set_units(*out, constraints);
  return out;
}

RunResult Session::plan(const LoadedAssembly& loaded, const std::optional<RunContext>& given,
                        const PlanRequest& request) const {
  RunContext context = given ? *given : this->context();
  auto assembly = declared(loaded);
  RunOptions options = options_for(loaded, *assembly, request.part);
  if (request.resume != nullptr) options.resume = steps_of(*request.resume, *assembly, request);
  if (request.steps != nullptr) {
    if (!request.part.empty()) throw Error("a plan of one part does not go on from another plan");
    options.resume = *request.steps;
  }
  const PlanningSetup setup = checked_setup(config(), *registry_, request.part, up_of(config().layout, *assembly));
  if (!request.part.empty()) return run(*assembly, setup, options, context, request.on_step);
  const bool keeps = setup.sequence_planner->traits().keeps_constraints;
  const auto components = kept_components(*assembly, config(), keeps, options.resume ? &*options.resume : nullptr);
  keep_together(components, options.constraints);
  assembly = with_units(std::move(assembly), options.constraints);
  RunResult result = run(*assembly, setup, options, context, request.on_step);
  result.plan.assembly.components = plan_components(components, result.plan);
  return result;
}

Plan Session::plan_of(const Disassembly& so_far, const LoadedAssembly& loaded, const PlanRequest& request) const {
  const auto assembly = declared(loaded);
  RunOptions options = options_for(loaded, *assembly, request.part);
  if (!request.part.empty()) return dismantle::plan_of(so_far, *assembly, options);
  const PlanningSetup setup = checked_setup(config(), *registry_, request.part, up_of(config().layout, *assembly));
  const bool keeps = setup.sequence_planner->traits().keeps_constraints;
  const auto components = kept_components(*assembly, config(), keeps, &so_far);
  keep_together(components, options.constraints);
  Plan plan = dismantle::plan_of(so_far, *assembly, options);
  plan.assembly.components = plan_components(components, plan);
  return plan;
}

}  // namespace dismantle
