#include "deferred_simulator.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stdexcept>

#include "dismantle/errors.h"

namespace dismantle {

DeferredSimulator::DeferredSimulator(Simulator& simulator, const Assembly& assembly, double tolerance,
                                     const RunContext& context)
    : simulator_(simulator), assembly_(assembly), tolerance_(tolerance), context_(context) {
  context_.on_progress = nullptr;
}

/// Null: the run was stopped.
DeferredSimulator::Prepared DeferredSimulator::prepare_now(const RunContext& asking) const {
  RunContext own = context_;
  own.on_progress = asking.on_progress;
  // Searches of forced steps begin after the deadline of all other searches.
  if (asking.deadline.seconds_left() > own.deadline.seconds_left()) own.deadline = asking.deadline;
  Prepared prepared;
  try {
    prepared = simulator_.prepare(assembly_, tolerance_, own);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    if (!own.should_stop()) throw PluginError("simulator", fmt::format("preparing the parts failed: {}", e.what()));
    own.log(LogLevel::debug, fmt::format("preparing the parts was stopped: {}", e.what()));
  } catch (...) {
    throw PluginError("simulator", "preparing the parts threw something that is not a std::exception");
  }
  if (own.should_stop()) return nullptr;
  if (!prepared) throw PluginError("simulator", "preparing the parts gave nothing");
  return prepared;
}

bool DeferredSimulator::ready(const RunContext& asking) const {
  rethrow_failure();
  const Prepared* prepared = prepared_.get(asking, [&]() -> std::optional<Prepared> {
    rethrow_failure();  // failure of the thread that this one waited for
    const auto begin = std::chrono::steady_clock::now();
    try {
      Prepared made = prepare_now(asking);
      seconds_ = seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      stopped_ = made == nullptr;
      return made ? std::optional(std::move(made)) : std::nullopt;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      throw;
    }
  });
  return prepared != nullptr;
}

void DeferredSimulator::rethrow_failure() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

std::shared_ptr<const PreparedAssembly> DeferredSimulator::prepare(const Assembly&, double, RunContext&) {
  throw std::logic_error("the parts are prepared when the first world is needed");
}

std::unique_ptr<World> DeferredSimulator::world(const Assembly& assembly, const PreparedAssembly& /*prepared*/,
                                                const Scene& scene, MotionSpace space) const {
  if (!ready(context_)) throw std::runtime_error("the run was stopped before the parts were prepared");
  const Prepared* prepared = prepared_.get(context_, [] { return std::optional<Prepared>(); });
  return simulator_.world(assembly, **prepared, scene, space);
}

}  // namespace dismantle
