// Children that scripts of the shell play.
#include "dismantle/process/child.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "dismantle/errors.h"

namespace dismantle::process {
namespace {

Program script(const std::string& text, const Limits& limits = {}) {
  Program out;
  out.command = {"/bin/sh", "-c", text};
  out.limits = limits;
  return out;
}

End run_script(const std::string& text, const Limits& limits = {}) {
  return run(script(text, limits), [] { return false; });
}

TEST(Child, ArgumentsArriveAsTheyAre) {
  Program program = script("printf '%s|' \"$@\"");
  program.command.insert(program.command.end(), {"name", "a b", "$(touch x)", "'\"", ""});
  const End end = run(program, [] { return false; });
  EXPECT_EQ(end.status, 0);
  EXPECT_EQ(end.last_words, "a b|$(touch x)|'\"||");
}

TEST(Child, OutputIsPassedOnWholeAndApartFromMessages) {
  Program program = script("echo note >&2; head -c 300000 /dev/zero; echo end");
  std::string out;
  program.output = [&](std::span<const std::byte> bytes) {
    out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return true;
  };
  const End end = run(program, [] { return false; });
  EXPECT_EQ(end.status, 0);
  EXPECT_EQ(out, std::string(300000, '\0') + "end\n");
  EXPECT_EQ(end.last_words, "note\n");
}

TEST(Child, EndsAreTold) {
  EXPECT_EQ(run_script("exit 5").status, 5);
  EXPECT_EQ(run_script("kill -SEGV $$").signal, SIGSEGV);
  const End end = run_script("i=0; while [ $i -lt 2000 ]; do echo line $i; i=$((i+1)); done");
  EXPECT_EQ(end.last_words.size(), 4096u);
  EXPECT_TRUE(end.last_words.ends_with("line 1999\n"));
  EXPECT_EQ(run_script("cat").status, 0);  // its input is empty
}

TEST(Child, WhatCannotBeStartedIsNamedWithTheReason) {
  Program program;
  program.command = {"/no/such/program"};
  try {
    Child child(program);
    FAIL() << "started";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()), "cannot start /no/such/program: No such file or directory");
  }
}

TEST(Child, LimitsOfTimeEndIt) {
  for (const char* text : {"sleep 1000", "exec >&- 2>&-; sleep 1000", "sleep 1000 & wait"}) {
    const End end = run_script(text, {.wall = 0.2});
    EXPECT_TRUE(end.out_of_wall && !end.out_of_cpu) << text;
    EXPECT_EQ(end.signal, SIGKILL) << text;
  }
  const End busy = run_script("while :; do :; done", {.wall = 1000, .cpu = 1});
  EXPECT_TRUE(busy.out_of_cpu && !busy.out_of_wall);
  EXPECT_GE(busy.cpu_seconds, 0.9);
  const End quick = run_script("exit 3", {.wall = 1000, .cpu = 1000});
  EXPECT_FALSE(quick.out_of_cpu || quick.out_of_wall);
}

TEST(Child, LimitsOfSizeArrive) {
  EXPECT_EQ(run_script("ulimit -f; ulimit -c", {.file_size = 1 << 20}).last_words, "2048\n0\n");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_EQ(run_script("ulimit -v", {.memory = std::uint64_t{1} << 30}).last_words, "1048576\n");
#endif
}

TEST(Child, IsStoppedByWhoWaitsAndByWhoReads) {
  End end = run(script("sleep 1000"), [] { return true; });
  EXPECT_TRUE(end.stopped);
  Program program = script("while :; do echo more; done");
  program.output = [](auto) { return false; };
  end = run(program, [] { return false; });
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.signal, SIGKILL);
}

/// A killed process that its new parent has not reaped yet still has an id, but no command line.
bool is_gone(const std::string& id) {
  for (int i = 0; i < 100000; ++i) {
    std::ifstream command("/proc/" + id + "/cmdline");
    std::string text;
    if (!std::getline(command, text)) return true;
    std::this_thread::yield();
  }
  return false;
}

TEST(Child, NothingOfItsGroupIsLeft) {
  for (const char* end : {"wait", "exit 0", "kill -KILL $$"}) {
    const std::string id = run_script(std::string("sleep 1000 & echo $!; ") + end, {.wall = 0.3}).last_words;
    ASSERT_GT(id.size(), 1u);
    EXPECT_TRUE(is_gone(id.substr(0, id.size() - 1))) << end;
  }
}

TEST(Child, NothingOfItsTreeIsLeft) {
  Program program = script("setsid sh -c 'echo $$; exec sleep 1000' & sleep 1000");  // setsid: out of the group
  program.whole_tree = true;
  Child child(program);
  const Child* const one[] = {&child};
  while (!child.ended() && child.end().last_words.empty()) Child::wait(one);
  const std::string id = child.end().last_words;
  ASSERT_TRUE(id.ends_with("\n")) << id;
  child.kill();
  while (!child.ended()) Child::wait(one);
  EXPECT_TRUE(is_gone(id.substr(0, id.size() - 1)));
}

TEST(Child, SeveralAreWaitedForTogether) {
  Child first(script("echo one")), second(script("sleep 1000"));
  const Child* const both[] = {&first, &second};
  while (!first.ended()) Child::wait(both);
  EXPECT_EQ(first.end().last_words, "one\n");
  EXPECT_FALSE(second.ended());
  second.kill();
  while (!second.ended()) Child::wait(both);
  EXPECT_EQ(second.end().signal, SIGKILL);
}

TEST(Child, ACopyOfThisProcessGetsSignalsFromItsParentAlone) {
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, SIGUSR1);
  sigprocmask(SIG_BLOCK, &one, nullptr);  // before the fork, so that the signal cannot come too early
  Child child(Limits{});
  if (child.is_copy()) {
    int got = 0;
    sigwait(&one, &got);
    _exit(got == SIGUSR1 && getpgrp() == getpid() ? 7 : 1);
  }
  child.signal(SIGUSR1);
  while (!child.ended()) Child::wait({});
  EXPECT_EQ(child.end().status, 7);
}

}  // namespace
}  // namespace dismantle::process
