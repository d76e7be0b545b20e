// A file is replaced as a whole or stays what it was.
#include "dismantle/plan_io/write_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "dismantle/errors.h"

namespace dismantle {
namespace {

class WriteFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "dismantle-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    dir = name;
  }
  void TearDown() override { std::filesystem::remove_all(dir); }
  std::filesystem::path dir;
};

TEST_F(WriteFile, ReplacesTheWholeContentAndLeavesNothingElse) {
  const auto file = dir / "p.json";
  write_file(file, std::string(100'000, 'a'));
  write_file(file, std::string("b\0c", 3));
  std::ifstream in(file, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), std::string("b\0c", 3));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir), {}), 1);
}

TEST_F(WriteFile, NamesTheFileThatCannotBeWritten) {
  for (const auto& file : {dir / "missing" / "p.json", dir}) {
    try {
      write_file(file, "x");
      ADD_FAILURE() << file;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
    }
  }
  EXPECT_TRUE(std::filesystem::is_empty(dir));
}

TEST_F(WriteFile, OneThatCannotBeWrittenWholeLeavesTheOldOne) {
  const auto file = dir / "p.json";
  write_file(file, "old");
  // A limit on the size of files stands for a disk that is full: the write ends part-way.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 12, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_file(file, std::string(1 << 16, 'n')), Error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  std::ifstream in(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir), {}), 1);
}

}  // namespace
}  // namespace dismantle
