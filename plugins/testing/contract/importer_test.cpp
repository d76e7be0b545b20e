// Laws of all importers with default parameters.
#include "dismantle/importer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "dismantle/engine/run.h"
#include "dismantle/errors.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/preparation/prepare.h"
#include "dismantle/preparation/write_prepared.h"
#include "dismantle/testing/mesh_damage.h"
#include "selection.h"

namespace dismantle::contract {
namespace {

namespace fs = std::filesystem;

/// Measures that are equal for two files with the same surface, also if their triangles share vertices differently.
struct Measures {
  double volume = 0, area = 0;
  Aabb box;
};

Measures measures_of(const Mesh& mesh) { return {signed_volume(mesh), surface_area(mesh), mesh.box()}; }

/// `relative`: allowed rounding of coordinates by the format, relative to the largest coordinate.
void expect_same(const Measures& a, const Measures& b, double relative) {
  const double size = std::max(b.box.lo.cwiseAbs().maxCoeff(), b.box.hi.cwiseAbs().maxCoeff());
  EXPECT_LT((a.box.lo - b.box.lo).cwiseAbs().maxCoeff(), relative * size);
  EXPECT_LT((a.box.hi - b.box.hi).cwiseAbs().maxCoeff(), relative * size);
  EXPECT_NEAR(a.area, b.area, 100 * relative * b.area);
  EXPECT_NEAR(a.volume, b.volume, 100 * relative * size * b.area);
}

struct Format {
  std::function<std::string(const Mesh&)> text;
  bool names_parts = false;
};

/// Writers of a part named "a shaft", for the formats that this test can write.
const std::map<std::string, Format>& formats() {
  const auto number = [](std::ostringstream& out) -> std::ostringstream& {
    out << std::setprecision(17);
    return out;
  };
  static const std::map<std::string, Format> all = {
      {"obj",
       {[number](const Mesh& m) {
          std::ostringstream out;
          number(out) << "o a shaft\n";
          for (const auto& v : m.vertices) out << "v " << v.transpose() << '\n';
          for (const auto& t : m.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
          return out.str();
        },
        true}},
      {"off", {[number](const Mesh& m) {
         std::ostringstream out;
         number(out) << "OFF\n" << m.vertices.size() << ' ' << m.triangles.size() << " 0\n";
         for (const auto& v : m.vertices) out << v.transpose() << '\n';
         for (const auto& t : m.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
         return out.str();
       }}},
      {"ply", {[number](const Mesh& m) {
         std::ostringstream out;
         number(out) << "ply\nformat ascii 1.0\nelement vertex " << m.vertices.size()
                     << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << m.triangles.size()
                     << "\nproperty list uchar int vertex_indices\nend_header\n";
         for (const auto& v : m.vertices) out << v.transpose() << '\n';
         for (const auto& t : m.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
         return out.str();
       }}},
      {"stl", {[number](const Mesh& m) {
         std::ostringstream out;
         number(out) << "solid part\n";
         for (std::size_t t = 0; t < m.triangles.size(); ++t) {
           out << "facet normal 0 0 0\nouter loop\n";
           for (int k = 0; k < 3; ++k) out << "vertex " << m.vertex(t, k).transpose() << '\n';
           out << "endloop\nendfacet\n";
         }
         out << "endsolid part\n";
         return out.str();
       }}},
  };
  return all;
}

class ImporterContract : public testing::TestWithParam<std::string> {
 protected:
  ImporterContract()
      : folder_(fs::temp_directory_path() / ("dismantle_importers_" + std::to_string(getpid()))), importer_(make()) {
    fs::create_directories(folder_);
  }
  ~ImporterContract() override { fs::remove_all(folder_); }

  static std::shared_ptr<Importer> make() { return registry().create<Importer>(GetParam()); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  /// Returns well-formed parts, or sets `refusal` to the text of an InputError that names the file.
  std::vector<RawPart> read(const fs::path& file, std::string& refusal) const {
    SCOPED_TRACE(file.string());
    refusal.clear();
    std::vector<RawPart> parts;
    testing::internal::CaptureStdout();
    EXPECT_NO_THROW(static_cast<void>(importer_->count_triangles(file)));
    try {
      parts = importer_->read(file, {});
    } catch (const InputError& e) {
      refusal = e.what();
      EXPECT_NE(refusal.find(file.filename().string()), std::string::npos) << "the error names the file: " << refusal;
    } catch (const std::exception& e) {
      refusal = e.what();
      ADD_FAILURE() << "what is wrong with a file is an InputError, not: " << e.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << "importers never print";
    for (const RawPart& part : parts) {
      EXPECT_TRUE(!part.by_meaning || !part.problem.empty()) << "what is left out by its meaning says why";
      if (!part.problem.empty()) continue;
      if (!part.unit.empty()) {
        EXPECT_NO_THROW(static_cast<void>(metres_in(part.unit))) << "a unit that is not known: " << part.unit;
      }
      for (const auto& v : part.mesh.vertices) EXPECT_TRUE(v.allFinite());
      for (const auto& t : part.mesh.triangles)
        for (const auto corner : t) EXPECT_LT(corner, part.mesh.vertices.size());
    }
    return parts;
  }

  fs::path folder_;
  std::shared_ptr<Importer> importer_;
};

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ImporterContract);

TEST_P(ImporterContract, DeclaresItselfInFull) {
  const PluginType& type = registry().find(PluginKind::importer, GetParam()).type;
  EXPECT_TRUE(problems_of_schema(type.params).empty());
  EXPECT_FALSE(type.summary.empty());
  const auto endings = importer_->extensions();
  EXPECT_FALSE(endings.empty());
  EXPECT_EQ(std::set<std::string>(endings.begin(), endings.end()).size(), endings.size()) << "each once";
  for (const std::string& ending : endings) {
    EXPECT_FALSE(ending.empty());
    for (const char c : ending)
      EXPECT_TRUE((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')
          << "'" << ending << "': lower-case, without a dot";
  }
  EXPECT_EQ(endings, make()->extensions()) << "constant";
}

TEST_P(ImporterContract, AFileThatIsNotThereIsAnInputError) {
  for (const std::string& ending : importer_->extensions()) {
    std::string refusal;
    EXPECT_TRUE(read(folder_ / ("absent." + ending), refusal).empty());
    EXPECT_FALSE(refusal.empty()) << "accepted";
  }
}

/// No content ends the process; an invalid file is an InputError that names the file.
TEST_P(ImporterContract, BrokenFilesAreInputErrors) {
  Rng rng(61);
  for (const std::string& ending : importer_->extensions()) {
    std::string refusal;
    EXPECT_TRUE(read(write("empty." + ending, ""), refusal).empty());
    EXPECT_FALSE(refusal.empty()) << "an empty file was accepted as " << ending;
    for (int trial = 0; trial < 6; ++trial) {
      std::string bytes(1 + rng.below(2000), '\0');
      for (char& c : bytes) c = static_cast<char>(trial % 2 == 0 ? rng.below(256) : 32 + rng.below(95));
      read(write("noise" + std::to_string(trial) + "." + ending, bytes), refusal);
    }
  }
}

TEST_P(ImporterContract, SameFileSameParts) {
  if (examples(importer_->extensions()).empty()) GTEST_SKIP() << "no examples of its formats were given (--examples)";
  for (const fs::path& file : examples(importer_->extensions())) {
    std::string refusal;
    const auto a = read(file, refusal), b = make()->read(file, {});
    EXPECT_EQ(refusal, "");
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].name, b[i].name);
      EXPECT_EQ(a[i].unit, b[i].unit);
      EXPECT_EQ(a[i].flexible, b[i].flexible);
      EXPECT_EQ(a[i].mesh.vertices, b[i].mesh.vertices);
      EXPECT_EQ(a[i].mesh.triangles, b[i].mesh.triangles);
    }
  }
}

/// Compares an example file with the folder of the same name, which contains each part as an OBJ file.
TEST_P(ImporterContract, ExamplesHoldWhatStandsBesideThem) {
  int compared = 0;
  for (const fs::path& file : examples(importer_->extensions())) {
    const fs::path beside = fs::path(file).replace_extension();
    if (!fs::is_directory(beside)) continue;
    std::string refusal;
    const auto parts = read(file, refusal);
    EXPECT_EQ(refusal, "");
    std::set<std::string> names, expected_names;
    for (const RawPart& part : parts) names.insert(part.name);
    for (const auto& entry : fs::directory_iterator(beside)) expected_names.insert(entry.path().stem().string());
    EXPECT_EQ(names, expected_names) << file;
    for (const RawPart& part : parts) {
      const fs::path reference = beside / (part.name + ".obj");
      if (!fs::exists(reference)) continue;
      const auto same = registry().create<Importer>("mesh_files")->read(reference, {});
      ASSERT_FALSE(same.empty());
      SCOPED_TRACE(part.name);
      expect_same(measures_of(part.mesh), measures_of(same.front().mesh), 1e-5);
    }
    ++compared;
  }
  if (compared == 0) GTEST_SKIP() << "no example has a folder of OBJ files beside it (--examples)";
}

/// The same surface in every format gives the same geometry, and the name if the format has names.
TEST_P(ImporterContract, SameGeometryByEveryFormat) {
  const auto endings = importer_->extensions();
  if (std::none_of(endings.begin(), endings.end(), [](const auto& e) { return formats().contains(e); }))
    GTEST_SKIP() << "it reads none of obj, off, ply, stl";
  Rng rng(62);
  for (int trial = 0; trial < 5; ++trial) {
    const Mesh mesh = shapes::random_solid(rng);
    for (const std::string& ending : endings) {
      const auto format = formats().find(ending);
      if (format == formats().end()) continue;
      SCOPED_TRACE(ending);
      std::string refusal;
      const auto parts = read(write("solid." + ending, format->second.text(mesh)), refusal);
      EXPECT_EQ(refusal, "");
      ASSERT_EQ(parts.size(), 1u);
      EXPECT_EQ(parts[0].mesh.triangles.size(), mesh.triangles.size());
      expect_same(measures_of(parts[0].mesh), measures_of(mesh), 1e-6);
      if (format->second.names_parts) {
        EXPECT_EQ(parts[0].name, "a shaft");
      }
    }
  }
}

/// The centre of the volume.
Eigen::Vector3d centre_of(const Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d &a = mesh.vertex(t, 0), &b = mesh.vertex(t, 1), &c = mesh.vertex(t, 2);
    sum += a.dot(b.cross(c)) / 24 * (a + b + c);
  }
  return sum / signed_volume(mesh);
}

/// Three chiral solids apart from each other, in input units.
std::vector<RawPart> three_solids(Rng& rng) {
  std::vector<RawPart> raw;
  for (int i = 0; i < 3; ++i) {
    raw.push_back({"part " + std::to_string(i), "part.obj", shapes::random_solid(rng)});
    const Eigen::Vector3d away(100.0 * i, rng.uniform(-50, 50), rng.uniform(-50, 50));
    for (auto& v : raw.back().mesh.vertices) v += away;
  }
  return raw;
}

/// What this program writes itself comes back: the same parts, volumes and centres, and no mirror image.
TEST_P(ImporterContract, OwnFilesComeBack) {
  const auto endings = importer_->extensions();
  const auto reads = [&](const char* ending) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  if (!reads("obj") && !reads("glb")) GTEST_SKIP() << "it reads neither obj nor glb";
  Rng rng(63);
  RunContext context;
  PrepareReport report;
  const Assembly assembly = prepare_assembly(three_solids(rng), "three", "", {}, context, report);
  ASSERT_EQ(assembly.parts.size(), 3u);
  const auto expect_back = [&](const std::vector<RawPart>& parts,
                               const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& to_file, double scale,
                               double relative) {
    ASSERT_EQ(parts.size(), assembly.parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Mesh written = *assembly.parts[i].mesh;
      for (auto& v : written.vertices) v = to_file(assembly.normalization.to_input(v));
      EXPECT_EQ(parts[i].problem, "");
      const double volume = signed_volume(written);
      EXPECT_GT(volume, 0);
      EXPECT_NEAR(signed_volume(parts[i].mesh), volume, 1e3 * relative * volume) << parts[i].name;
      EXPECT_LT((centre_of(parts[i].mesh) - centre_of(written)).norm(), 1e3 * relative * 300 * scale) << parts[i].name;
    }
  };
  if (reads("obj")) {
    std::vector<RawPart> parts;
    for (const fs::path& file : write_prepared(assembly, report, folder_ / "prepared"))
      if (file.extension() == ".obj")
        for (RawPart& part : importer_->read(file, {})) {
          EXPECT_FALSE(part.flexible) << "the format cannot say so";
          parts.push_back(std::move(part));
        }
    expect_back(
        parts, [](const Eigen::Vector3d& v) { return v; }, 1, 1e-12);
  }
  if (reads("glb")) {
    const Plan plan = plan_of(Disassembly(assembly.parts.size()), assembly, {});
    const auto bytes = to_glb(plan, assembly);
    const InputFrame frame = input_frame(assembly);
    const auto parts = importer_->read(write("plan.glb", std::string(bytes.begin(), bytes.end())), {});
    for (const RawPart& part : parts) EXPECT_EQ(part.unit, "m");
    expect_back(
        parts, [&](const Eigen::Vector3d& v) -> Eigen::Vector3d { return frame.metres * (frame.to_y_up() * v); },
        frame.metres, 1e-6);
  }
}

TEST_P(ImporterContract, ARequiredExtensionThatIsUnknownIsRefusedByName) {
  const std::string text = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["ACME_fourth_dimension"],
    "extensionsRequired": ["ACME_fourth_dimension"], "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"componentType": 5126, "count": 3,
    "type": "VEC3"}]})";
  const auto endings = importer_->extensions();
  if (std::find(endings.begin(), endings.end(), "gltf") == endings.end())
    GTEST_SKIP() << "it does not read gltf, the only text format with required extensions";
  std::string refusal;
  EXPECT_TRUE(read(write("extended.gltf", text), refusal).empty());
  EXPECT_NE(refusal.find("ACME_fourth_dimension"), std::string::npos) << refusal;
}

TEST_P(ImporterContract, StopsWhenTold) {
  RunContext context;
  context.cancel.cancel();
  for (const std::string& ending : importer_->extensions()) {
    const auto format = formats().find(ending);
    if (format == formats().end()) continue;
    const fs::path file = write("solid." + ending, format->second.text(shapes::box({0, 0, 0}, {1, 1, 1})));
    try {
      importer_->read(file, context);  // a small file may be read before the stop is noticed
    } catch (const InputError& e) {
      ADD_FAILURE() << "the file is not at fault: " << e.what();
    } catch (const Error&) {
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registered, ImporterContract, testing::ValuesIn(ids(PluginKind::importer)), test_name);

}  // namespace
}  // namespace dismantle::contract
