// Plan files: read, written again, and verified against the parts of a sample, certificates included.
#include "dismantle/plan.h"

#include <set>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/preparation/assembly_of_plan.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/built_in_provers.h"
#include "dismantle/verification/check_plan.h"
#include "expect.h"
#include "input_file.h"
#include "json_mutator.h"

namespace dismantle::fuzz {
namespace {

constexpr double kSeconds = 3;  // of verification; the fuzzer reports what does not stop long after it

/// The sample of which all planned parts are.
std::optional<std::vector<RawPart>> parts_of(const Plan& plan) {
  static const std::vector<std::vector<RawPart>> kSamples = [] {
    std::vector<std::vector<RawPart>> all;
    for (const auto& sample : samples::list()) {
      auto parts = samples::make(sample.name);
      std::size_t triangles = 0;
      for (const RawPart& part : parts) triangles += part.mesh.triangles.size();
      if (triangles <= 600) all.push_back(std::move(parts));
    }
    return all;
  }();
  std::set<std::string> wanted;
  for (const PlanPart& part : plan.assembly.parts) wanted.insert(part.name);
  for (const auto& parts : kSamples) {
    std::vector<RawPart> kept;
    for (const RawPart& part : parts)
      if (wanted.contains(part.name)) kept.push_back(part);
    if (kept.size() == wanted.size() && kept.size() >= 2) return kept;
  }
  return std::nullopt;
}

void verify(const Plan& plan) {
  auto parts = parts_of(plan);
  if (!parts) return;
  RunContext context;
  context.deadline = Deadline::after_seconds(kSeconds);
  InputParts input;
  input.parts = std::move(*parts);
  input.sha256 = plan.assembly.sha256;
  const Assembly assembly = assembly_of_plan(plan, std::move(input), "sample", context);
  VerifyOptions options;
  options.max_penetration = std::min(plan.verified_max_penetration, options.max_penetration);
  const PlanCheck check = check_plan(plan, assembly, options, context, fake::prover_of_kind);
  FUZZ_EXPECT(check.valid || !check.problems.empty());
  FUZZ_EXPECT(!check.valid || check.problems.empty());
}

}  // namespace
}  // namespace dismantle::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  const std::string text(reinterpret_cast<const char*>(data), size);
  Plan plan;
  try {
    plan = plan_from_json(text, "plan.json");
  } catch (const InputError&) {
    return 0;
  }
  const std::string written = to_json(plan);
  FUZZ_EXPECT(to_json(plan_from_json(written, "written")) == written);
  try {
    fuzz::verify(plan);
  } catch (const Error&) {  // the input is not what the plan is for, or the time is up
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  using dismantle::fuzz::JsonMutator;
  if (seed % 4 != 0) {
    auto json = JsonMutator::Json::parse(data, data + size, nullptr, false);
    if (!json.is_discarded()) {
      JsonMutator(seed).mutate(json);
      const std::string text = json.dump(-1, ' ', false, JsonMutator::Json::error_handler_t::replace);
      if (text.size() <= most) {
        std::copy(text.begin(), text.end(), data);
        return text.size();
      }
    }
  }
  return LLVMFuzzerMutate(data, size, most);
}
