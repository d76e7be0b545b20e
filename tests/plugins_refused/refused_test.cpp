// Law: a file that does not fit is refused with its reason, and nothing of it is used.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "dismantle/host/registry.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

fs::path refused(const std::string& name) { return fs::path(REFUSED_FOLDER) / (name + ".so"); }

/// Empty when the file was accepted.
std::string reason(const fs::path& file) {
  Registry registry{fs::path()};
  try {
    registry.load(file);
  } catch (const PluginError& e) {
    EXPECT_EQ(e.file(), fs::weakly_canonical(file).string());
    EXPECT_TRUE(registry.files().empty());
    return e.what();
  }
  return "";
}

struct Case {
  const char* name;
  std::vector<std::string> says;
};

class Refused : public testing::TestWithParam<Case> {};

TEST_P(Refused, WithItsReason) {
  const fs::path file = refused(GetParam().name);
  ASSERT_TRUE(fs::exists(file)) << file;
  const std::string text = reason(file);
  ASSERT_FALSE(text.empty()) << "was accepted";
  EXPECT_NE(text.find(file.filename().string()), std::string::npos) << text;
  for (const auto& part : GetParam().says)
    EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}

/// What is said about a plugin of this version of the plugin API.
std::string other_api(int major, int minor) {
  return "plugin API is " + std::to_string(major) + "." + std::to_string(minor) + " in the plugin, " +
         std::to_string(kPluginApiMajor) + "." + std::to_string(kPluginApiMinor) + " here";
}

const Case kCases[] = {
    {"wrong_magic", {"magic is 0x12345678 in the plugin, 0x4c504d44 here", "rebuild"}},
    {"api_major_newer", {other_api(kPluginApiMajor + 1, kPluginApiMinor), "update Dismantle"}},
    {"api_major_older", {other_api(kPluginApiMajor - 1, kPluginApiMinor), "rebuild"}},
    {"api_minor_newer", {other_api(kPluginApiMajor, kPluginApiMinor + 1), "update Dismantle"}},
    {"header_too_small", {"header size is 64 in the plugin", "rebuild"}},
    {"tiny_header", {"plugin header has 4 bytes", "rebuild"}},
    {"unterminated_id", {"a text in it does not end", "rebuild"}},
    {"empty_id", {"must not be empty"}},
    {"other_alignment", {"eigen_max_align_bytes is 64 in the plugin, ", "EIGEN_MAX_ALIGN_BYTES"}},
    {"debug_library", {"stdlib_debug is on in the plugin, off here", "_GLIBCXX_DEBUG", "layout is "}},
    {"no_header", {"has no symbol 'dismantle_plugin_header'", "lacks DISMANTLE_PLUGIN"}},
    {"offers_nonsense", {"'acme.offered' is no list of types"}},
    {"offers_other", {"registers 'importer acme.offered', but its list of types is 'importer acme.other'"}},
    {"undefined_symbol", {"undefined symbol acme::missing_function", "link the library"}},
    {"throws", {"acme.bad_types", "no licence for today", "author"}},
    {"throws_int", {"an exception that is no std::exception"}},
    {"no_types", {"registers no type", "r.add"}},
    {"no_summary", {"'acme.quiet' has no summary", "one line"}},
    {"bare_id", {"'bare' needs an id with a dot", "acme.bare"}},
    {"bad_id", {"'acme.Bad Id' has a bad id"}},
    {"twice", {"'acme.good' is registered twice", "an id of its own"}},
    {"empty_doc", {"parameter 'size' has no doc"}},
    {"no_unit", {"parameter 'size' has no unit"}},
    {"default_outside", {"default of parameter 'size' must be in [2, 3], got 1 s"}},
    {"default_no_choice", {"default of parameter 'flavour' must be one of sweet"}},
    {"bad_name", {"parameter name 'Size' does not match"}},
    {"reserved_name", {"parameter name 'type' is reserved"}},
};
INSTANTIATE_TEST_SUITE_P(Folder, Refused, testing::ValuesIn(kCases),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(RefusedFolder, EveryFileIsListedHere) {
  std::vector<std::string> known = {"claim_first", "claim_second"};
  for (const auto& c : kCases) known.emplace_back(c.name);
  for (const auto& entry : fs::directory_iterator(REFUSED_FOLDER)) {
    if (entry.path().extension() != ".so") continue;
    EXPECT_NE(std::find(known.begin(), known.end(), entry.path().stem().string()), known.end()) << entry.path();
  }
}

TEST(RefusedFolder, BrokenFilesAreWarningsUntilTheirIdIsAskedFor) {
  Registry registry{fs::path()};
  registry.add_search_path(REFUSED_FOLDER);
  EXPECT_NO_THROW(registry.scan());
  EXPECT_GE(registry.problems().size(), std::size(kCases));
  EXPECT_EQ(registry.lookup(PluginKind::importer, "bare"), nullptr);
  try {
    registry.find(PluginKind::importer, "bare");
    FAIL() << "found a type of a refused file";
  } catch (const PluginError& e) {
    EXPECT_NE(std::string(e.what()).find("bare_id.so offers it, but was refused"), std::string::npos) << e.what();
  }
}

TEST(TwoFilesOneId, IsAnErrorThatNamesBoth) {
  Registry registry{fs::path()};
  EXPECT_NO_THROW(registry.load(refused("claim_first")));
  EXPECT_NE(registry.lookup("acme.claimed"), nullptr);
  for (int time = 0; time < 2; ++time) {  // also when it is asked for again
    try {
      registry.load(refused("claim_second"));
      FAIL() << "accepted";
    } catch (const PluginError& e) {
      EXPECT_NE(std::string(e.what()).find("claim_first.so"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("claim_second.so"), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(registry.lookup("acme.claimed"), nullptr);
  EXPECT_TRUE(registry.types(PluginKind::importer).empty());
  try {
    registry.find("acme.claimed");
    FAIL() << "found";
  } catch (const PluginError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("is in two files"), std::string::npos) << text;
    EXPECT_NE(text.find("claim_first.so"), std::string::npos) << text;
    EXPECT_NE(text.find("claim_second.so"), std::string::npos) << text;
  }
}

TEST(SameFile, TwiceIsNoError) {
  Registry registry{fs::path()};
  const PluginFile& first = registry.load(refused("claim_first"));
  EXPECT_EQ(&registry.load(refused("claim_first")), &first);
  EXPECT_EQ(&registry.load(fs::path(REFUSED_FOLDER) / ".." / "plugins_refused" / "claim_first.so"), &first);
  EXPECT_EQ(registry.files().size(), 1u);
}

class Scratch : public testing::Test {
 protected:
  Scratch() : folder_(fs::temp_directory_path() / ("dismantle_refused_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Scratch() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  fs::path folder_;
};

TEST_F(Scratch, NoElf) {
  EXPECT_NE(
      reason(write("text.so", "#!/bin/sh\necho this is long enough to be read\n")).find("is no ELF shared library"),
      std::string::npos);
  EXPECT_NE(reason(write("empty.so", "")).find("is no ELF shared library"), std::string::npos);
  EXPECT_NE(reason(folder_ / "absent.so").find("cannot be read"), std::string::npos);
}

TEST_F(Scratch, OtherMachineAndNoLibrary) {
  std::ifstream stream(refused("claim_first"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  std::string other = whole;
  other[18] = static_cast<char>(0xf0), other[19] = 0x7f;  // e_machine
  EXPECT_NE(reason(write("other.so", other)).find("another processor"), std::string::npos);
  std::string program = whole;
  program[16] = 2;  // e_type: ET_EXEC
  EXPECT_NE(reason(write("program.so", program)).find("no shared library"), std::string::npos);
  std::string wide = whole;
  wide[4] = wide[4] == 2 ? 1 : 2;  // class
  EXPECT_NE(reason(write("class.so", wide)).find("another kind of machine"), std::string::npos);
}

// Law: a prefix of a plugin is refused or (when only what nobody needs is cut off) works; it never ends the process.
TEST_F(Scratch, TruncatedAnywhere) {
  std::ifstream stream(refused("claim_first"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_GT(whole.size(), 4000u);
  for (int part = 0; part < 64; ++part) {
    const std::size_t size = whole.size() * static_cast<std::size_t>(part) / 64;
    const std::string text = reason(write("cut" + std::to_string(part) + ".so", whole.substr(0, size)));
    EXPECT_FALSE(text.empty()) << size << " of " << whole.size() << " bytes were accepted";
  }
  EXPECT_NE(reason(write("half.so", whole.substr(0, whole.size() / 2))).find("is truncated"), std::string::npos);
}

}  // namespace
}  // namespace dismantle
