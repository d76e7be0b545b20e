// Plan file -> plan and assembly -> verification.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "dismantle/engine/judgement.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/read_file.h"
#include "dismantle/preparation/assembly_of_plan.h"
#include "dismantle/session/session.h"
#include "hold_proofs.h"
#include "importers.h"
#include "with_numbers.h"

namespace dismantle {
namespace {

/// The tolerance of the verification: that of the plan, limited to the largest one for valid plans. A plan states its
/// own scale, so the tolerance is also bounded relative to the size of the assembly. A plan with a wrong scale thus
/// cannot increase it.
double tolerance_of(const Plan& plan, const Assembly& assembly, const RunContext& context) {
  const double most = kLargestTolerance, usual_size = PrepareOptions{}.size;
  if (plan.verified_max_penetration > most)
    context.log(LogLevel::warning,
                fmt::format("the plan was made with a tolerance of {:.3g}; it is verified with {:.3g} assembly units",
                            plan.verified_max_penetration, most));
  const double size = assembly.normalization.scale * assembly.input_box.size().maxCoeff();
  const double tolerance = std::min({plan.verified_max_penetration, most, most / usual_size * size});
  if (std::abs(size - usual_size) > 1e-6)
    context.log(LogLevel::warning,
                fmt::format("the largest edge of the assembly is {:.6g} of the plan's units, usually it is {:g}: the "
                            "tolerance is {:.2g} of it",
                            size, usual_size, tolerance / size));
  return tolerance;
}

/// The immobility prover of a certificate kind, with its defaults; null: there is none.
ProverOfKind prover_of_kind(const Registry& registry) {
  return [&registry](const std::string& kind) -> std::shared_ptr<const ImmobilityProver> {
    if (registry.lookup(PluginKind::immobility_prover, kind) == nullptr) return nullptr;
    return registry.create<ImmobilityProver>(kind);
  };
}

/// Creates step checks. @throws PluginError: there is none of this type.
CheckOfType check_of_type(const Registry& registry) {
  return [&registry](const std::string& type, const ParamSet& parameters) -> std::shared_ptr<const StepCheck> {
    const std::vector<ParamSpec>& specs = registry.find(PluginKind::step_check, type).type.params;
    return registry.create<StepCheck>(type, with_numbers(specs, parameters));
  };
}

RunContext without_limit(const Session& session, const std::optional<RunContext>& given) {
  if (given) return *given;
  RunContext context = session.context();
  context.deadline = Deadline();
  return context;
}

}  // namespace

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

InputParts Session::read(const std::filesystem::path& input, const Plan& plan, const RunContext& context) const {
  ReadOptions options;
  options.max_triangles = std::numeric_limits<std::int64_t>::max();
  return read_input(input, importers_of(*registry_, plan.assembly.import_params), options, context);
}

Assembly Session::assembly_of(const Plan& plan, const std::filesystem::path& input,
                              const std::optional<RunContext>& given) const {
  const RunContext context = without_limit(*this, given);
  return assembly_of(plan, read(input, plan, context), input.string(), context);
}

Assembly Session::assembly_of(const Plan& plan, InputParts parts, const std::string& source,
                              const std::optional<RunContext>& given) const {
  RunContext context = without_limit(*this, given);
  return assembly_of_plan(plan, std::move(parts), source, context);
}

LoadedPlan Session::load_plan(const std::filesystem::path& file, const std::string& input,
                              const std::optional<RunContext>& context) const {
  LoadedPlan loaded;
  loaded.plan = read_plan(file);
  loaded.assembly = assembly_of(loaded.plan, source_of(loaded.plan, file, input), context);
  return loaded;
}

PlanCheck Session::verify(const Plan& plan, const Assembly& assembly, const std::optional<RunContext>& given,
                          const VerifyRequest& request) const {
  RunContext context = without_limit(*this, given);
  VerifyOptions options;
  options.max_penetration = request.tolerance ? *request.tolerance : tolerance_of(plan, assembly, context);
  options.budget = options.budget.times(request.effort);
  if (const SurfaceRepair& r = plan.assembly.repair; r != SurfaceRepair{})
    context.log(LogLevel::warning, fmt::format("the plan was made with weld: {:g}, repair: {}, max_hole: {:g}; "
                                               "surfaces are verified as repaired with these",
                                               r.weld, r.repair, r.max_hole));
  PlanCheck check = check_plan(plan, assembly, options, context, prover_of_kind(*registry_));
  judge_again(check, plan, assembly, check_of_type(*registry_), context);
  check_hold_proofs(check, plan, assembly, context);
  return check;
}

}  // namespace dismantle
