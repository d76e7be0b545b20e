// Files of $DISMANTLE_DATA/step, if present: they give as many parts as the folders of meshes made from the same files,
// with the same boxes.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "dismantle/preparation/prepare.h"
#include "dismantle/testing/data_folder.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

namespace fs = std::filesystem;

struct Boxes {
  std::vector<Aabb> parts;
  Aabb all;
};

Aabb box_of_obj(const fs::path& file) {
  Aabb box;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) box.extend(Eigen::Vector3d(x, y, z));
  }
  return box;
}

double millimetres(const std::string& unit) {
  return unit == "inch" ? 25.4 : unit == "m" ? 1000 : unit == "cm" ? 10 : 1;
}

double distance(const Aabb& a, const Aabb& b) { return std::max((a.lo - b.lo).norm(), (a.hi - b.hi).norm()); }

TEST(RealStepFiles, HaveThePartsOfTheirMeshesInTheSamePlaces) {
  const fs::path data = test_data_folder(SOURCE_FOLDER);
  if (!fs::is_directory(data / "step"))
    GTEST_SKIP() << (data / "step").string() << " is not there; DISMANTLE_DATA names the folder of assemblies";
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(data / "step")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty());
  StepImporter importer({}, STEP_READER);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    auto parts = importer.read(file, {});
    std::erase_if(parts, [](const RawPart& part) { return part.by_meaning; });  // coordinate systems
    const fs::path folder = data / "cad" / file.stem();
    std::vector<Aabb> expected;
    Aabb all;
    for (const auto& entry : fs::directory_iterator(folder)) {
      expected.push_back(box_of_obj(entry.path()));
      all.extend(expected.back().lo);
      all.extend(expected.back().hi);
    }
    ASSERT_EQ(parts.size(), expected.size());
    // Each part matches one mesh with the same box; both deviate from the surface by at most 0.1 % of the assembly.
    const double tolerance = 0.003 * all.size().norm();
    std::vector<bool> used(expected.size(), false);
    for (const auto& part : parts) {
      EXPECT_EQ(part.problem, "") << part.name;
      const double mm = millimetres(part.unit);
      const Aabb box{part.mesh.box().lo * mm, part.mesh.box().hi * mm};
      std::size_t best = expected.size();
      for (std::size_t i = 0; i < expected.size(); ++i)
        if (!used[i] && (best == expected.size() || distance(box, expected[i]) < distance(box, expected[best])))
          best = i;
      ASSERT_LT(best, expected.size());
      EXPECT_LT(distance(box, expected[best]), tolerance) << part.name;
      used[best] = true;
    }
  }
}

}  // namespace
}  // namespace dismantle::step_import
