/// An immobility prover that follows a script.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "dismantle/engine/run.h"
#include "dismantle/immobility_prover.h"

namespace dismantle::fake {

/// An immobility prover that is one function.
class ScriptedProver final : public ImmobilityProver {
 public:
  /// The function that replaces a proof.
  using Script = std::function<std::optional<Certificate>(const SeparationQuery&, const RunContext&)>;
  ScriptedProver(ProverTraits traits, Script script) : traits_(traits), script_(std::move(script)) {}
  ProverTraits traits() const noexcept override { return traits_; }
  std::optional<Certificate> prove(const SeparationQuery& query, const RunContext& context) const override {
    return script_(query, context);
  }

 private:
  ProverTraits traits_;
  Script script_;
};

/// A prover with this id and script.
inline NamedProver prover(std::string id, ProverTraits traits, ScriptedProver::Script script) {
  return {std::move(id), std::make_shared<ScriptedProver>(traits, std::move(script))};
}

/// A certificate about all parts of a query.
inline Certificate claim(const SeparationQuery& query, std::string text = "claimed") {
  Certificate c;
  for (const auto* list : {&query.moving, &query.fixed})
    for (const PlacedPart& p : *list) c.parts.push_back(p.part);
  c.numbers["parts"] = {static_cast<double>(c.parts.size())};
  c.text = std::move(text);
  return c;
}

}  // namespace dismantle::fake
