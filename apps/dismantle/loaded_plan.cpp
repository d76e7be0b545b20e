#include "dismantle/loaded_plan.h"

#include <limits>

#include "dismantle/host/planning_setup.h"
#include "dismantle/plan_file.h"
#include "dismantle/preparation/assembly_of_plan.h"
#include "dismantle/settings.h"
#include "dismantle/stopped.h"

namespace dismantle::app {

RunContext context_for_reading(Registry& registry, Console& console) {
  registry.scan();
  warn_of_problems(registry, console);
  RunSettings settings;
  settings.timeout = 0;
  return context_of(settings, console);
}

LoadedPlan load_plan(const std::string& file, const std::string& input, const Registry& registry, RunContext& context) {
  LoadedPlan loaded;
  loaded.plan = read_plan(file);
  const std::string source = source_of(loaded.plan, file, input);
  ReadOptions read;
  read.max_triangles = std::numeric_limits<std::int64_t>::max();
  loaded.assembly = stoppable(context, [&] {
    const auto importers = importers_of(registry, loaded.plan.assembly.import_params);
    return assembly_of_plan(loaded.plan, read_input(source, importers, read, context), source, context);
  });
  return loaded;
}

}  // namespace dismantle::app
