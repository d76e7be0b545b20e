#include "hold_proofs.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "dismantle/engine/judgement.h"
#include "dismantle/engine/run.h"
#include "dismantle/statics/hands_bound.h"
#include "dismantle/statics/model.h"
#include "dismantle/statics/step_proof.h"

namespace dismantle {
namespace {

constexpr const char* kCheck = "gravity";

std::string text_in(const ParamSet& parameters, const char* name) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return "";
  const auto* text = std::get_if<std::string>(&found->second);
  return text == nullptr ? to_text(found->second) : *text;
}

double number_in(const ParamSet& parameters, const char* name, double otherwise) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return otherwise;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) return static_cast<double>(*whole);
  const auto* number = std::get_if<double>(&found->second);
  return number == nullptr ? otherwise : *number;
}

/// What the note of a step says of its holds: the names by state.
struct StatedHolds {
  std::map<std::string, std::vector<std::string>> names;
  bool proved = false;
};

StatedHolds stated_in(const PlanVerdict& verdict) {
  StatedHolds stated;
  for (const StepNote& note : verdict.notes) {
    if (note.kind != "hold") continue;
    const auto data = nlohmann::json::parse(note.data);
    stated.proved = data.value("proved", false);
    for (const auto& hold : data.at("hold"))
      stated.names[hold.at("when").get<std::string>()].push_back(hold.at("part").get<std::string>());
  }
  return stated;
}

/// How the names differ from the bodies that the proof is about; empty: one of each body.
std::string difference(std::vector<std::string> names, const std::vector<std::vector<PartId>>& held,
                       const Assembly& assembly) {
  if (names.size() != held.size())
    return fmt::format("{} holds are proved, and the step states {}", held.size(), names.size());
  for (const std::vector<PartId>& body : held) {
    const auto named = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return std::any_of(body.begin(), body.end(), [&](PartId p) { return assembly.parts[p].name == name; });
    });
    if (named == names.end())
      return fmt::format("a hold of '{}' is proved, and the step does not state it", assembly.parts[body.front()].name);
    names.erase(named);
  }
  return "";
}

/// Empty: the proof of a step holds, and it is what the step states.
std::string problem_of(const PlanVerdict& verdict, const StepQuestion& question, const statics::BuiltPiles& piles) {
  const StatedHolds stated = stated_in(verdict);
  const PlanCertificate* proof =
      verdict.certificate && verdict.certificate->kind == kCheck ? &*verdict.certificate : nullptr;
  statics::StepHolds proved;
  if (proof != nullptr) {
    std::vector<std::string> there;
    for (const PlacedPart& p : statics::joined(question.present, question.moving))
      there.push_back(question.assembly.parts[p.part].name);
    if (!std::is_permutation(there.begin(), there.end(), proof->parts.begin(), proof->parts.end()))
      return "its parts are not those that are there after the step";
    proved = statics::check_step_proof(piles, question, proof->numbers);
    if (!proved.wrong.empty()) return proved.wrong;
  }
  for (const std::string state : {"after", "during", "turning"}) {
    const auto names = stated.names.find(state);
    const std::vector<std::string> said = names == stated.names.end() ? std::vector<std::string>{} : names->second;
    const auto held = proved.held.find(state);
    if (held == proved.held.end()) {
      if (proof != nullptr && stated.proved && !said.empty()) return "the holds '" + state + "' are not proved";
      continue;
    }
    if (state == "turning" && held->second.size() <= 1 && said.empty()) continue;  // a hand is there anyway
    if (const std::string text = difference(said, held->second, question.assembly); !text.empty())
      return fmt::format("'{}': {}", state, text);
  }
  return "";
}

/// Empty: the proof of the hands that any order takes holds, and it is what the plan states.
std::string problem_of_whole(const PlanVerdict& verdict, const Disassembly& done, const Assembly& assembly,
                             const Eigen::Vector3d& up, const statics::BuiltPiles& piles) {
  std::optional<double> stated;
  for (const StepNote& note : verdict.notes)
    if (note.kind == "gravity.hands") stated = nlohmann::json::parse(note.data).at("hands_at_least").get<double>();
  if (!verdict.certificate) return stated ? "how many hands any order takes is stated without a proof" : "";
  if (stated != 2) return "it proves that any order takes two hands, and the plan states something else";
  std::vector<Operation> operations;
  for (std::size_t k = done.steps().size(); k-- > 0;) operations.push_back(operation_of(done, k, assembly, up));
  std::vector<StepQuestion> questions;
  for (const Operation& operation : operations) questions.push_back(operation.question());
  return statics::check_least_hands(piles, questions, verdict.certificate->numbers);
}

}  // namespace

void check_hold_proofs(PlanCheck& check, const Plan& plan, const Assembly& assembly, const RunContext& context) {
  if (!check.valid) return;
  const PlanObjective& objective = plan.objective;
  for (std::size_t c = 0; c < objective.checks.size(); ++c) {
    const PlanObjectiveItem& item = objective.checks[c];
    if (item.type != kCheck) continue;
    const statics::StatedModel model(text_in(item.parameters, "fixed"), number_in(item.parameters, "friction", 0.4),
                                     text_in(item.parameters, "density"));
    const statics::BuiltPiles piles(assembly, model.options(assembly));
    const Disassembly done = disassembly_of(plan, assembly);
    const std::size_t count = done.steps().size();
    std::size_t proofs = 0;
    const auto refuse = [&](unsigned step, const std::string& wrong) {
      check.valid = check.complete = false;
      check.problems.push_back({step, fmt::format("'{}': its proof does not hold: {}", item.type, wrong)});
    };
    const auto readable = [](const auto& problem) -> std::string {
      try {
        return problem();
      } catch (const nlohmann::json::exception& e) {
        return fmt::format("the data of its note cannot be read: {}", e.what());
      }
    };
    if (item.plan && !context.should_stop())
      if (const std::string wrong =
              readable([&] { return problem_of_whole(*item.plan, done, assembly, objective.up, piles); });
          !wrong.empty())
        refuse(0, wrong);
    for (std::size_t k = count; k-- > 0 && !context.should_stop();) {  // in the order of assembly
      const PlanStep& step = plan.disassembly.at(k);
      const PlanVerdict& verdict = step.checks.at(c);
      if (!verdict.certificate) continue;
      ++proofs;
      const bool first = k + 1 == count;
      const Operation operation = operation_of(done, k, assembly, objective.up),
                      earlier = operation_of(done, first ? k : k + 1, assembly, objective.up);
      const StepQuestion before = earlier.question();
      const std::string wrong =
          readable([&] { return problem_of(verdict, operation.question(first ? nullptr : &before), piles); });
      if (!wrong.empty()) refuse(step.step, wrong);
    }
    context.log(LogLevel::info, fmt::format("{} proofs of holds checked", proofs));
  }
}

}  // namespace dismantle
