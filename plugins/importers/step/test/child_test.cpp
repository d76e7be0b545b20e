// Failures of the reader program, which scripts replace.
#include <gtest/gtest.h>

#include <thread>

#include "scratch.h"
#include "step_importer.h"

namespace dismantle::step_import {
namespace {

using testing::input_error;
using testing::Scratch;

class StepChild : public ::testing::Test {
 protected:
  std::string error_with(const std::string& script, const StepParameters& params = {}) {
    StepImporter importer(params, scratch_.program("reader", script));
    return input_error([&] { importer.read(file_, {}); });
  }

  Scratch scratch_;
  std::filesystem::path file_ = scratch_.write("gear box.step", testing::empty_step());
};

TEST_F(StepChild, EveryEndBecomesAnErrorThatNamesTheFile) {
  for (const char* script :
       {"exit 0\n", "exit 3\n", "kill -SEGV $$\n", "kill -KILL $$\n", "echo garbage\n", "head -c 3000000 /dev/zero\n",
        "printf DSMREAD2\n", "printf 'DSMREAD2Z\\004\\0\\0\\0\\001\\0\\0\\0'\n"}) {
    const std::string error = error_with(script);
    EXPECT_NE(error.find("gear box.step: "), std::string::npos) << script << error;
    EXPECT_NE(error.find("export"), std::string::npos) << script << error;
  }
}

TEST_F(StepChild, ErrorsSayWhatHappened) {
  EXPECT_NE(error_with("kill -SEGV $$\n").find("crashed on it (signal 11"), std::string::npos);
  EXPECT_NE(error_with("echo 'terminate called after throwing std::bad_alloc' >&2; kill -ABRT $$\n")
                .find("importers.step.memory_limit"),
            std::string::npos);
  EXPECT_NE(
      error_with("echo 'libTKernel.so.7.6: cannot open shared object file' >&2; exit 127\n").find("libTKernel.so.7.6"),
      std::string::npos);
  EXPECT_NE(error_with("echo garbage\n").find("does not begin as it should"), std::string::npos);
  EXPECT_NE(error_with("exit 5\n").find("status 5"), std::string::npos);
}

TEST_F(StepChild, AMissingReaderSaysWhatToInstall) {
  StepImporter importer({}, scratch_ / "nothing here");
  const std::string error = input_error([&] { importer.read(file_, {}); });
  EXPECT_NE(error.find("gear box.step: "), std::string::npos) << error;
  EXPECT_NE(error.find("libocct-data-exchange-dev"), std::string::npos) << error;
  EXPECT_NE(error.find("build again"), std::string::npos) << error;
}

TEST_F(StepChild, AHangIsEndedByTheTimeLimitAndByWhoWaits) {
  StepParameters params;
  params.time_limit = 0.2;
  for (const char* script :
       {"sleep 1000\n", "exec >&- 2>&-; sleep 1000\n", "while :; do :; done\n", "sleep 1000 & wait\n"}) {
    const std::string error = error_with(script, params);
    EXPECT_NE(error.find("longer than 0.2 s: raise importers.step.time_limit"), std::string::npos) << script << error;
  }
  // Cancelled from another thread: an Error, not an InputError.
  StepImporter importer({}, scratch_.program("reader", "sleep 1000\n"));
  RunContext context;
  std::jthread other([cancel = context.cancel] { cancel.cancel(); });
  try {
    importer.read(file_, context);
    FAIL() << "it should have been stopped";
  } catch (const InputError& e) {
    FAIL() << e.what();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("stopped while reading"), std::string::npos);
  }
}

TEST_F(StepChild, NothingIsLeftRunning) {
  StepParameters params;
  params.time_limit = 0.3;
  error_with("sleep 1000 & echo $! > '" + (scratch_ / "grandchild").string() + "'; wait\n", params);
  std::ifstream in(scratch_ / "grandchild");
  pid_t id = 0;
  ASSERT_TRUE(in >> id);
  // A killed process that its new parent has not reaped yet still has an id, but no command line.
  for (int i = 0; i < 1000; ++i) {
    std::ifstream command("/proc/" + std::to_string(id) + "/cmdline");
    std::string text;
    if (!std::getline(command, text)) return;
    std::this_thread::yield();
  }
  FAIL() << "process " << id << " is still there";
}

TEST_F(StepChild, FilesThatAreNoWholeStepFilesAreRefusedUnread) {
  StepImporter importer({}, scratch_.program("reader", "touch '" + (scratch_ / "started").string() + "'\n"));
  const auto error = [&](const std::string& bytes) {
    return input_error([&] { importer.read(scratch_.write("a.stp", bytes), {}); });
  };
  EXPECT_NE(error("solid x\nendsolid\n").find("this is no STEP file"), std::string::npos);
  EXPECT_NE(error("").find("this is no STEP file"), std::string::npos);
  const std::string whole = testing::empty_step();
  EXPECT_NE(error(whole.substr(0, whole.size() - 5)).find("cut off"), std::string::npos);
  EXPECT_NE(input_error([&] { importer.read(scratch_ / "none.step", {}); }).find("cannot be opened"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "started"));
}

}  // namespace
}  // namespace dismantle::step_import
