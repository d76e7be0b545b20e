/// The files that samples are written to.
#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "dismantle/samples/samples.h"

namespace dismantle::samples {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Mesh read_back(const std::string& text) {
  Mesh mesh;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3d v;
      for (int k = 0; k < 3; ++k) {
        std::string word;
        words >> word;
        EXPECT_EQ(std::from_chars(word.data(), word.data() + word.size(), v[k]).ec, std::errc{});
      }
      mesh.vertices.push_back(v);
    } else if (kind == "f") {
      Triangle t{};
      for (auto& id : t) {
        words >> id;
        --id;
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

class ObjFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = std::filesystem::path(::testing::TempDir()) /
           ("dismantle_obj_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(dir_);
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }
  std::filesystem::path dir_;
};

TEST_F(ObjFiles, ReadBackAsTheSameDoubles) {
  for (const Sample& sample : list()) {
    const auto parts = make(sample.name, {{"rotate_seed", std::int64_t{4}}});
    const auto files = write(parts, dir_ / "made" / sample.name);
    ASSERT_EQ(files.size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(files[i].filename(), parts[i].file);
      const Mesh mesh = read_back(content(files[i]));
      EXPECT_EQ(mesh.vertices, parts[i].mesh.vertices);
      EXPECT_EQ(mesh.triangles, parts[i].mesh.triangles);
    }
  }
}

TEST_F(ObjFiles, AreTheSameBytesEveryTime) {
  const auto a = write(make("machine"), dir_ / "a"), b = write(make("machine"), dir_ / "b");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(content(a[i]), content(b[i]));
}

TEST_F(ObjFiles, FailWhenTheyCannotBeWritten) {
  std::filesystem::create_directories(dir_ / "block.obj");  // a folder where a file should go
  EXPECT_THROW(write(make("peg_in_hole"), dir_), std::filesystem::filesystem_error);
}

}  // namespace
}  // namespace dismantle::samples
