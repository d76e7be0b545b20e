#include "dismantle/plan_io/catch_up.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace dismantle {

void catch_up(Plan& known, const Plan& now) {
  const std::size_t common = std::min(known.disassembly.size(), now.disassembly.size());
  const std::size_t same = common > 0 ? common - 1 : 0;
  known.disassembly.resize(same);
  known.disassembly.insert(known.disassembly.end(), now.disassembly.begin() + static_cast<std::ptrdiff_t>(same),
                           now.disassembly.end());

  // Assembly steps are in reverse order, so all their numbers change. They need not be the reversed disassembly.
  auto& back = known.assembly_steps;
  if (back.size() < same || now.assembly_steps.size() < same) {
    back = now.assembly_steps;
  } else {
    back.erase(back.begin(), back.end() - static_cast<std::ptrdiff_t>(same));
    back.insert(back.begin(), now.assembly_steps.begin(),
                now.assembly_steps.end() - static_cast<std::ptrdiff_t>(same));
    for (std::size_t i = 0; i < back.size(); ++i) back[i].step = now.assembly_steps[i].step;
  }

  known.status = now.status;
  known.assembly_status = now.assembly_status;
  known.assembly_message = now.assembly_message;
  known.remaining = now.remaining;
  known.unsolved = now.unsolved;
  known.certificates = now.certificates;
}

}  // namespace dismantle
