// Zip archives: their limits, and the messages about headers that are wrong.
#include "zip_archive.h"

#include <gtest/gtest.h>
#include <minizip/zip.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "dismantle/errors.h"

namespace dismantle::reader_process {
namespace {

namespace fs = std::filesystem;

class Zip : public testing::Test {
 protected:
  void SetUp() override {
    file_ = fs::temp_directory_path() / ("dismantle-zip-" + std::to_string(::getpid()) + ".zip");
  }
  void TearDown() override { fs::remove(file_); }

  /// Files of `megabytes` blanks each, and a short one, "a.txt".
  void write(int files, int megabytes) {
    const zipFile out = zipOpen64(file_.c_str(), APPEND_STATUS_CREATE);
    const std::string blanks(1 << 20, ' ');
    for (int i = 0; i <= files; ++i) {
      const std::string name = i == files ? "a.txt" : std::to_string(i);
      zipOpenNewFileInZip(out, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, Z_BEST_SPEED);
      for (int k = 0; i < files && k < megabytes; ++k) zipWriteInFileInZip(out, blanks.data(), 1 << 20);
      if (i == files) zipWriteInFileInZip(out, "hello", 5);
      zipCloseFileInZip(out);
    }
    zipClose(out, nullptr);
  }

  /// Changes a byte behind the signature of the header of "a.txt": of its own ("PK\3\4"), of the list's ("PK\1\2").
  void change(const std::string& signature, std::size_t offset, char value) {
    std::ifstream in(file_, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    bytes.at(bytes.rfind(signature) + offset) = value;
    std::ofstream(file_, std::ios::binary) << bytes;
  }

  /// The error of reading these files, or "".
  std::string error_of(const std::vector<std::string>& names) {
    try {
      ZipArchive archive(file_, "3mf file");
      for (const std::string& name : names) archive.read(name, [](std::string_view) {});
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }

  void expect(const std::string& said) {
    const std::string error = error_of({"a.txt"});
    EXPECT_NE(error.find(said), std::string::npos) << said << " | " << error;
  }

  fs::path file_;
};

TEST(ZipLimits, SmallFilesAndSmallRatiosPass) {
  constexpr std::uint64_t mib = 1 << 20;
  EXPECT_EQ(expands_too_much(10, 64 * mib), "");
  EXPECT_NE(expands_too_much(10, 64 * mib + 1), "");
  EXPECT_EQ(expands_too_much(mib, 100 * mib), "");
  EXPECT_NE(expands_too_much(mib, 101 * mib), "");
  EXPECT_NE(expands_too_much(4096 * mib, 4096 * mib + 1), "");
}

TEST_F(Zip, ManyFilesThatExpandTogetherAreRefused) {
  write(3, 30);
  EXPECT_EQ(error_of({"0", "1", "a.txt"}), "") << "60 MiB";
  EXPECT_NE(error_of({"0", "1", "2"}).find("the archive expands from"), std::string::npos);
  EXPECT_NE(error_of({"0", "0", "0"}).find("the archive expands from"), std::string::npos) << "one, again and again";
  write(1, 70);
  EXPECT_NE(error_of({"0"}).find("'0' in the archive expands from"), std::string::npos);
}

TEST_F(Zip, HeadersThatAreWrongAreNamed) {
  const auto fresh = [&] { write(0, 0); };
  fresh();
  EXPECT_EQ(error_of({"a.txt"}), "");
  EXPECT_NE(error_of({"b.txt"}).find("'b.txt' is not in the archive"), std::string::npos);
  change("PK\1\2", 10, 12);  // method: bzip2
  expect("compressed in a way that is not read (method 12)");
  fresh();
  change("PK\1\2", 8, 1);  // flag
  expect("encrypted");
  fresh();
  change("PK\3\4", 0, 'Q');
  expect("its two headers do not agree");
  fresh();
  change("PK\1\2", 16, 77);  // checksum in the list
  change("PK\3\4", 14, 77);  // and in its own header
  expect("damaged");
  fresh();
  change("PK\3\4", 8, 0);  // its own header says that it is not compressed
  expect("its two headers do not agree");
  fresh();
  fs::resize_file(file_, 20);
  expect("no zip archive");
}

}  // namespace
}  // namespace dismantle::reader_process
