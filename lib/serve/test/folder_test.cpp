#include "folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "dismantle/errors.h"
#include "dismantle/plan_io/read_file.h"
#include "jobs.h"
#include "plan_view.h"
#include "upload.h"

namespace dismantle::serve {
namespace {

namespace fs = std::filesystem;

class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "dismantle-serve-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    outside_ = pattern;
    path_ = outside_ / "in";
    fs::create_directory(path_);
  }
  void TearDown() override { fs::remove_all(outside_); }

  static void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  void write_plan(const std::string& folder, int steps) const {
    nlohmann::json plan = {{"assembly", {{"parts", {{{"name", "a"}}, {{"name", "b"}}}}}}, {"status", "complete"}};
    plan["disassembly"] = nlohmann::json::array();
    for (int i = 0; i < steps; ++i) plan["disassembly"].push_back({{"moves", {{{"part", "p" + std::to_string(i)}}}}});
    write(path_ / folder / "plan.json", plan.dump());
  }
  Folder folder() const { return Folder(path_, {".step", ".obj"}); }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const Entry& entry : folder().entries()) out.push_back(entry.name);
    return out;
  }

  fs::path outside_, path_;
};

TEST_F(FolderTest, ListsWhatCanBePlannedAndWhatIsPlanned) {
  for (const char* file : {"gear.STEP", "two.step", "two.obj", "notes.txt", ".hidden.step", "meshes/a.obj"})
    write(path_ / file, "x");
  write_plan("gear.plan", 1);
  write_plan("gear.plan.1", 1);
  write_plan("gear.plan.new", 1);
  write_plan("gone.plan", 1);
  write(outside_ / "secret.step", "x");
  fs::create_symlink(outside_ / "secret.step", path_ / "link.step");
  fs::create_directory_symlink(outside_, path_ / "way");
  EXPECT_EQ(names(), (std::vector<std::string>{"gear", "gone", "meshes", "two.obj", "two.step"}));
  const auto gear = folder().entry("gear");
  ASSERT_TRUE(gear);
  EXPECT_EQ(gear->input, path_ / "gear.STEP");
  EXPECT_TRUE(gear->has_plan);
  EXPECT_EQ(gear->earlier, 1);
  EXPECT_TRUE(folder().entry("gone")->input.empty());
  for (const char* name : {"", "..", "../secret", "link", "way", "gear.STEP"})
    EXPECT_FALSE(folder().entry(name)) << name;
}

TEST_F(FolderTest, OnlyFilesOfAPlanAreGivenAway) {
  write_plan("gear.plan", 2);
  write(path_ / "gear.plan" / "other.txt", "x");
  write(outside_ / "plan.glb", "secret");
  fs::create_symlink(outside_ / "plan.glb", path_ / "gear.plan" / "plan.glb");
  fs::create_directory_symlink(outside_, path_ / "way.plan");
  EXPECT_EQ(folder().plan_file("gear", "plan.json"), path_ / "gear.plan" / "plan.json");
  for (const char* file : {"other.txt", "plan.glb", "index.html", "../plan.glb", "", "."})
    EXPECT_FALSE(folder().plan_file("gear", file)) << file;
  EXPECT_FALSE(folder().plan_file("way", "plan.glb"));
  EXPECT_EQ(folder().summary("gear")["steps"], 2);
  EXPECT_EQ(folder().summary("none"), nlohmann::json::object());
  write(path_ / "gear.plan" / "plan.json", "{}");
  EXPECT_EQ(folder().summary("gear")["status"], "unreadable");
}

TEST_F(FolderTest, EarlierPlansAreKeptAndComeBack) {
  Folder served = folder();
  const auto steps = [&] { return served.summary("gear").value("steps", -1); };
  EXPECT_FALSE(served.undo("gear"));
  EXPECT_THROW(served.install("gear"), Error) << "there is no fresh one";
  const int most = Folder::kMaxEarlier;
  for (int k = 1; k <= most + 3; ++k) {
    write_plan("gear.plan.new", k);
    served.install("gear");
    EXPECT_EQ(steps(), k);
    EXPECT_FALSE(fs::exists(served.fresh("gear")));
  }
  EXPECT_EQ(served.entry("gear")->earlier, most);
  write_plan("gear.plan.new", 99);
  served.discard("gear");
  EXPECT_EQ(steps(), most + 3) << "a run that does not count changes nothing";
  for (int k = most + 2; k >= 3; --k) {
    EXPECT_TRUE(served.undo("gear"));
    EXPECT_EQ(steps(), k);
  }
  EXPECT_FALSE(served.undo("gear"));
  EXPECT_EQ(steps(), 3);
}

TEST_F(FolderTest, AnUploadIsWholeOrNotThere) {
  write(path_ / "taken.step", "old");
  {
    Upload upload(path_, 4);
    EXPECT_TRUE(upload.add("ab"));
    EXPECT_TRUE(upload.add("cd"));
    EXPECT_FALSE(fs::exists(path_ / "new.step"));
    EXPECT_FALSE(upload.keep_as(path_ / "taken.step"));
    EXPECT_TRUE(upload.keep_as(path_ / "new.step"));
  }
  {
    Upload upload(path_, 4);
    EXPECT_TRUE(upload.add("abcd"));
    EXPECT_FALSE(upload.add("e"));
    EXPECT_TRUE(upload.too_large());
  }
  EXPECT_EQ(read_file(path_ / "new.step"), "abcd");
  EXPECT_EQ(read_file(path_ / "taken.step"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(path_), {}), 2) << "nothing else is left";
}

TEST(PlanView, StepsHaveTheNumbersOfTheAssembly) {
  const auto view = plan_view(R"({"assembly": {"parts": [{"name": "a"}, {"name": "b"}], "excluded": [{"name": "foil"}]},
    "disassembly": [{"moves": [{"part": "a"}]}, {"moves": [{"part": "b"}], "forced": {}}]})");
  EXPECT_EQ(view["parts"], (nlohmann::json{"a", "b", "foil"}));
  EXPECT_EQ(view["steps"][0], (nlohmann::json{{"step", 1}, {"parts", {"b"}}, {"forced", true}}));
  EXPECT_EQ(view["steps"][1], (nlohmann::json{{"step", 2}, {"parts", {"a"}}, {"forced", false}}));
  EXPECT_THROW(plan_view("{"), Error);
  EXPECT_THROW(plan_view("[]"), Error);
}

TEST(JobReport, SaysWhatAnEndedRunMeans) {
  const auto state = [](int status, const std::string& output) {
    return report_of("plan", status, output, "words\n").state;
  };
  EXPECT_EQ(state(0, "{\"status\": \"complete\"}\n"), JobState::done);
  EXPECT_EQ(state(1, "{\"status\": \"partial\"}\n"), JobState::done) << "there is a plan";
  EXPECT_EQ(state(1, "{\"status\": \"refused\", \"step\": 3, \"message\": \"m\"}\n"), JobState::refused);
  EXPECT_EQ(state(130, "{\"status\": \"interrupted\"}\n"), JobState::failed);
  EXPECT_EQ(state(0, ""), JobState::failed) << "the program always writes a last line";
  EXPECT_EQ(report_of("edit", 1, "{\"status\": \"refused\", \"step\": 3, \"message\": \"m\"}\n", "").message, "m");
  EXPECT_EQ(report_of("plan", 3, "", "first\nlast\n").message, "last");
  EXPECT_NE(report_of("plan", 139, "", "").message.find("139"), std::string::npos);
}

}  // namespace
}  // namespace dismantle::serve
