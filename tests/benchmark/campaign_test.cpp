// Campaigns whose processes are scripts: what a trial's processes are given, and what is kept of them.
#include "dismantle/bench/campaign.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "dismantle/bench/report.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

class CampaignTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("dismantle_campaign_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// The only row of a campaign whose processes state their limit of CPU time.
  ReportRow run(const std::string& name, const std::string& limits) {
    std::ofstream(folder_ / (name + ".yaml")) << "schema: 1\nassemblies: [{sample: l_slot}]\nplanners: {one: {}}\n"
                                              << limits;
    CampaignOptions options;
    options.folder = folder_ / name;
    options.plan_command = {"/bin/sh", "-c", "echo plan > \"$0/plan.json\"; echo \"$(ulimit -t) s\" >&2"};
    options.verify_command = {"/bin/sh", "-c",
                              "echo '{\"valid\": true, \"complete\": true, \"max_penetration\": 0, \"problems\": [\"'"
                              "$(ulimit -t)' s\"]}' > \"$0/verification.json\""};
    RunContext context;
    const CampaignResult result = run_campaign(read_suite(folder_ / (name + ".yaml")), options, context);
    const ReportData data = read_results({result.database});
    EXPECT_EQ(data.rows.size(), 1u);
    return data.rows.at(0);
  }

  fs::path folder_;
};

TEST_F(CampaignTest, TheVerifierHasATimeOfItsOwn) {
  const ReportRow given = run("given", "limits: {timeout: 5, cpu: 7}\nverify: {cpu: 41}\n");
  EXPECT_EQ(given.last_words, "7 s\n");
  EXPECT_EQ(given.verification, "41 s");
  EXPECT_EQ(given.verified, true);
  EXPECT_TRUE(given.verify_seconds.has_value());
  const ReportRow usual = run("usual", "limits: {timeout: 5, cpu: 7}\n");
  EXPECT_EQ(usual.last_words, "7 s\n");
  EXPECT_EQ(usual.verification, "600 s");
}

TEST_F(CampaignTest, TheTableOfTrialsHasTheTimesOfVerifierAndProvers) {
  ReportData data;
  data.rows.resize(2);
  data.rows[0].verify_seconds = 1.5;
  data.rows[0].proof_seconds = 0.25;
  for (const Table& table : tables_of(data)) {
    if (table.id != "trials") continue;
    const auto cell = [&](std::size_t row, const std::string& heading) {
      const auto at = std::find(table.columns.begin(), table.columns.end(), heading);
      EXPECT_NE(at, table.columns.end()) << heading;
      return at == table.columns.end() ? "no column"
                                       : table.rows.at(row).at(std::size_t(at - table.columns.begin())).text;
    };
    EXPECT_EQ(cell(0, "verify s"), "1.5");
    EXPECT_EQ(cell(0, "proof s"), "0.25");
    EXPECT_EQ(cell(1, "verify s"), "");
    return;
  }
  ADD_FAILURE() << "no table of trials";
}

}  // namespace
}  // namespace dismantle::bench
