/// Uses the installed libraries: samples, preparation and the plugin registry.
#include <dismantle/host/registry.h>
#include <dismantle/preparation/prepare.h>
#include <dismantle/samples/samples.h>

#include <iostream>

int main() {
  dismantle::RunContext context;
  dismantle::PrepareReport report;
  for (const auto& sample : dismantle::samples::list()) {
    const auto assembly =
        dismantle::prepare_assembly(dismantle::samples::make(sample.name), sample.name, "", {}, context, report);
    std::cout << sample.name << " has " << assembly.parts.size() << " parts\n";
  }
  dismantle::Registry registry;
  registry.scan();
}
