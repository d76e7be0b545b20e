// Laws of the registry: what is found is what was registered; what is missing is explained.
#include "dismantle/host/registry.h"

#include <dlfcn.h>
#include <elf.h>
#include <gtest/gtest.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "dismantle/preparation/sha256.h"
#include "dismantle/testing/path_checking.h"
#include "scratch.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;
const fs::path kBuiltIn = fs::path(GOOD_FOLDER) / "built_in";
const fs::path kAcme = fs::path(GOOD_FOLDER) / "acme";

std::vector<std::string> ids(const Registry& registry, PluginKind kind) {
  std::vector<std::string> all;
  for (const auto* type : registry.types(kind)) all.push_back(type->type.id);
  return all;
}

std::string why(const Registry& registry, PluginKind kind, const std::string& id) {
  try {
    registry.find(kind, id);
  } catch (const PluginError& e) {
    return e.what();
  }
  return "";
}

TEST(Registry, FindsWhatWasRegistered) {
  Registry registry(kBuiltIn);
  registry.add_search_path(kAcme);
  registry.scan();
  for (const auto& problem : registry.problems()) ADD_FAILURE() << problem.file << ": " << problem.message;
  EXPECT_EQ(ids(registry, PluginKind::path_planner),
            (std::vector<std::string>{"acme.first_of", "acme.lines", "acme.straight", "bfs", "clash", "duo", "guided",
                                      "pairs", "solo", "t_rrt", "team"}));
  EXPECT_EQ(ids(registry, PluginKind::simulator),
            (std::vector<std::string>{"acme.stepper", "geometry_only", "sdf_penalty"}));
  const RegisteredType& bfs = registry.find(PluginKind::path_planner, "bfs");
  EXPECT_TRUE(bfs.file->built_in);
  EXPECT_EQ(bfs.file->id, "dismantle.fixture");
  EXPECT_EQ(bfs.file->version, "0.1.0");
  EXPECT_EQ(bfs.file->licence, "MIT");
  EXPECT_EQ(bfs.type.traits.source, "Algorithm 1");
  EXPECT_FALSE(registry.find("acme.straight").file->built_in);
  EXPECT_EQ(sha256_of_file(bfs.file->path).size(), 64u);
}

TEST(Registry, ScanningAgainChangesNothing) {
  Registry registry(kBuiltIn);
  registry.scan();
  const std::size_t files = registry.files().size();
  registry.add_search_path(kBuiltIn);
  registry.add_search_path(kBuiltIn / ".." / "built_in" / "");
  registry.scan();
  EXPECT_EQ(registry.files().size(), files);
  EXPECT_TRUE(registry.problems().empty());
}

// Law: a file that says what it offers is known by its header alone, and loaded when one of its types is asked for.
TEST(Registry, LoadsWhatIsAskedFor) {
  const fs::path file = fs::path(GOOD_FOLDER) / "late" / "libacme_offers.so";
  const auto is_loaded = [&] { return dlopen(file.c_str(), RTLD_LAZY | RTLD_NOLOAD) != nullptr; };
  Registry registry(kBuiltIn);
  registry.add_search_path(file.parent_path());
  registry.scan();
  ASSERT_EQ(registry.files().size(), 2u);
  EXPECT_EQ(registry.files().back().types, std::vector<std::string>{"acme.offered"});
  EXPECT_EQ(registry.types(PluginKind::path_planner).size(), 8u);
  EXPECT_EQ(registry.lookup(PluginKind::path_planner, "bfs")->file, &registry.files().front());
  EXPECT_FALSE(is_loaded());
  ASSERT_NE(registry.lookup(PluginKind::importer, "acme.offered"), nullptr);
  EXPECT_TRUE(is_loaded());
  EXPECT_EQ(registry.lookup("acme.offered"), registry.lookup(PluginKind::importer, "acme.offered"));
  EXPECT_EQ(registry.lookup(PluginKind::path_planner, "acme.offered"), nullptr);
  EXPECT_TRUE(registry.problems().empty());
}

// Law: what a file says wrongly of itself shows when it is loaded, once, and where its type is asked for.
TEST(Registry, RefusesLateWhatSaysSomethingElse) {
  Registry registry{fs::path()};
  registry.add_search_path(fs::path(REFUSED_FOLDER) / "offers_other.so");
  registry.scan();
  EXPECT_TRUE(registry.problems().empty());
  for (int time = 0; time < 2; ++time) {
    EXPECT_NE(why(registry, PluginKind::importer, "acme.other").find("was refused: registers"), std::string::npos);
    EXPECT_TRUE(registry.types(PluginKind::importer).empty());
    registry.load_all();
    EXPECT_EQ(registry.problems().size(), 1u);
    EXPECT_THROW(registry.load(fs::path(REFUSED_FOLDER) / "offers_other.so"), PluginError);
  }
}

TEST(Registry, ExplainsWhatIsMissing) {
  Registry registry(kBuiltIn);
  registry.scan();
  EXPECT_EQ(why(registry, PluginKind::path_planner, "bsf"), "unknown path_planner 'bsf'; did you mean 'bfs'?");
  EXPECT_EQ(why(registry, PluginKind::path_planner, "progressive"),
            "'progressive' is a sequence_planner, not a path_planner");
  EXPECT_EQ(why(registry, PluginKind::sequence_planner, "zzz"),
            "unknown sequence_planner 'zzz'; there are: blocking, progressive, random");
  EXPECT_EQ(why(registry, PluginKind::importer, "obj"), "unknown importer 'obj'; no importer was found");
}

TEST(Registry, MissingFolderIsAProblemNotAnError) {
  Registry registry{fs::path()};
  registry.add_search_path("/nowhere/at/all");
  EXPECT_NO_THROW(registry.scan());
  ASSERT_EQ(registry.problems().size(), 1u);
  EXPECT_NE(registry.problems()[0].message.find("does not exist"), std::string::npos);
}

TEST(Registry, BareIdsBelongToTheBuiltInFolder) {
  Registry registry{fs::path()};  // the same files, but from elsewhere
  registry.add_search_path(kBuiltIn);
  registry.scan();
  ASSERT_EQ(registry.problems().size(), 3u);  // the plugin, and two presets
  EXPECT_NE(registry.problems()[0].message.find("needs an id with a dot"), std::string::npos);
  for (const std::size_t k : {1u, 2u})
    EXPECT_NE(registry.problems()[k].message.find("must carry a dot"), std::string::npos);
  Registry dotted(kAcme);  // and dots do not belong there
  dotted.scan();
  const auto plugins = std::count_if(fs::directory_iterator(kAcme), fs::directory_iterator(),
                                     [](const auto& entry) { return entry.path().extension() == ".so"; });
  ASSERT_GE(plugins, 8);
  ASSERT_EQ(dotted.problems().size(), static_cast<std::size_t>(plugins));
  for (const auto& problem : dotted.problems())
    EXPECT_NE(problem.message.find("has a dot in its id"), std::string::npos);
}

TEST(Registry, ReadsTheEnvironment) {
  const char* before = std::getenv("DISMANTLE_PLUGIN_PATH");
  const std::string kept = before != nullptr ? before : "";
  ASSERT_EQ(setenv("DISMANTLE_PLUGIN_PATH", ("::" + kAcme.string() + ":").c_str(), 1), 0);
  {
    Registry registry;
    registry.scan();
    EXPECT_NE(registry.lookup(PluginKind::path_planner, "acme.straight"), nullptr);
    EXPECT_EQ(registry.search_paths().front(), built_in_plugin_folder());
    EXPECT_EQ(registry.search_paths().size(), 2u);
  }
  if (before != nullptr)
    setenv("DISMANTLE_PLUGIN_PATH", kept.c_str(), 1);
  else
    unsetenv("DISMANTLE_PLUGIN_PATH");
}

TEST(Registry, MakesObjects) {
  Registry registry(kBuiltIn);
  registry.add_search_path(kAcme);
  registry.scan();
  const auto planner = registry.create<PathPlanner>("acme.straight", {{"force", 5.0}});
  EXPECT_TRUE(planner->traits().needs.dynamics);
  EXPECT_NE(planner, registry.create<PathPlanner>("acme.straight"));
  EXPECT_TRUE(registry.create<Simulator>("acme.stepper")->capabilities().contacts);
  EXPECT_THROW(registry.create<PathPlanner>("acme.straight", {{"force", -5.0}}), PluginError);
  EXPECT_THROW(registry.create<PathPlanner>("acme.straight", {{"forse", 5.0}}), PluginError);
  EXPECT_THROW(registry.create<Simulator>("acme.straight"), PluginError);
  EXPECT_THROW(registry.create<Simulator>("nothing"), PluginError);
}

// Two boxes side by side, the moving one free towards +x: planner, simulator and core work together across libraries.
TEST(Examples, StraightPlannerOnStepper) {
  Registry registry{fs::path()};
  registry.add_search_path(kAcme);
  registry.scan();
  Assembly assembly;
  for (PartId id = 0; id < 2; ++id) {
    Mesh box;
    for (int corner = 0; corner < 8; ++corner)
      box.vertices.emplace_back((corner & 1) + static_cast<int>(id) * 0.99, (corner >> 1) & 1, (corner >> 2) & 1);
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const auto mesh = std::make_shared<const Mesh>(std::move(box));
    assembly.parts.push_back({id, "box" + std::to_string(id), "", mesh, mesh, 1.0, {}, {}});
  }
  assembly.overlaps.push_back({0, 1, 0.01});
  const auto simulator = registry.create<Simulator>("acme.stepper");
  const auto planner = registry.create<PathPlanner>("acme.straight");
  RunContext context;
  const auto prepared = simulator->prepare(assembly, 0.01, context);
  const fake::RuleChecker checker = fake::accept_all();
  const PathQuery query{assembly, *simulator, *prepared, {{{1, {}}}, {{0, {}}}}, {}, 0.01, checker};
  const PathResult result = plan_path(*planner, query, context);
  EXPECT_EQ(result.outcome(), Outcome::solved);
  ASSERT_TRUE(result.path());
  ASSERT_GE(result.path()->poses().size(), 2u);
  EXPECT_TRUE(result.path()->poses().front()[0].is_identity());
  EXPECT_GT(result.path()->poses().back()[0].t.x(), 0.0);
  EXPECT_EQ(result.path()->poses().back()[0].t.y(), 0.0);
}

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The blocks of a page that are in this language, in order.
std::vector<std::string> blocks_of(const std::string& page, const std::string& language) {
  std::vector<std::string> blocks;
  const std::string open = "\n```" + language + "\n";
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
    at += open.size();
    blocks.push_back(page.substr(at, page.find("```\n", at) - at));
  }
  return blocks;
}

// Law: the C++ and CMake that the pages for authors of plugins show is what is built here, all of it; each example has
// its number.
TEST(Examples, AllCodeOfThePagesIsBuilt) {
  const fs::path source = SOURCE_FOLDER;
  struct Page {
    const char* file;
    std::vector<std::string> examples, projects;
  };
  const Page pages[] = {
      {"docs/write-a-planner.md",
       {"plugins/templates/path_planner/acme_lines.cpp", "tests/plugins_good/acme_straight/straight.cpp",
        "tests/plugins_good/acme_first_of/first_of.cpp", "plugins/templates/sequence_planner/acme_in_turn.cpp",
        "tests/plugins_good/acme_veto/veto.cpp"},
       {"tests/plugins_good/acme_straight/CMakeLists.txt"}},
      {"docs/write-a-simulator.md", {"plugins/templates/simulator/acme_stepper.cpp"}, {}},
      {"docs/write-a-check.md", {"plugins/templates/step_check/acme_from_above.cpp"}, {}}};
  for (const Page& page : pages) {
    const std::string text = content(source / page.file);
    const auto expect = [&](const std::string& language, const std::vector<std::string>& files) {
      const auto blocks = blocks_of(text, language);
      ASSERT_EQ(blocks.size(), files.size()) << page.file << ", " << language;
      for (std::size_t k = 0; k < files.size(); ++k) EXPECT_EQ(blocks[k], content(source / files[k])) << files[k];
    };
    expect("cpp", page.examples);
    expect("cmake", page.projects);
    std::size_t at = 0;
    for (std::size_t k = 1; k <= page.examples.size(); ++k) {
      const std::size_t heading = text.find("\n## Example " + std::to_string(k) + ": ", at);
      ASSERT_NE(heading, std::string::npos) << page.file << ", example " << k;
      at = text.find("\n```cpp\n", heading);
    }
    EXPECT_EQ(text.find("\n## Example ", at), std::string::npos) << page.file << ": an example without code";
  }
}

// Law: a plugin exports its header and nothing else.
TEST(Plugin, ExportsOnlyItsHeader) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kAcme)) {
    if (entry.path().extension() != ".so") continue;
    const std::filesystem::path name = entry.path().filename();
    ++files;
    std::ifstream stream(kAcme / name, std::ios::binary);
    const std::string file((std::istreambuf_iterator<char>(stream)), {});
    ElfW(Ehdr) header;
    ASSERT_GT(file.size(), sizeof(header));
    std::memcpy(&header, file.data(), sizeof(header));
    std::vector<ElfW(Shdr)> sections(header.e_shnum);
    std::memcpy(sections.data(), file.data() + header.e_shoff, sections.size() * sizeof(sections[0]));
    std::vector<std::string> exported;
    for (const auto& section : sections) {
      if (section.sh_type != SHT_DYNSYM) continue;
      for (std::size_t i = 0; i < section.sh_size / sizeof(ElfW(Sym)); ++i) {
        ElfW(Sym) symbol;
        std::memcpy(&symbol, file.data() + section.sh_offset + i * sizeof(symbol), sizeof(symbol));
        const bool local = ELF64_ST_BIND(symbol.st_info) == STB_LOCAL;
        if (symbol.st_shndx != SHN_UNDEF && !local)
          exported.emplace_back(file.data() + sections[section.sh_link].sh_offset + symbol.st_name);
      }
    }
    EXPECT_EQ(exported, std::vector<std::string>{"dismantle_plugin_header"}) << name;
  }
  EXPECT_GE(files, 9u);
}

}  // namespace
}  // namespace dismantle
