/// What a step check says for the reader of a plan.
#pragma once

#include <string>

namespace dismantle {

/// Hold this part, use this tool, turn the assembly over.
struct StepNote {
  std::string kind;    ///< of the check that wrote it, for programs: "hold"
  std::string text;    ///< one sentence for people
  std::string data{};  ///< a JSON object as text, kept byte for byte; empty: none
  bool operator==(const StepNote&) const = default;
};

}  // namespace dismantle
