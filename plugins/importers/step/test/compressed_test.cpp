// STEP files in gzip and zip: the same parts as unpacked, and archives that are damaged or explode.
#include <gtest/gtest.h>
#include <minizip/zip.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "dismantle/run_context.h"
#include "external_files.h"
#include "read_step.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

std::string two_boxes(const Scratch& scratch) {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(box(10, 6, 4), "Caf\u00e9"), moved(0, 0, 0));
  out.place(root, out.product(box(1, 2, 3), "lid"), moved(20, 0, 0));
  out.write(scratch / "plain.step");
  return bytes_of(scratch / "plain.step");
}

std::filesystem::path gzip(const std::filesystem::path& file, const std::string& text, const char* mode = "wb") {
  const gzFile out = gzopen(file.c_str(), mode);
  EXPECT_EQ(gzwrite(out, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
  EXPECT_EQ(gzclose(out), Z_OK);
  return file;
}

std::filesystem::path zip(const std::filesystem::path& file,
                          const std::vector<std::pair<std::string, std::string>>& entries) {
  const zipFile out = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, text] : entries) {
    zipOpenNewFileInZip(out, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, Z_BEST_SPEED);
    zipWriteInFileInZip(out, text.data(), static_cast<unsigned>(text.size()));
    zipCloseFileInZip(out);
  }
  zipClose(out, nullptr);
  return file;
}

TEST(CompressedStep, HasThePartsOfTheFileInIt) {
  const Scratch scratch;
  const std::string text = two_boxes(scratch);
  const auto plain = read(scratch / "plain.step").parts;
  ASSERT_EQ(plain.size(), 2u);
  const auto twice = gzip(gzip(scratch / "two.stpz", text.substr(0, 900)), text.substr(900), "ab");  // two members
  for (const auto& file : {gzip(scratch / "gzip.stpz", text), gzip(scratch / "named.step", text), twice,
                           zip(scratch / "zip.stpz", {{"readme.txt", "no STEP"}, {"a/Model.STP", text}})}) {
    const auto parts = read(file).parts;
    ASSERT_EQ(parts.size(), plain.size()) << file;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(parts[i].name, plain[i].name);
      EXPECT_EQ(parts[i].unit, plain[i].unit);
      EXPECT_EQ(parts[i].mesh.vertices, plain[i].mesh.vertices);
      EXPECT_EQ(parts[i].mesh.triangles, plain[i].mesh.triangles);
    }
  }
}

TEST(CompressedStep, DamageIsNamed) {
  const Scratch scratch;
  const std::string text = two_boxes(scratch);
  const std::string gz = bytes_of(gzip(scratch / "a.stpz", text));
  const std::string archive = bytes_of(zip(scratch / "b.stpz", {{"a.step", text}}));
  std::string flipped = gz;
  flipped[gz.size() / 2] ^= 0x55;
  for (const auto& [bytes, message] :
       {std::pair{gz.substr(0, gz.size() / 2), "damaged or cut off"},
        {flipped, "damaged or cut off"},
        {archive.substr(0, archive.size() / 2), "cut off"},
        {"PK\x03\x04" + std::string(100, 'x'), "no zip archive"},
        {bytes_of(gzip(scratch / "c.stpz", text.substr(0, text.size() - 40))), "END-ISO-10303-21, is missing"},
        {bytes_of(gzip(scratch / "d.stpz", "solid")), "this is no STEP file"},
        {bytes_of(zip(scratch / "e.stpz", {{"a.txt", text}})), "holds 0 STEP files"},
        {bytes_of(zip(scratch / "f.stpz", {{"a.stp", text}, {"b.stp", text}})), "holds 2 STEP files"}}) {
    const auto file = scratch.write("broken.stpz", bytes);
    const std::string error = input_error([&] { read(file); });
    EXPECT_NE(error.find(message), std::string::npos) << error;
    EXPECT_NE(error.find("broken.stpz"), std::string::npos) << error;
    EXPECT_TRUE(StepImporter({}, STEP_READER).referenced_files(file).empty());
  }
}

TEST(CompressedStep, WhatExplodesIsRefused) {
  const Scratch scratch;
  const std::string blanks = "ISO-10303-21;" + std::string(std::size_t{80} << 20, ' ') + "END-ISO-10303-21;";
  for (const auto& file : {gzip(scratch / "a.stpz", blanks), zip(scratch / "b.stpz", {{"a.stp", blanks}})}) {
    const std::string error = input_error([&] { read(file); });
    EXPECT_NE(error.find("expands from"), std::string::npos) << error;
    EXPECT_NE(error.find("refused"), std::string::npos) << error;
  }
}

TEST(CompressedStep, ExternalReferencesAreThoseOfTheText) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "in");
  const auto refers = [&](const std::string& name) {
    return gzip(scratch / "in/a.stpz", "ISO-10303-21;\n#1=DOCUMENT_FILE('" + name + "','');\nEND-ISO-10303-21;\n");
  };
  scratch.write("outside.stp", empty_step());
  const auto inside = scratch.write("in/b.stp", empty_step());
  EXPECT_EQ(external_files(refers("b.stp")).read, std::vector{inside});
  const auto file = refers("../outside.stp");
  const std::string error = input_error([&] { read(file); });
  EXPECT_NE(error.find("no regular file in its folder"), std::string::npos) << error;
}

}  // namespace
}  // namespace dismantle::step_import
