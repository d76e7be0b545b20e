// Laws: a plan file is read as its input was read for the plan; sessions do not influence each other; a job ends when
// its context says so; what cannot be planned is refused before any work.
#include "dismantle/session/session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <future>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"
#include "dismantle/plan_io/write_file.h"
#include "dismantle/plugin.h"
#include "dismantle/samples/samples.h"
#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;

struct ScaledParameters {
  double scale = 1;
  static void describe(Schema<ScaledParameters>& s) {
    s.add("scale", &ScaledParameters::scale,
          {.unit = "1", .min = 0, .min_open = true, .doc = "Factor on all lengths."});
  }
};

/// Reads a file that holds the name of a sample.
class ScaledSample final : public Importer {
 public:
  explicit ScaledSample(const ScaledParameters& params) : params_(params) {}
  std::vector<std::string> extensions() const override { return {"sample"}; }
  std::vector<RawPart> read(const fs::path& file, const RunContext&) override {
    std::ifstream in(file);
    std::string name;
    in >> name;
    std::vector<RawPart> parts = samples::make(name);
    for (RawPart& part : parts)
      for (auto& v : part.mesh.vertices) v *= params_.scale;
    return parts;
  }

 private:
  ScaledParameters params_;
};

class SessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "session.XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    Registrar registrar;
    registrar.add<Importer, ScaledSample, ScaledParameters>("test.scaled", "Samples by name.", {.source = "test"});
    PluginFile file;
    file.path = __FILE__;
    file.id = "test.scaled";
    file.version = "1";
    add_program_type(file, registrar.types().front());
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    write_file(folder_ / name, text);
    return folder_ / name;
  }

  fs::path folder_;
};

const std::vector<std::string> kOneThread = {"run.threads=1"};

LoadedAssembly sample(const Session& session, const std::string& name) {
  return session.load(InputParts{samples::make(name), "", {}, {}}, name);
}

/// Everything but the times.
std::string without_times(Plan plan) {
  for (auto* steps : {&plan.disassembly, &plan.assembly_steps})
    for (PlanStep& step : *steps) step.seconds = 0;
  for (PlanUnsolved& u : plan.unsolved) u.seconds = 0;
  return to_json(plan);
}

template <class Problem>
std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Problem& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST_F(SessionTest, APlanIsReadWithTheParametersOfItsImporters) {
  const fs::path input = write("peg.sample", "peg_in_hole");
  const fs::path config = write("config.yaml", "schema: 1\nimporters:\n  test.scaled:\n    scale: 3\n");
  const Session session({config, kOneThread, {}});
  const LoadedAssembly loaded = session.load(input);
  const RunResult result = session.plan(loaded);
  ASSERT_EQ(result.outcome, Outcome::solved);
  const fs::path file = write("plan.json", to_json(result.plan));

  const Session plain({{}, kOneThread, {}});
  const double size = plain.load(input).assembly->input_box.size().maxCoeff();
  for (const Session& reading : {Session::reader(), plain}) {  // neither has the parameter in its configuration
    const LoadedPlan saved = reading.load_plan(file);
    EXPECT_NEAR(saved.assembly.input_box.size().maxCoeff(), 3 * size, 1e-9 * size);
    const PlanCheck check = reading.verify(saved.plan, saved.assembly);
    EXPECT_TRUE(check.valid);
    EXPECT_TRUE(check.complete);
  }
}

TEST_F(SessionTest, SessionsAtTheSameTimePlanAsTheyDoAlone) {
  const auto plan = [](const std::string& name, const std::string& planner) {
    const Session session({{}, {"run.threads=1", "sequence_planner.type=" + planner, "run.seed=7"}, {}});
    return without_times(session.plan(sample(session, name)).plan);
  };
  const std::string peg = plan("peg_in_hole", "blocking"), slot = plan("l_slot", "progressive");
  auto first = std::async(std::launch::async, plan, "peg_in_hole", "blocking");
  auto second = std::async(std::launch::async, plan, "l_slot", "progressive");
  EXPECT_EQ(first.get(), peg);
  EXPECT_EQ(second.get(), slot);
}

TEST_F(SessionTest, OneSessionServesTwoThreads) {
  const Session session({{}, kOneThread, {}});
  const auto plan = [&](const std::string& name) { return without_times(session.plan(sample(session, name)).plan); };
  const std::string peg = plan("peg_in_hole"), slot = plan("l_slot");
  auto first = std::async(std::launch::async, plan, "peg_in_hole");
  auto second = std::async(std::launch::async, plan, "l_slot");
  EXPECT_EQ(first.get(), peg);
  EXPECT_EQ(second.get(), slot);
}

TEST_F(SessionTest, ChecksWithoutWeightMeasureAndChangeNothing) {
  const auto plan = [&](const std::string& name, const std::string& planner, const std::string& objective) {
    const Session session({{}, {"run.threads=1", "sequence_planner.type=" + planner, "objective=" + objective}, {}});
    Plan made = session.plan(sample(session, name)).plan;
    for (const PlanStep& step : made.disassembly) EXPECT_EQ(step.checks.empty(), objective == "[]");
    EXPECT_EQ(made.objective.cost, 0);
    EXPECT_TRUE(made.objective.alternatives.empty());
    made.objective = {};
    for (PlanStep& step : made.disassembly) step.checks.clear();
    return without_times(made);
  };
  for (const std::string name : {"machine", "stacked_box"})
    for (const std::string planner : {"blocking", "progressive"})
      EXPECT_EQ(plan(name, planner, "[{type: directions, weight: 0}, {type: gravity, weight: 0}]"),
                plan(name, planner, "[]"))
          << name << ", " << planner;
}

// A closed box with a plate in it lies on the lid of another box, with a tower beside it. Plates on the tower are equal
// to those under the lid and come out next to them, so that the closed box has to rise above them: it is forced open at
// another place than in the plan that was found first.
TEST_F(SessionTest, AForcedStepDoesNotKeepOthersFromABetterOrder) {
  std::vector<RawPart> parts = samples::make("stacked_box", {{"count", 2}});
  Aabb all;
  for (const RawPart& part : parts) all.extend(part.mesh.box());
  Mesh plate;
  for (const RawPart& part : parts)
    if (part.name.starts_with("plate")) plate = part.mesh;
  const auto add = [&](const std::string& name, const Mesh& mesh, const Eigen::Vector3d& lo) {
    parts.push_back({});
    parts.back().name = name;
    parts.back().mesh = shapes::moved(mesh, shapes::shift(lo - mesh.box().lo));
  };
  for (const RawPart& part : samples::make("closed_box", {{"size", 40}}))
    add("closed_" + part.name, part.mesh, Eigen::Vector3d(0, 0, all.hi.z()) + part.mesh.box().lo);
  const Eigen::Vector3d beside(all.hi.x() + 5, all.lo.y(), all.lo.z()), size = plate.box().size();
  const double high = 3 * all.size().z();
  add("tower", shapes::box({0, 0, 0}, {size.x(), size.y(), high}), beside);
  for (int i = 0; i < 2; ++i)
    add("upper" + std::to_string(i), plate, beside + Eigen::Vector3d(0, 0, high + i * size.z()));
  for (const std::string force : {"last_resort", "off"}) {
    const Session session(
        {{}, {"run.threads=1", "run.path_steps=200", "objective=[identical_parts]", "run.force=" + force}, {}});
    const LoadedAssembly loaded = session.load(InputParts{parts, "", {}, {}}, "boxes");
    const Plan plan = session.plan(loaded).plan;
    ASSERT_EQ(plan.status, force == "off" ? PlanStatus::partial : PlanStatus::forced);
    const PlanCheck check = session.verify(plan, *loaded.assembly);
    EXPECT_TRUE(check.valid) << (check.problems.empty() ? std::string() : check.problems.front().message);
    EXPECT_EQ(plan.objective.cost, 0);
  }
}

TEST_F(SessionTest, AJobShowsItsStepsAndStopsWhenItIsCancelled) {
  const Session session({{}, kOneThread, {}});
  const LoadedAssembly loaded = sample(session, "machine");
  RunContext job = session.context();
  std::size_t events = 0, steps = 0;
  job.on_progress = [&](const ProgressEvent&) { ++events; };
  const RunResult result =
      session.plan(loaded, job, {.on_step = [&](const Disassembly& so_far, const DisassemblyStep&) {
                     steps = so_far.steps().size();
                     if (steps == 2) job.cancel.cancel();
                   }});
  EXPECT_EQ(result.outcome, Outcome::cancelled);
  EXPECT_EQ(result.plan.disassembly.size(), steps);
  EXPECT_LT(result.plan.disassembly.size(), loaded.assembly->parts.size() - 1);
  EXPECT_GT(events, 0u);
  // Another job of the session is not concerned.
  EXPECT_EQ(session.plan(sample(session, "peg_in_hole")).outcome, Outcome::solved);
}

TEST_F(SessionTest, AnAssemblyOfOtherSettingsIsRefused) {
  const Session coarse({{}, {"assembly.subdivide=2", "run.threads=1"}, {}}), fine({{}, kOneThread, {}});
  const LoadedAssembly loaded = sample(coarse, "peg_in_hole");
  EXPECT_NE(message_of<Error>([&] { fine.plan(loaded); }).find("assembly.subdivide"), std::string::npos);
}

TEST_F(SessionTest, ConstraintsNeedAPlannerThatKeepsThem) {
  const fs::path config =
      write("config.yaml", "schema: 1\nsequence_planner: {type: progressive}\nconstraints: {target: peg}\n");
  const Session session({config, kOneThread, {}});
  for (const std::string& text : {message_of<Error>([&] { session.check(); }),
                                  message_of<Error>([&] { session.plan(sample(session, "peg_in_hole")); })}) {
    EXPECT_NE(text.find("'progressive' does not keep any"), std::string::npos) << text;
    EXPECT_NE(text.find("'blocking'"), std::string::npos) << text;
  }
  session.check({.part = "peg"});  // the path of one part has no order
}

TEST_F(SessionTest, AReaderPlansNothing) {
  const Session reader = Session::reader();
  EXPECT_THROW(reader.config(), std::logic_error);
  EXPECT_THROW(sample(reader, "peg_in_hole"), std::logic_error);
}

}  // namespace
}  // namespace dismantle
