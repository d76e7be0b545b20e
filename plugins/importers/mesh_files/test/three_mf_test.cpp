// 3MF files made here: other model files, prefixes, encodings, units, what is no part, and archives that explode.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <minizip/zip.h>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "mesh_files.h"
#include "test/fixtures.h"

namespace dismantle::mesh_files {
namespace {

using testing::input_error;
using testing::TempFolder;
using Files = std::vector<std::pair<std::string, std::string>>;

const std::string kCore =
    "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
    "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"";
const std::string kRels =
    R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" )"
    R"(Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";

/// An object with a box of this size from the origin.
std::string object(const std::string& id, const std::string& attributes, double x, double y, double z) {
  const Mesh m = testing::box({0, 0, 0}, {x, y, z});
  std::string out = "<object id=\"" + id + "\" " + attributes + "><mesh><vertices>";
  for (const auto& v : m.vertices) out += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", v.x(), v.y(), v.z());
  out += "</vertices><triangles>";
  for (const auto& t : m.triangles) out += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", t[0], t[1], t[2]);
  return out + "</triangles></mesh></object>";
}

std::string model(const std::string& attributes, const std::string& resources, const std::string& build) {
  return "<model " + attributes + " " + kCore + "><resources>" + resources + "</resources><build>" + build +
         "</build></model>";
}

class ThreeMf : public ::testing::Test {
 protected:
  std::vector<RawPart> read(const std::string& root, Files more = {}) {
    more.insert(more.begin(), {{"_rels/.rels", kRels}, {"3D/3dmodel.model", root}});
    return MeshFiles().read(folder_.write("a.3mf", testing::zip(more)), {});
  }
  std::string error(const std::string& root, const Files& more = {}) {
    return input_error([&] { read(root, more); });
  }
  TempFolder folder_;
};

TEST_F(ThreeMf, ObjectsOfOtherModelFilesWithEqualIds) {
  const std::string component =
      "<components><component p:path=\"/3D/o{0}.model\" objectid=\"1\" transform=\"1 0 0 0 1 0 "
      "0 0 1 {0}0 0 0\"/></components></object>";
  const auto parts =
      read(model("unit=\"millimeter\" requiredextensions=\"p\"",
                 object("1", "name=\"own\"", 1, 1, 1) + "<object id=\"2\" name=\"wrapped\">" +
                     fmt::format(fmt::runtime(component), 1) + "<object id=\"3\">" +
                     fmt::format(fmt::runtime(component), 2) + "<object id=\"4\" name=\"lost\">" +
                     fmt::format(fmt::runtime(component), 3),
                 "<item objectid=\"1\"/><item objectid=\"2\"/><item objectid=\"3\"/><item objectid=\"4\"/>"
                 "<item p:path=\"/3D/o1.model\" objectid=\"1\"/>"),
           {{"3D/o1.model", model("unit=\"millimeter\"", object("1", "", 2, 2, 2), "")},
            {"3D/O2.model", model("unit=\"centimeter\"", object("1", "name=\"pin\"", 3, 3, 3), "")}});
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(parts[0].name, "own");
  EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh), 1);
  EXPECT_EQ(parts[1].name, "wrapped");
  EXPECT_DOUBLE_EQ(signed_volume(parts[1].mesh), 8);
  EXPECT_DOUBLE_EQ(parts[1].mesh.box().lo.x(), 10);
  EXPECT_EQ(parts[2].name, "pin");
  EXPECT_NEAR(signed_volume(parts[2].mesh), 27000, 1e-6) << "its own file is in centimetres";
  EXPECT_EQ(parts[3].name, "lost");
  EXPECT_NE(parts[3].problem.find("lacks '3D/o3.model'"), std::string::npos) << parts[3].problem;
  EXPECT_FALSE(parts[3].by_meaning);
  EXPECT_DOUBLE_EQ(signed_volume(parts[4].mesh), 8);
}

TEST_F(ThreeMf, PrefixesAndUtf16) {
  std::string prefixed =
      "<m:model unit=\"micron\" xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><m:resources>";
  for (const char c : object("1", "name='a &lt;&#228;&gt;'", 1, 2, 3)) {
    prefixed += c;
    if (prefixed.ends_with("<")) prefixed += "m:";
    if (prefixed.ends_with("<m:/")) prefixed.replace(prefixed.size() - 4, 4, "</m:");
  }
  prefixed += "</m:resources><m:build><m:item objectid=\"1\"/></m:build></m:model>";
  const auto parts = read(prefixed);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].name, "a <ä>");
  EXPECT_EQ(parts[0].unit, "um");
  EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh), 6);

  const std::string plain = model("", object("1", "name='u'", 1, 2, 3), "<item objectid='1'/>");
  for (const bool big : {false, true}) {
    std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : plain) (wide += big ? '\0' : c) += big ? c : '\0';
    const auto utf16 = read(wide);
    ASSERT_EQ(utf16.size(), 1u);
    EXPECT_EQ(utf16[0].name, "u");
    EXPECT_EQ(utf16[0].unit, "mm");
  }
}

/// Encodings of one byte for each character are those of iconv; others are refused.
TEST_F(ThreeMf, OtherEncodings) {
  const std::string plain = model("", object("1", "name='@'", 1, 2, 3), "<item objectid='1'/>");
  const auto in = [&](const std::string& encoding, const std::string& name) {
    std::string text = plain.substr(plain.find("?>") == plain.npos ? 0 : plain.find("?>") + 2);
    text.replace(text.find('@'), 1, name);
    return "<?xml version=\"1.0\" encoding=\"" + encoding + "\"?>" + text;
  };
  const std::tuple<const char*, const char*, const char*> cases[] = {{"windows-1252", "\x80 \xE4", "€ ä"},
                                                                     {"ISO-8859-1", "\xE4", "ä"},
                                                                     {"ISO-8859-15", "\xA4", "€"},
                                                                     {"windows-1251", "\xC2\xE0\xEB", "Вал"},
                                                                     {"KOI8-R", "\xF7\xC1\xCC", "Вал"}};
  for (const auto& [encoding, bytes, name] : cases) {
    const auto parts = read(in(encoding, bytes));
    ASSERT_EQ(parts.size(), 1u) << encoding;
    EXPECT_EQ(parts[0].name, name) << encoding;
  }
  for (const char* encoding : {"GB18030", "Shift_JIS", "UTF-7", "no-such-encoding", "EBCDIC-US"})
    EXPECT_NE(error(in(encoding, "a")).find("unknown encoding"), std::string::npos) << encoding;
}

TEST_F(ThreeMf, WhatIsNoPartIsNotedAndDoublesAreKept) {
  const auto parts = read(
      model("unit=\"inch\"",
            "<basematerials id='9'><base name='r' displaycolor='#FF000080'/><base name='g' displaycolor='#00FF00'/>"
            "</basematerials>" +
                object("1", "name='part' pid='9' pindex='0'", 1.000000000000001, 1, 1) +
                object("2", "name='support' type='support'", 1, 1, 1) +
                object("3", "name='solid' type='solidsupport'", 1, 1, 1) +
                object("4", "name='other' type='other'", 1, 1, 1) + object("5", "name='spare'", 1, 1, 1),
            "<item objectid='1' transform='0 1 0 1 0 0 0 0 1 0 0 5'/><item objectid='2'/><item objectid='3'/><item "
            "objectid='4'/>"));
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_EQ(parts[0].mesh.box().hi.y(), 1.000000000000001);
  EXPECT_GT(signed_volume(parts[0].mesh), 0) << "the transform mirrors";
  EXPECT_EQ(parts[0].colour, (Rgba{255, 0, 0, 128}));
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_TRUE(parts[i].by_meaning) << parts[i].name;
    EXPECT_FALSE(parts[i].problem.empty());
  }
}

TEST_F(ThreeMf, RefusalsNameTheCause) {
  const std::string one = object("1", "", 1, 1, 1), item = "<item objectid='1'/>";
  EXPECT_NE(
      error(model("requiredextensions='b' xmlns:b='http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02'",
                  one, item))
          .find("requires the extension 'b' (http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02)"),
      std::string::npos);
  EXPECT_NE(error(model("unit='ell'", one, item)).find("length unit 'ell'"), std::string::npos);
  EXPECT_NE(error(model("", one + one, item)).find("two objects have the id 1"), std::string::npos);
  EXPECT_NE(error(model("", one, "<item objectid='7'/>")).find("no object 7"), std::string::npos);
  EXPECT_NE(error(model("", one, "<item objectid='1' transform='1 0 0'/>")).find("twelve"), std::string::npos);
  EXPECT_NE(error(model("", one, "")).find("no items"), std::string::npos);
  EXPECT_NE(error("<model").find("3D/3dmodel.model: line 1"), std::string::npos);
  EXPECT_NE(error("<!DOCTYPE model [<!ENTITY a 'aaaaaaaa'>]>" + model("", one, item)).find("document type"),
            std::string::npos);
  EXPECT_NE(error(model("", "<object id='1'><components><component objectid='1'/></components></object>", item))
                .find("contain themselves"),
            std::string::npos);
}

TEST_F(ThreeMf, AnArchiveThatExplodesIsRefused) {
  const auto file = folder_ / "bomb.3mf";
  const zipFile out = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  ASSERT_NE(out, nullptr);
  zip_fileinfo info{};
  zipOpenNewFileInZip(out, "3D/3dmodel.model", &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 1);
  const std::string blanks(1 << 20, ' ');
  for (int i = 0; i < 100; ++i) zipWriteInFileInZip(out, blanks.data(), static_cast<unsigned>(blanks.size()));
  zipCloseFileInZip(out);
  zipClose(out, nullptr);
  const std::string text = input_error([&] { MeshFiles().read(file, {}); });
  EXPECT_NE(text.find("expands from"), std::string::npos) << text;
}

TEST_F(ThreeMf, APathOfAnUnknownExtensionIsNotIgnored) {
  // Without the path, the object of the same id in this file would stand in for the other.
  std::string text =
      model("unit=\"millimeter\"", object("1", "", 1, 1, 1), "<item p:path=\"/3D/b.model\" objectid=\"1\"/>");
  const std::string year = "production/2015/06";
  text.replace(text.find(year), year.size(), "production/2031/01");
  EXPECT_NE(error(text).find("production/2031/01"), std::string::npos) << error(text);
}

TEST_F(ThreeMf, AnObjectWithAMeshAndComponentsIsAllOfThem) {
  std::string both = object("2", "name=\"both\"", 2, 2, 2);
  both.insert(both.find("</object>"), "<components><component objectid=\"1\"/></components>");
  const auto parts =
      read(model("unit=\"millimeter\"", object("1", "name=\"one\"", 1, 1, 1) + both, "<item objectid=\"2\"/>"));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_DOUBLE_EQ(signed_volume(parts[0].mesh) + signed_volume(parts[1].mesh), 9);
}

}  // namespace
}  // namespace dismantle::mesh_files
