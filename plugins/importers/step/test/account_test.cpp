// Every product of a file arrives, or is named: STEP files written by Open CASCADE and changed as text.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "external_files.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

struct Read {
  std::vector<RawPart> parts;
  std::string log;
};

Read read(const std::filesystem::path& file) {
  Read out;
  RunContext context;
  context.on_log = [&](LogLevel, std::string_view text) { out.log += std::string(text) + "\n"; };
  out.parts = StepImporter({}, STEP_READER).read(file, context);
  return out;
}

std::string text_of(StepFile& file, const Scratch& scratch, const char* unit = "MM") {
  file.write(scratch / "written.step", unit);
  std::ifstream in(scratch / "written.step", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string two_parts(const std::string& a, const std::string& b, const Scratch& scratch, const char* unit = "MM") {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(box(10, 6, 4), a), moved(0, 0, 0));
  out.place(root, out.product(box(1, 2, 3), b), moved(20, 0, 0));
  return text_of(out, scratch, unit);
}

std::vector<std::string> names(const Read& in) {
  std::vector<std::string> out;
  for (const auto& part : in.parts) out.push_back(part.name);
  return out;
}

TEST(StepAccount, NamesInOtherEncodings) {
  const Scratch scratch;
  const std::string text = two_parts("NAME_A", "NAME_B", scratch);
  const auto with = [&](const std::string& a, const std::string& b) {
    return read(scratch.write("a.step", replaced(replaced(text, "NAME_A", a), "NAME_B", b)));
  };
  const Read latin = with("Caf\xE9",
                          "\xDC"
                          "berma\xDF");
  EXPECT_EQ(names(latin), (std::vector<std::string>{"Café", "Übermaß"}));
  EXPECT_NE(latin.log.find("Latin-1"), std::string::npos) << latin.log;
  const Read pair = with(
      "Gr\xF6\xDF"
      "e",
      "W\xE4lzlager");
  EXPECT_EQ(names(pair), (std::vector<std::string>{"Größe", "Wälzlager"}));
  const Read chinese = with("\xB3\xDD\xC2\xD6", "\xD6\xE1 2");  // GB18030
  EXPECT_EQ(names(chinese), (std::vector<std::string>{"齿轮", "轴 2"}));
  EXPECT_NE(chinese.log.find("GB18030"), std::string::npos) << chinese.log;
  const Read utf8 = with("Café 日本", "\\X2\\9F7F8F6E\\X0\\ Ü");
  EXPECT_EQ(names(utf8), (std::vector<std::string>{"Café 日本", "齿轮 Ü"}));
  EXPECT_EQ(utf8.log.find("encod"), std::string::npos) << utf8.log;
  EXPECT_EQ(utf8.log.find("UTF-8"), std::string::npos) << utf8.log;
}

/// The product's representation gets a mapped item of itself, by this operator.
std::string mapped(const std::string& operator_text, const Scratch& scratch, const char* unit = "MM") {
  StepFile out;
  out.product(box(10, 6, 4), "bracket");
  std::string text = text_of(out, scratch, unit);
  std::smatch found;
  std::regex shape(R"(#(\d+)\s*=\s*ADVANCED_BREP_SHAPE_REPRESENTATION\(''\s*,\s*\((#\d+),(#\d+)\),\s*(#\d+)\s*\))");
  if (!std::regex_search(text, found, shape)) throw std::runtime_error("no representation in the file");
  const std::string id = found[1], axes = found[2], context = found[4];
  text = replaced(text, "#" + id + ")", "#90000)");  // the product now has the new one
  text = replaced(text, "#" + id + ",", "#90000,");
  const std::string more = "#90000=SHAPE_REPRESENTATION('',(" + axes + ",#90001,#90002)," + context +
                           ");\n#90001=MAPPED_ITEM('a',#90003," + axes +
                           ");\n#90002=MAPPED_ITEM('b',#90003,#90004);\n" + "#90003=REPRESENTATION_MAP(" + axes + ",#" +
                           id + ");\n" + operator_text;
  const auto end = text.rfind("ENDSEC;");
  return text.insert(end, more);
}

TEST(StepAccount, MappedItemsAreMirroredAndScaled) {
  const Scratch scratch;
  const auto boxes = [&](const std::string& text) {
    const Read in = read(scratch.write("a.step", text));
    EXPECT_EQ(in.parts.size(), 2u) << in.log;
    std::vector<std::pair<Aabb, double>> out;
    for (const auto& part : in.parts) out.emplace_back(part.mesh.box(), signed_volume(part.mesh));
    return out;
  };
  const std::string points =
      "#90010=DIRECTION('',(-1.,0.,0.));\n#90011=DIRECTION('',(0.,1.,0.));\n#90012=DIRECTION('',(0.,0.,1.));\n"
      "#90013=CARTESIAN_POINT('',(-1.,0.,0.));\n#90014=DIRECTION('',(1.,0.,0.));\n";
  const auto mirrored = boxes(mapped(
      "#90004=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#90010,#90011,#90013,1.,#90012);\n" + points, scratch));
  ASSERT_EQ(mirrored.size(), 2u);
  EXPECT_LT((mirrored[0].first.lo - Eigen::Vector3d(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((mirrored[1].first.lo - Eigen::Vector3d(-11, 0, 0)).norm(), 1e-6) << mirrored[1].first.lo.transpose();
  EXPECT_LT((mirrored[1].first.hi - Eigen::Vector3d(-1, 6, 4)).norm(), 1e-6) << mirrored[1].first.hi.transpose();
  EXPECT_NEAR(mirrored[1].second, 240, 1e-6);
  for (const char* unit : {"MM", "INCH"}) {
    const auto scaled =
        boxes(mapped("#90004=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#90014,#90011,#90013,2.,#90012);\n" + points,
                     scratch, unit));
    ASSERT_EQ(scaled.size(), 2u);
    const Eigen::Vector3d size = scaled[0].first.size();
    EXPECT_LT((scaled[1].first.lo - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-6) << unit;
    EXPECT_LT((scaled[1].first.size() - 2 * size).norm(), 1e-6) << unit;
  }
}

TEST(StepAccount, AnOperatorOfAnUnknownKindIsRefused) {
  const Scratch scratch;
  const std::string text = mapped(
      "#90004=CARTESIAN_TRANSFORMATION_OPERATOR_3D_NON_UNIFORM('','','',$,$,#90013,2.,$,3.,4.);\n"
      "#90013=CARTESIAN_POINT('',(0.,0.,0.));\n",
      scratch);
  const std::string error = input_error([&] { read(scratch.write("a.step", text)); });
  EXPECT_NE(error.find("an operator of a kind that is not read"), std::string::npos) << error;
}

TEST(StepAccount, ATessellatedSolidIsReadOrNamed) {
  const Scratch scratch;
  std::string text = two_parts("plate", "cover", scratch);
  // The second part's solid becomes one of a kind that Open CASCADE 7.6 does not know.
  const auto at = text.rfind("MANIFOLD_SOLID_BREP");
  ASSERT_NE(at, std::string::npos);
  const auto end = text.find(';', at);
  text.replace(at, end - at, "TESSELLATED_SOLID('cover',(),$)");
  const auto representation = text.rfind("ADVANCED_BREP_SHAPE_REPRESENTATION");
  text.replace(representation, std::string("ADVANCED_BREP_SHAPE_REPRESENTATION").size(),
               "TESSELLATED_SHAPE_REPRESENTATION");
  const Read in = read(scratch.write("a.step", text));
  ASSERT_EQ(names(in), (std::vector<std::string>{"plate", "cover"})) << in.log;
  EXPECT_EQ(in.parts[0].problem, "");
  EXPECT_NE(in.parts[1].problem.find("TESSELLATED_SOLID"), std::string::npos) << in.parts[1].problem;
  EXPECT_FALSE(in.parts[1].by_meaning);
}

TEST(StepAccount, SeveralLengthUnitsAreReadInMillimetresWithAWarning) {
  const Scratch scratch;
  std::string text = two_parts("a", "b", scratch, "INCH");
  // The last context of the file is in millimetres.
  const auto unit = text.rfind("CONVERSION_BASED_UNIT");
  ASSERT_NE(unit, std::string::npos);
  const auto begin = text.rfind('#', unit), end = text.find(';', unit);
  text.replace(
      begin, end - begin,
      text.substr(begin, text.find('=', begin) - begin) + "=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const Read in = read(scratch.write("a.step", text));
  EXPECT_NE(in.log.find("several length units"), std::string::npos) << in.log;
  ASSERT_EQ(in.parts.size(), 2u);
  EXPECT_EQ(in.parts[0].unit, "mm");
}

std::string refers_to(const std::string& name) {
  return "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=DOCUMENT_FILE('" + name +
         "','',$,#2,'',$);\n#2=DOCUMENT_TYPE('');\nENDSEC;\nEND-ISO-10303-21;\n";
}

TEST(StepExternal, OnlyFilesOfTheFolderAreOpened) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "in/sub");
  for (const char* name : {"outside.stp", "in/a.stp", "in/sub/b.stp"}) scratch.write(name, empty_step());
  std::filesystem::create_symlink("../outside.stp", scratch / "in/link.stp");
  ASSERT_EQ(::mkfifo((scratch / "in/pipe.stp").c_str(), 0600), 0);
  for (const char* name : {"a.stp", "sub/b.stp", "sub/../a.stp", "missing.stp"}) {
    const auto file = scratch.write("in/main.step", refers_to(name));
    EXPECT_TRUE(external_files(file).refused.empty()) << name;
    EXPECT_EQ(external_files(file).read.size(), std::string(name) == "missing.stp" ? 0u : 1u) << name;
  }
  for (const std::string& name : {std::string("../outside.stp"), std::string("link.stp"), std::string("pipe.stp"),
                                  (scratch / "outside.stp").string(), std::string("/dev/zero")}) {
    const auto file = scratch.write("in/main.step", refers_to(name));
    const std::string error = input_error([&] { read(file); });
    EXPECT_NE(error.find("'" + name + "', which is no regular file in its folder"), std::string::npos) << error;
    EXPECT_TRUE(StepImporter({}, STEP_READER).referenced_files(file).empty()) << name;
  }
  // What a file refers to may refer to another.
  scratch.write("in/a.stp", refers_to("../outside.stp"));
  EXPECT_NE(input_error([&] { read(scratch.write("in/main.step", refers_to("a.stp"))); }).find("outside.stp"),
            std::string::npos);
  scratch.write("in/a.stp", refers_to("main.step"));
  EXPECT_EQ(external_files(scratch.write("in/main.step", refers_to("a.stp"))).read.size(), 1u) << "in a circle";
}

}  // namespace
}  // namespace dismantle::step_import
