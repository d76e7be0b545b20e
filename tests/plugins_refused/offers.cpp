// Registers 'acme.offered', whatever its list of types says.
#include "dismantle/plugin.h"

namespace {
class Nothing : public dismantle::Importer {
 public:
  std::vector<std::string> extensions() const override { return {}; }
  std::vector<dismantle::RawPart> read(const std::filesystem::path&, const dismantle::RunContext&) override {
    return {};
  }
};
}  // namespace

DISMANTLE_PLUGIN("acme.offers", "1.0.0", "MIT", "https://example.org") {
  r.add<dismantle::Importer, Nothing>("acme.offered", "Reads nothing.");
}
