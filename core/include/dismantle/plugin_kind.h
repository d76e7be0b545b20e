/// The kinds of plugin, and the interface that each of them implements.
#pragma once

namespace dismantle {

class Simulator;
class PathPlanner;
class SequencePlanner;
class TransferPlanner;
class ImmobilityProver;
class Importer;

/// The interfaces that plugins implement.
enum class PluginKind { simulator, path_planner, sequence_planner, transfer_planner, immobility_prover, importer };

/// All kinds, in the order in which they are shown.
inline constexpr PluginKind kPluginKinds[] = {PluginKind::simulator, PluginKind::path_planner,
                                              PluginKind::sequence_planner, PluginKind::transfer_planner,
                                              PluginKind::immobility_prover, PluginKind::importer};

/// `PluginKindOf<PathPlanner>::value` is `PluginKind::path_planner`.
template <class Interface>
struct PluginKindOf;
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<Simulator> {
  static constexpr PluginKind value = PluginKind::simulator;
};
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<PathPlanner> {
  static constexpr PluginKind value = PluginKind::path_planner;
};
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<SequencePlanner> {
  static constexpr PluginKind value = PluginKind::sequence_planner;
};
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<TransferPlanner> {
  static constexpr PluginKind value = PluginKind::transfer_planner;
};
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<ImmobilityProver> {
  static constexpr PluginKind value = PluginKind::immobility_prover;
};
/// The kind that the interface belongs to.
template <>
struct PluginKindOf<Importer> {
  static constexpr PluginKind value = PluginKind::importer;
};

}  // namespace dismantle
