/// DISMANTLE_PLUGIN and the ABI tag of the translation unit that includes this. Included by plugin.h.
#pragma once

#include <cstring>
#include <exception>

#include "dismantle/executor.h"
#include "dismantle/geometry/solid.h"
#include "dismantle/part_memo.h"
#include "dismantle/plugin.h"

namespace dismantle::abi {

#define DISMANTLE_INTERFACE(kind, Interface) Interface,
/// Hash of the layout of the types that cross the boundary; solids do so as values of a PartMemo.
inline constexpr std::uint64_t kBoundaryLayout =
    layout_hash<Triangle, Mesh, Pose, Aabb, Part, Normalization, InitialOverlap, ExcludedPart, Assembly, Rgba, RawPart,
                Capabilities, PlacedPart, Scene, BodyState, State, Wrench, Action, Contact, Trace, StepReport, World,
                PreparedAssembly, Outcome, Budget, VerifiedPath, PathCheck, PathChecker, SearchState, Goal, PathQuery,
                SearchStats, PathResult, PathPlannerTraits, SearchStatus, PathSearch, FunctionPathPlanner,
                TransferQuery, Constraints, DisassemblyStep, Disassembly, MotionDepth, MotionDepthOptions, ForcedCut,
                Attempt, ForcedRemoval, AttemptResult, OracleCounts, ForcingOracle, PathOracle, Removal, Unsolved,
                StepQuestion, StepNote, StepVerdict, StepCheckTraits, ObjectiveItem, ObjectiveVerdict, Objective,
                Operation, SequenceQuery, SequencePlannerTraits, SequenceResult, SequenceObserver, Certificate,
                ProverTraits, SeparationQuery, SeparationQuestion, PartMemo, geometry::Solid, Deadline, CancelToken,
                Rng, ProgressEvent, RunContext, Executor, ParamValue, ParamSet, ParamChoice, ParamSpec, PluginChoice,
                PluginRef<PathPlanner>, TypeTraits, PluginType,
                DISMANTLE_PLUGIN_KINDS(DISMANTLE_INTERFACE) Registrar>();
#undef DISMANTLE_INTERFACE
/// The ABI tag of this translation unit.
inline constexpr Text kTag = make_tag(kBoundaryLayout);

/// Builds the struct that a plugin exports, at compile time.
constexpr PluginHeader make_header(const char* id, const char* version, const char* licence, const char* url,
                                   int (*register_types)(void*, char*, std::size_t) noexcept) {
  PluginHeader header;
  header.magic = kPluginMagic;
  header.header_size = sizeof(PluginHeader);
  header.api_major = kPluginApiMajor;
  header.api_minor = kPluginApiMinor;
  put(header.abi_tag, kTag.data);
  put(header.id, id);
  put(header.version, version);
  put(header.licence, licence);
  put(header.url, url);
  header.register_types = register_types;
  return header;
}

/// Runs the plugin's registration; writes the text of an exception to `message`. Returns 0 on success.
inline int guarded(void (*fill)(Registrar&), void* registrar, char* message, std::size_t size) noexcept {
  const auto report = [&](const char* text) {
    if (size == 0) return;
    std::strncpy(message, text, size - 1);
    message[size - 1] = '\0';
  };
  try {
    fill(*static_cast<Registrar*>(registrar));
    return 0;
  } catch (const std::exception& e) {
    report(e.what());
  } catch (...) {
    report("an exception that is no std::exception");
  }
  return 1;
}

}  // namespace dismantle::abi

/// Use once per plugin file, at global scope, followed by the body that registers the types on `r`.
#define DISMANTLE_PLUGIN(plugin_id, plugin_version, plugin_licence, plugin_url)                              \
  static void dismantle_register_types(::dismantle::Registrar& r);                                           \
  static int dismantle_guarded_register(void* registrar, char* message, std::size_t size) noexcept {         \
    return ::dismantle::abi::guarded(&dismantle_register_types, registrar, message, size);                   \
  }                                                                                                          \
  extern "C" __attribute__((visibility("default"))) const ::dismantle::PluginHeader dismantle_plugin_header; \
  constinit const ::dismantle::PluginHeader dismantle_plugin_header = ::dismantle::abi::make_header(         \
      plugin_id, plugin_version, plugin_licence, plugin_url, &dismantle_guarded_register);                   \
  static void dismantle_register_types([[maybe_unused]] ::dismantle::Registrar& r)
