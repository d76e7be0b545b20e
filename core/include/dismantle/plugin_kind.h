/// The kinds of plugin, and the interface that each of them implements.
#pragma once

/// The one list of kinds: X(kind, Interface). Enumeration, names, registry, configuration, reference and contract tests
/// follow from it.
#define DISMANTLE_PLUGIN_KINDS(X)           \
  X(simulator, Simulator)                   \
  X(path_planner, PathPlanner)              \
  X(sequence_planner, SequencePlanner)      \
  X(transfer_planner, TransferPlanner)      \
  X(immobility_prover, ImmobilityProver)    \
  X(step_check, StepCheck)                  \
  X(importer, Importer)

namespace dismantle {

#define DISMANTLE_DECLARE(kind, Interface) class Interface;
DISMANTLE_PLUGIN_KINDS(DISMANTLE_DECLARE)
#undef DISMANTLE_DECLARE

/// The interfaces that plugins implement.
enum class PluginKind {
#define DISMANTLE_VALUE(kind, Interface) kind,
  DISMANTLE_PLUGIN_KINDS(DISMANTLE_VALUE)
#undef DISMANTLE_VALUE
};

/// All kinds, in the order in which they are shown.
inline constexpr PluginKind kPluginKinds[] = {
#define DISMANTLE_VALUE(kind, Interface) PluginKind::kind,
    DISMANTLE_PLUGIN_KINDS(DISMANTLE_VALUE)
#undef DISMANTLE_VALUE
};

/// `PluginKindOf<PathPlanner>::value` is `PluginKind::path_planner`.
template <class Interface>
struct PluginKindOf;
#define DISMANTLE_KIND_OF(kind, Interface)              \
  template <>                                           \
  struct PluginKindOf<Interface> {                      \
    static constexpr PluginKind value = PluginKind::kind; \
  };
DISMANTLE_PLUGIN_KINDS(DISMANTLE_KIND_OF)
#undef DISMANTLE_KIND_OF

}  // namespace dismantle
