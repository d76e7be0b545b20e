/// An oracle with all objects that it refers to, over fake parts and planners.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dismantle/executor.h"
#include "dismantle/testing/fake_planning.h"

namespace dismantle::fake {

/// The oracle of the engine on an assembly and a set-up of a test.
struct Rig {
  Rig(Assembly a, PlanningSetup i, unsigned threads = 1, RunOptions o = {})
      : assembly(std::move(a)), parts(std::move(i)), options(o), verifier(assembly, options.verify) {
    context.threads = threads;
    if (threads > 1) context.executor = std::make_shared<Executor>(threads);
    context.rng = Rng(17);
    context.on_log = [this](LogLevel level, std::string_view text) {
      if (level == LogLevel::error) errors.emplace_back(text);
    };
    oracle = make_oracle(assembly, prepared, parts, options, verifier, context);
  }
  const AttemptResult& ask(const Attempt& a) { return oracle->attempt(a, context); }

  Assembly assembly;
  PlanningSetup parts;
  RunOptions options;
  Verifier verifier;
  PreparedAssembly prepared;
  RunContext context;
  std::vector<std::string> errors;
  std::unique_ptr<PathOracle> oracle;
};

}  // namespace dismantle::fake
