// What the screws of a real file clamp, names hidden.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <memory>

#include "dismantle/fasteners/fastening.h"
#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/triangle_bvh.h"
#include "dismantle/session/session.h"
#include "dismantle/testing/data_folder.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

TEST(FasteningsOfRealFiles, ScrewsOfAnActuator) {
  const fs::path file =
      test_data_folder(SOURCE_FOLDER) / "fasteners" / "nema_17_v_slot_belt_driven_actuator_500mm.step";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there; DISMANTLE_DATA names the folder of assemblies";
  const Session session;
  const RunContext context = session.context();
  Assembly assembly = *session.load(file, context).assembly;
  for (Part& part : assembly.parts) part.kind.reset();
  fasteners::recognise_kinds(assembly, context, {.names = false});
  std::vector<std::unique_ptr<TriangleBvh>> surfaces;
  for (const Part& part : assembly.parts) surfaces.push_back(std::make_unique<TriangleBvh>(*part.mesh));
  const auto all = fasteners::fastenings_of(
      assembly, fasteners::fastener_shapes(assembly, context),
      [&](PartId id) -> const TriangleBvh& { return *surfaces[id]; }, context);
  std::map<std::string, int> texts;
  int in_lock_nuts = 0;
  for (const auto& f : all) {
    EXPECT_TRUE(f.faults.empty()) << assembly.parts[f.screw].name;
    ASSERT_FALSE(f.into.empty()) << assembly.parts[f.screw].name;
    EXPECT_FALSE(f.clamps.empty()) << assembly.parts[f.screw].name;
    in_lock_nuts += assembly.parts[f.into.front()].name.find("Lock Nut M5") != std::string::npos;
    ++texts[fasteners::fastening_text(assembly, f)];
  }
  EXPECT_EQ(all.size(), 13u);
  EXPECT_EQ(in_lock_nuts, 5);
  EXPECT_EQ(texts["clamps 'Motor Mount Plate Nema 17' to 'Nema 17 Stepper Motor'; driven into 'Nema 17 Stepper Motor'"],
            4);
  EXPECT_EQ(
      texts["clamps 'Idler Pulley Plate' and 'V-Slot 20x40x500 Linear Rail' together; driven into 'Double Tee Nut#2'"],
      2);
}

}  // namespace
}  // namespace dismantle
