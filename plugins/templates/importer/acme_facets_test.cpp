// Tests of acme.facets beyond the laws of its kind, which `dismantle plugins check` tests.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iomanip>

#include "dismantle/host/registry.h"
#include "dismantle/samples/samples.h"

namespace {

namespace fs = std::filesystem;

class AcmeFacets : public testing::Test {
 protected:
  AcmeFacets() : file_(fs::temp_directory_path() / ("acme_facets_" + std::to_string(getpid()) + ".acme_facets")) {
    registry_.load(PLUGIN_FILE);
  }
  ~AcmeFacets() override { fs::remove(file_); }
  std::vector<dismantle::RawPart> read(const std::string& text) {
    std::ofstream(file_) << text;
    return registry_.create<dismantle::Importer>("acme.facets")->read(file_, {});
  }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const dismantle::InputError& e) {
      return e.what();
    }
    return "accepted";
  }
  dismantle::Registry registry_;
  fs::path file_;
};

TEST_F(AcmeFacets, ReadsWhatWasWritten) {
  for (const auto& sample : dismantle::samples::list()) {
    const auto parts = dismantle::samples::make(sample.name);
    std::ostringstream text;
    text << "facets 1\nunit mm\n" << std::setprecision(17);
    for (const auto& part : parts) {
      text << "part " << part.name << '\n';
      for (const auto& v : part.mesh.vertices) text << "v " << v.transpose() << '\n';
      for (const auto& t : part.mesh.triangles) text << "f " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    }
    const auto read_back = read(text.str());
    ASSERT_EQ(read_back.size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(read_back[i].name, parts[i].name);
      EXPECT_EQ(read_back[i].unit, "mm");
      EXPECT_EQ(read_back[i].mesh.vertices, parts[i].mesh.vertices);
      EXPECT_EQ(read_back[i].mesh.triangles, parts[i].mesh.triangles);
    }
  }
}

TEST_F(AcmeFacets, SaysWhatIsWrongAndWhere) {
  EXPECT_NE(refusal("").find("is empty"), std::string::npos);
  EXPECT_NE(refusal("facets 2\n").find("line 1: version 2"), std::string::npos);
  EXPECT_NE(refusal("facets 1\npart a\nv 0 0\n").find("line 3: a vertex is three numbers"), std::string::npos);
  EXPECT_NE(refusal("facets 1\nv 0 0 0\n").find("line 2: 'v' before the first part"), std::string::npos);
  EXPECT_NE(refusal("facets 1\npart a\nv 0 0 0\nf 0 1 2\n").find("'a' has no vertex 1"), std::string::npos);
  EXPECT_NE(refusal("facets 1\npart a\nw 0 0 0\n").find("line 3: 'w' is none of"), std::string::npos);
}

}  // namespace
