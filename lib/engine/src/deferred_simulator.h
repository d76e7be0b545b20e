/// Prepares the parts for simulation when the first world is needed.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>

#include "dismantle/computed_once.h"
#include "dismantle/run_context.h"
#include "dismantle/simulator.h"

namespace dismantle {

/// A simulator for one assembly that prepares on demand. Assemblies that come apart along straight lines need no search
/// and no world; preparing fields and hierarchies would be a large part of their run time.
class DeferredSimulator final : public Simulator {
 public:
  /// All references must outlive it. `context` is that of the run: preparing uses its threads, and stops on its
  /// cancellation, or when both its deadline and that of the asking context have passed.
  DeferredSimulator(Simulator& simulator, const Assembly& assembly, double tolerance, const RunContext& context);

  /// Prepares the parts, unless that was done. `asking` receives the progress. False: the run was stopped meanwhile.
  /// @throws Error, the same on every call, if the simulator cannot prepare them.
  bool ready(const RunContext& asking) const;
  /// @throws Error when ready() did.
  void rethrow_failure() const;
  /// Was the run stopped while the parts were prepared?
  bool was_stopped() const { return stopped_; }
  /// Seconds that preparing took.
  double seconds() const { return seconds_; }

  Capabilities capabilities() const noexcept override { return simulator_.capabilities(); }
  std::shared_ptr<const PreparedAssembly> prepare(const Assembly& assembly, double tolerance,
                                                  RunContext& context) override;
  /// `prepared` is not used.
  std::unique_ptr<World> world(const Assembly& assembly, const PreparedAssembly& prepared, const Scene& scene,
                               MotionSpace space) const override;

 private:
  using Prepared = std::shared_ptr<const PreparedAssembly>;
  Prepared prepare_now(const RunContext& asking) const;

  Simulator& simulator_;
  const Assembly& assembly_;
  double tolerance_;
  RunContext context_;
  mutable ComputedOnce<Prepared> prepared_;
  mutable std::mutex mutex_;
  mutable std::exception_ptr failure_;
  mutable std::atomic<bool> stopped_ = false;
  mutable std::atomic<double> seconds_ = 0;
};

}  // namespace dismantle
