#include "dismantle/plan_io/bill_items.h"

#include <map>
#include <string>

#include "dismantle/geometry/equal_items.h"

namespace dismantle {

std::vector<std::size_t> bill_items(const PlanAssembly& plan, const Assembly& assembly,
                                    const std::vector<geometry::ShapePlacement>& shapes) {
  std::map<std::string, std::string> kind_of;
  for (const PlanPart& part : plan.parts)
    if (part.kind) kind_of[part.name] = part.kind->kind;
  std::vector<std::string> kinds;
  for (const Part& part : assembly.parts) {
    const auto known = kind_of.find(part.name);
    kinds.push_back(known == kind_of.end() ? std::string() : known->second);
  }
  return geometry::equal_items(assembly.parts, shapes, kinds);
}

}  // namespace dismantle
