#include "dismantle/preparation/read_input.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;
namespace fs = std::filesystem;

/// Reads ".box" files: each line is the name of one part.
class BoxImporter : public Importer {
 public:
  std::vector<std::string> extensions() const override { return {"box", "cube"}; }
  std::optional<std::uint64_t> count_triangles(const fs::path& file) const override { return fs::file_size(file); }
  std::vector<RawPart> read(const fs::path& file, const RunContext& context) override {
    ++files_read;
    std::ifstream in(file);
    if (file.stem() == "noisy") {
      context.log(LogLevel::warning, "bent \xFF");
      context.log(LogLevel::info, "said");
    }
    std::vector<RawPart> parts;
    for (std::string line; std::getline(in, line);) {
      if (line == "broken") throw InputError(file.string(), "line 1 is broken");
      parts.push_back({line, "", box({0, 0, 0}, {1, 1, 1})});
      if (line == "surface") parts.back().problem = "it is a surface";
      if (line == "hidden") {
        parts.back().problem = "it is hidden";
        parts.back().by_meaning = true;
      }
      if (line == "red") parts.back().colour = Rgba{255, 0, 0};
      if (line == "blue") parts.back().colour = Rgba{0, 0, 255};
    }
    return parts;
  }
  std::vector<fs::path> referenced_files(const fs::path& file) const override {
    std::vector<fs::path> files;
    if (const fs::path beside = fs::path(file).replace_extension(".data"); fs::exists(beside)) files.push_back(beside);
    return files;
  }
  int files_read = 0;
};

std::vector<std::shared_ptr<Importer>> importers() { return {std::make_shared<BoxImporter>()}; }

std::vector<std::string> names(const InputParts& in) {
  std::vector<std::string> out;
  for (const auto& p : in.parts) out.push_back(p.name);
  return out;
}

using NameList = std::vector<std::string>;

TEST(NaturalOrder, IsAStrictTotalOrderWithNumbers) {
  EXPECT_TRUE(natural_less("2", "10"));
  EXPECT_TRUE(natural_less("a2b", "a10a"));
  EXPECT_TRUE(natural_less("a", "ab"));
  EXPECT_TRUE(natural_less("B", "a"));
  Rng rng(21);
  std::vector<std::string> words;
  for (int i = 0; i < 120; ++i) {
    std::string w;
    for (auto n = rng.below(6); n-- > 0;) w += "0012ab\xC3"[rng.below(7)];
    words.push_back(w);
  }
  for (const auto& a : words) {
    EXPECT_FALSE(natural_less(a, a));
    for (const auto& b : words) {
      EXPECT_EQ(natural_less(a, b), a != b && !natural_less(b, a)) << a << " " << b;
      if (!natural_less(a, b)) continue;
      for (std::size_t k = 0; k < words.size(); k += 7) {
        EXPECT_TRUE(!natural_less(b, words[k]) || natural_less(a, words[k]));
      }
    }
  }
}

TEST(ReadInput, FolderGivesOnePartPerFileInNaturalOrder) {
  const TempFolder folder;
  folder.write("10.box", "x\n");
  folder.write("2.box", "y\nz\n");
  folder.write("Schräge Welle 1.BOX", "x\n");
  folder.write("truth.json", "{}");
  folder.write("readme.txt", "hello");
  folder.write(".hidden.box", "x\n");
  const auto in = read_input(folder.path(), importers());
  EXPECT_EQ(names(in), (NameList{"2", "10", "Schräge Welle 1"}));
  EXPECT_EQ(in.parts[0].mesh.triangles.size(), 24u);
  EXPECT_EQ(in.parts[0].file, "2.box");
  EXPECT_TRUE(in.warnings.empty());
}

TEST(ReadInput, FingerprintIsOfTheBytesInOrder) {
  const TempFolder folder;
  folder.write("1.box", "a");
  folder.write("2.box", "bc");
  folder.write("note.txt", "not part of it");
  // printf abc | sha256sum
  EXPECT_EQ(read_input(folder.path(), importers()).sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ReadInput, FilesOfOneStemGetTheirEndings) {
  const TempFolder folder;
  folder.write("a.box", "x");
  folder.write("a.cube", "x");
  folder.write("b.box", "x");
  const auto in = read_input(folder.path(), importers());
  EXPECT_EQ(names(in), (NameList{"a.box", "a.cube", "b"}));
  EXPECT_TRUE(any_contains(in.warnings, "several files are called 'a'"));
}

TEST(ReadInput, NodesOfOneNameAreNumbered) {
  const TempFolder folder;
  const auto in = read_input(folder.write("a.box", "nut\nnut\nnut#2\n\nnut\n"), importers());
  EXPECT_EQ(names(in), (NameList{"nut", "nut#3", "nut#2", "a", "nut#4"}));
  ASSERT_EQ(in.warnings.size(), 1u) << "one line, however many there are";
  EXPECT_TRUE(any_contains(in.warnings, "2 parts have the names of others"));
  EXPECT_TRUE(any_contains(in.warnings, "'nut' (a.box) is now 'nut#3'"));
}

TEST(ReadInput, NamesBecomeValidUtf8) {
  EXPECT_EQ(valid_utf8("Größe 日本"), "Größe 日本");
  EXPECT_EQ(valid_utf8("a\xFF"
                       "b\xC3"),
            "a\xEF\xBF\xBD"
            "b\xEF\xBF\xBD");
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(valid_utf8("a\nb"), "a_b");
  EXPECT_EQ(valid_utf8("a\xC2\x9B"
                       "2Jb\xC2\xA0"),
            "a_2Jb\xC2\xA0");  // C1: a terminal would obey
  const TempFolder folder;
  const auto in = read_input(folder.write("a.box", "\xFFnut\nbolt\n"), importers());
  EXPECT_EQ(in.parts[0].name, "\xEF\xBF\xBDnut");
}

TEST(ReadInput, UnusableInputNamesItself) {
  const TempFolder folder;
  const auto error = [&](const fs::path& path) { return input_error([&] { read_input(path, importers()); }); };
  EXPECT_NE(error(folder.path()).find("no mesh file in this folder (can be read: .box, .cube)"), std::string::npos);
  EXPECT_NE(error(folder / "missing").find("there is no such file or folder"), std::string::npos);
  EXPECT_NE(error(folder.write("part.xyz", "x")).find("no importer reads files with the ending '.xyz'"),
            std::string::npos);
  EXPECT_NE(error(folder.write("none.box", "")).find("none.box: the file is empty"), std::string::npos);
  EXPECT_NE(error("").find("no input"), std::string::npos);
  EXPECT_NE(error(folder.write("bad.box", "broken\n")).find("bad.box: line 1 is broken"), std::string::npos);
}

TEST(ReadInput, AFileOfAFolderThatCannotBeReadIsAPartWithAProblem) {
  const TempFolder folder;
  folder.write("1.box", "x\n");
  folder.write("2.box", "broken\n");
  folder.write("3.box", "");
  fs::create_symlink(folder / "nowhere", folder / "4.box");
  folder.write("5.box", "x\n");
  std::size_t broken = 3;
  if (::geteuid() != 0) {
    ::chmod(folder.write("6.box", "x").c_str(), 0);
    ++broken;
  }
  const auto in = read_input(folder.path(), importers());
  ASSERT_EQ(in.parts.size(), 2 + broken);
  for (std::size_t i = 0; i < in.parts.size(); ++i) {
    EXPECT_EQ(in.parts[i].name, std::to_string(i + 1));
    EXPECT_EQ(in.parts[i].problem.empty(), i == 0 || i == 4) << in.parts[i].problem;
  }
  EXPECT_EQ(in.parts[1].problem, "2.box cannot be read: line 1 is broken");
  EXPECT_EQ(in.parts[2].problem, "3.box cannot be read: the file is empty");
  EXPECT_EQ(in.sha256, read_input(folder.path(), importers()).sha256);
}

TEST(ReadInput, FingerprintCoversReferencedFiles) {
  const TempFolder folder;
  const auto file = folder.write("1.box", "a");
  folder.write("1.data", "bc");
  EXPECT_EQ(read_input(file, importers()).sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ReadInput, BodiesOfOneFileInAFolderAreOnePartAndTheRestIsNamed) {
  const TempFolder folder;
  folder.write("1.box", "x\nsurface\nhidden\ny\n");
  folder.write("2.box", "hidden\nsurface\n");
  folder.write("3.box", "red\nred\n");
  folder.write("4.box", "red\nblue\n");
  folder.write("5.box", "hidden\n");
  const auto in = read_input(folder.path(), importers());
  EXPECT_EQ(names(in), (NameList{"1", "1/surface", "1/hidden", "2", "2/hidden", "3", "4", "5"}));
  EXPECT_EQ(in.parts[0].mesh.triangles.size(), 24u);
  EXPECT_EQ(in.parts[0].problem, "");
  EXPECT_EQ(in.parts[1].problem, "it is a surface");
  EXPECT_TRUE(in.parts[2].by_meaning);
  EXPECT_EQ(in.parts[3].problem, "it is a surface");
  EXPECT_FALSE(in.parts[3].by_meaning);
  EXPECT_EQ(in.parts[5].colour, (Rgba{255, 0, 0}));
  EXPECT_EQ(in.parts[6].colour, std::nullopt);
  EXPECT_TRUE(in.parts[7].by_meaning);
}

TEST(ReadInput, WhatMayBeInputAndIsNotReadIsNamed) {
  const TempFolder folder;
  folder.write("1.box", "x");
  folder.write("2.step", "ISO-10303-21;");
  for (const char* name : {"more.box", "pictures", "deep", "deep/er", "cleaned"}) fs::create_directory(folder / name);
  folder.write("more.box/3.box", "x");
  folder.write("pictures/1.png", "x");
  folder.write("deep/er/4.BOX", "x");
  folder.write("cleaned/5.box", "x");
  folder.write("cleaned/prepare.json", R"({"format": "dismantle.prepare", "version": 1})");
  fs::create_directory_symlink(folder / "pictures", folder / "loop");
  ASSERT_EQ(::mkfifo((folder / "pipe.box").c_str(), 0600), 0);
  const auto in = read_input(folder.path(), importers());
  EXPECT_EQ(names(in), (NameList{"1", "2.step", "deep/", "more.box/", "pipe.box"}));
  for (std::size_t i = 1; i < in.parts.size(); ++i) {
    EXPECT_FALSE(in.parts[i].problem.empty());
    EXPECT_FALSE(in.parts[i].by_meaning);
  }
  EXPECT_NE(in.parts[1].problem.find("no importer reads '.step'"), std::string::npos);
  EXPECT_NE(in.parts[2].problem.find("sub-folders are not read"), std::string::npos);
  EXPECT_NE(in.parts[4].problem.find("it is no regular file"), std::string::npos);
}

TEST(ReadInput, WarningsAndNotesOfImportersAreFindings) {
  const TempFolder folder;
  RunContext context;
  std::vector<std::string> logged;
  context.on_log = [&](LogLevel, std::string_view text) { logged.emplace_back(text); };
  const auto in = read_input(folder.write("noisy.box", "x\ny\n"), importers(), {}, context);
  EXPECT_EQ(in.warnings, (NameList{"bent \xEF\xBF\xBD"}));
  EXPECT_EQ(in.notes, (NameList{"said"}));
  EXPECT_TRUE(logged.empty()) << "the caller says them";
  PrepareReport report;
  add_findings(in, report);
  EXPECT_EQ(report.whole, in.warnings);
  EXPECT_EQ(report.notes, in.notes);
}

TEST(ReadInput, TooManyTrianglesAreRefusedBeforeReading) {
  const TempFolder folder;
  auto importer = std::make_shared<BoxImporter>();
  ReadOptions options;
  options.max_triangles = 20;
  const auto large = folder.write("large.box", std::string(1000, 'x'));  // counts 1000
  EXPECT_NE(
      input_error([&] { read_input(large, {importer}, options); }).find("1000 triangles are more than the limit of 20"),
      std::string::npos);
  EXPECT_EQ(importer->files_read, 0);
  const auto two = folder.write("two.box", "a\nb\n");
  EXPECT_NE(input_error([&] { read_input(two, {importer}, options); }).find("24 triangles"), std::string::npos);
}

TEST(ReadInput, StopsWhenAsked) {
  const TempFolder folder;
  folder.write("1.box", "x");
  RunContext context;
  context.cancel.cancel();
  EXPECT_THROW(read_input(folder.path(), importers(), {}, context), Error);
}

}  // namespace
}  // namespace dismantle
