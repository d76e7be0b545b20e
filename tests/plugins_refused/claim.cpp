// Two files of this kind claim the id 'acme.claimed'.
#include "dismantle/plugin.h"

namespace {
class Nothing : public dismantle::Importer {
 public:
  std::vector<std::string> extensions() const override { return {}; }
  std::vector<dismantle::RawPart> read(const std::filesystem::path&, const dismantle::RunContext&) override { return {}; }
};
}  // namespace

DISMANTLE_PLUGIN("acme.claim", "1.0.0", "MIT", "https://example.org") {
  r.add<dismantle::Importer, Nothing>("acme.claimed", "Reads nothing.");
}
