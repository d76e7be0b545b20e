#include "importers.h"

#include "with_numbers.h"

namespace dismantle {

std::vector<std::shared_ptr<Importer>> importers_of(const Registry& registry, const ImportParameters& params) {
  for (const auto& [id, values] : params) registry.find(PluginKind::importer, id);
  std::vector<std::shared_ptr<Importer>> out;
  for (const RegisteredType* type : registry.types(PluginKind::importer)) {
    const auto given = params.find(type->type.id);
    const ParamSet values = with_numbers(type->type.params, given == params.end() ? ParamSet{} : given->second);
    out.push_back(registry.create<Importer>(type->type.id, values));
  }
  return out;
}

}  // namespace dismantle
