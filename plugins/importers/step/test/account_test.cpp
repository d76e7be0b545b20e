// Every product of a file arrives, or is named: STEP files written by Open CASCADE and changed as text.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/run_context.h"
#include "external_files.h"
#include "read_step.h"
#include "scratch.h"
#include "step_files.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using namespace testing;

std::string two_parts(const std::string& a, const std::string& b, const Scratch& scratch, const char* unit = "MM") {
  StepFile out;
  const TDF_Label root = out.assembly("root");
  out.place(root, out.product(box(10, 6, 4), a), moved(0, 0, 0));
  out.place(root, out.product(box(1, 2, 3), b), moved(20, 0, 0));
  return text_of(out, scratch, unit);
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
  EXPECT_EQ(names(read(scratch.write("a.step", "\xEF\xBB\xBF" + text))),
            (std::vector<std::string>{"NAME_A", "NAME_B"}));
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

/// Adds an entity, "#91000", to the items of the representation of the last part of two.
std::string with_item(const std::string& entity, const Scratch& scratch) {
  std::string text = two_parts("plate", "cover", scratch);
  const auto items = text.find('(', text.find('(', text.rfind("ADVANCED_BREP_SHAPE_REPRESENTATION")) + 1);
  text.insert(items + 1, "#91000,");
  return text.insert(text.rfind("ENDSEC;"), entity);
}

TEST(StepAccount, BodiesOfOtherKindsBesideASolidAreNamed) {
  const Scratch scratch;
  const std::string at =
      "#91001=AXIS2_PLACEMENT_3D('',#91002,$,$);\n#91002=CARTESIAN_POINT('',(0.,0.,9.));\n"
      "#91003=AXIS1_PLACEMENT('',#91002,$);\n";
  for (const auto& [entity, type] : std::vector<std::pair<std::string, std::string>>{
           {"CSG_SOLID('',#91004);\n#91004=BLOCK('',#91001,1.,1.,1.)", "CSG_SOLID"},
           {"BLOCK('',#91001,1.,1.,1.)", "BLOCK"},
           {"SPHERE('',1.,#91002)", "SPHERE"},
           {"TORUS('',#91003,2.,1.)", "TORUS"},
           {"RIGHT_CIRCULAR_CYLINDER('',#91003,1.,1.)", "RIGHT_CIRCULAR_CYLINDER"},
           {"EXTRUDED_AREA_SOLID('',$,$,1.)", "EXTRUDED_AREA_SOLID"},
           {"REVOLVED_AREA_SOLID('',$,#91003,1.)", "REVOLVED_AREA_SOLID"},
           {"HALF_SPACE_SOLID('',$,.T.)", "HALF_SPACE_SOLID"},
           {"BOOLEAN_RESULT('',.UNION.,#91000,#91000)", "BOOLEAN_RESULT"},
           {"SWEPT_DISK_SOLID('',$,0.1,$,0.,1.)", "SWEPT_DISK_SOLID"},
           {"TESSELLATED_SOLID('',(),$)", "TESSELLATED_SOLID"},
           {"MANIFOLD_SOLID_BREP('',#91000)", "MANIFOLD_SOLID_BREP"}}) {
    const Read in = read(scratch.write("a.step", with_item("#91000=" + entity + ";\n" + at, scratch)));
    ASSERT_GE(in.parts.size(), 3u) << type << in.log;
    EXPECT_EQ(in.parts[0].problem + in.parts[1].problem, "") << type;
    EXPECT_EQ(in.parts[2].name, "cover:" + type);
    EXPECT_NE(in.parts[2].problem.find(type), std::string::npos) << in.parts[2].problem;
    EXPECT_FALSE(in.parts[2].by_meaning);
  }
  const Read absent = read(scratch.write("a.step", with_item("", scratch)));
  ASSERT_EQ(absent.parts.size(), 3u) << absent.log;
  EXPECT_NE(absent.parts[2].problem.find("#91000, which the file lacks"), std::string::npos) << absent.parts[2].problem;
  const Read point = read(scratch.write("a.step", with_item("#91000=CARTESIAN_POINT('',(0.,0.,9.));\n", scratch)));
  EXPECT_EQ(point.parts.size(), 2u) << "no body";
}

TEST(StepAccount, FacesThatAreMissingAreNamed) {
  const Scratch scratch;
  std::string text = two_parts("plate", "cover", scratch);
  text.replace(text.find("ADVANCED_FACE"), 13, "ADVANCED_FACX");
  const Read in = read(scratch.write("a.step", text));
  ASSERT_EQ(in.parts.size(), 3u) << in.log;
  EXPECT_NE(in.parts[2].problem.find("1 of its 6 faces"), std::string::npos) << in.parts[2].problem;
}

TEST(StepAccount, SolidsOfNoProductAreNamed) {
  const Scratch scratch;
  std::string text = two_parts("plate", "cover", scratch);
  const auto solid = text.rfind("MANIFOLD_SOLID_BREP");
  const std::string again = text.substr(solid, text.find(';', solid) + 1 - solid);
  text.insert(text.rfind("ENDSEC;"), "#91000=" + again + "\n");
  const Read in = read(scratch.write("a.step", text));
  ASSERT_EQ(in.parts.size(), 3u) << in.log;
  EXPECT_NE(in.parts[2].problem.find("in no product"), std::string::npos) << in.parts[2].problem;
}

/// Products that use each other: `levels` of them, each `times` the next, the last the given one.
std::string used(int levels, int times, const std::string& last, const Scratch& scratch) {
  std::string text = two_parts("plate", "cover", scratch);
  std::smatch found;
  if (!std::regex_search(text, found, std::regex(R"(#(\d+)\s*=\s*PRODUCT_DEFINITION\()"))) return {};
  const std::string root = "#" + found[1].str();
  std::string more;
  for (int i = 0; i < levels; ++i) {
    const std::string own = i == 0 ? root : "#" + std::to_string(92000 + i);
    const std::string next = i + 1 < levels ? "#" + std::to_string(92001 + i) : last == "root" ? root : last;
    if (i > 0) more += own + "=PRODUCT_DEFINITION('','',$,$);\n";
    for (int k = 0; k < times; ++k)
      more += "#" + std::to_string(100000 + 100 * i + k) + "=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','',''," + own + "," +
              next + ",$);\n";
  }
  if (last != "root") more += last + "=PRODUCT_DEFINITION('','',$,$);\n";
  return text.insert(text.rfind("ENDSEC;"), more);
}

TEST(StepAccount, ProductsWithoutAnEndAreRefusedByName) {
  const Scratch scratch;
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {used(1, 1, "root", scratch), "the product 'root' contains itself"},
           {used(5, 1, "root", scratch), "contains itself"},
           {used(30, 2, "#91000", scratch), "stands for more than 1000000 instances"},
           {used(100, 1, "#91000", scratch), "nested more than 64 deep"}}) {
    const std::string error = input_error([&] { read(scratch.write("a.step", text)); });
    EXPECT_NE(error.find(said), std::string::npos) << said << "|" << error;
  }
  EXPECT_EQ(read(scratch.write("a.step", used(5, 3, "#91000", scratch))).parts[0].problem, "");
}

TEST(StepAccount, RepresentationsWithoutAnEndAreRefusedByName) {
  const Scratch scratch;
  std::string text = two_parts("plate", "cover", scratch);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found, std::regex(R"(#(\d+)\s*=\s*ADVANCED_BREP_SHAPE_REPRESENTATION)")));
  const std::string id = "#" + found[1].str();
  const std::string itself = "#91000=SHAPE_REPRESENTATION_RELATIONSHIP('',''," + id + "," + id + ");\n";
  const std::string mapped = "#91000=MAPPED_ITEM('',#91001,#91002);\n#91001=REPRESENTATION_MAP(#91002," + id +
                             ");\n#91002=AXIS2_PLACEMENT_3D('',#91003,$,$);\n#91003=CARTESIAN_POINT('',(0.,0.,9.));\n";
  std::string with_mapped = text;
  const auto items = text.find('(', text.find('(', text.find("ADVANCED_BREP_SHAPE_REPRESENTATION")) + 1);
  with_mapped.insert(items + 1, "#91000,");
  std::string bomb;
  for (int i = 0; i < 30; ++i)
    for (int k = 0; k < 3; ++k)
      bomb += "#" + std::to_string(92000 + 10 * i + k) + "=SHAPE_REPRESENTATION_RELATIONSHIP('','',#" +
              std::to_string(93000 + i) + "," + (i < 29 ? "#" + std::to_string(93001 + i) : id) + ");\n" +
              (k == 0 ? "#" + std::to_string(93000 + i) + "=SHAPE_REPRESENTATION('',(),$);\n" : "");
  for (const auto& [whole, more, said] :
       std::vector<std::tuple<std::string, std::string, std::string>>{{text, itself, "contains itself"},
                                                                      {with_mapped, mapped, "contains itself"},
                                                                      {text, bomb, "stands for more"}}) {
    std::string changed = whole;
    changed.insert(changed.rfind("ENDSEC;"), more);
    const std::string error = input_error([&] { read(scratch.write("a.step", changed)); });
    EXPECT_NE(error.find(said), std::string::npos) << said << "|" << error;
  }
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
