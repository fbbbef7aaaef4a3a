#include "tools/child_processes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "tools/exit_code.h"

namespace gltf_radiosity::tools {
namespace {

using namespace std::chrono_literals;

EndedChild end_of(const ChildProcesses::Work& work) {
  ChildProcesses children;
  EXPECT_EQ(children.start(7, work), 0);
  EXPECT_EQ(children.running_count(), 1U);
  std::optional<EndedChild> ended;
  while (!ended) ended = children.wait(1s);
  EXPECT_EQ(children.running_count(), 0U);
  EXPECT_EQ(ended->task, 7U);
  return *ended;
}

TEST(ChildProcesses, AnswerAndExitCodeComeBack) {
  const EndedChild ended = end_of([](std::string& answer) {
    answer = std::string(100'000, 'x');
    return 3;
  });
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.answer, std::string(100'000, 'x'));
  EXPECT_GT(ended.peak_memory_bytes, 100'000U);
}

TEST(ChildProcesses, WhatAChildDoesIsNotDoneHere) {
  int value = 1;
  EXPECT_EQ(end_of([&value](std::string& /*answer*/) { return value = 2; }).exit_code, 2);
  EXPECT_EQ(value, 1);
}

TEST(ChildProcesses, ACrashIsSeenAndEndsNothingElse) {
  const EndedChild ended = end_of([](std::string& /*answer*/) -> int {
    std::signal(SIGABRT, SIG_DFL);
    std::abort();
  });
  EXPECT_EQ(ended.signal, SIGABRT);
}

TEST(ChildProcesses, AnExceptionIsABug) {
  const EndedChild ended = end_of([](std::string& /*answer*/) -> int { throw std::runtime_error("a bug"); });
  EXPECT_EQ(ended.exit_code, kExitInternal);
  EXPECT_EQ(ended.answer, "a bug");
}

TEST(ChildProcesses, SeveralRunAtOnce) {
  // The first waits for the second, through a pipe: one after the other they would wait for ever.
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ChildProcesses children;
  children.start(0, [&ends](std::string& /*answer*/) {
    char byte = 0;
    return ::read(ends[0], &byte, 1) == 1 ? 0 : 1;
  });
  children.start(1, [&ends](std::string& /*answer*/) { return ::write(ends[1], "x", 1) == 1 ? 0 : 1; });
  while (children.running_count() > 0) {
    const auto ended = children.wait(1s);
    EXPECT_EQ(ended ? ended->exit_code : 0, 0);
  }
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(ChildProcesses, SignalsReachThemAndPatienceEnds) {
  ChildProcesses children;
  children.start(0, [](std::string& /*answer*/) {
    for (;;) ::pause();
    return 0;
  });
  EXPECT_FALSE(children.wait(1ms).has_value());
  children.send(SIGKILL);
  std::optional<EndedChild> ended;
  while (!ended) ended = children.wait(1s);
  EXPECT_EQ(ended->signal, SIGKILL);
}

TEST(ChildProcesses, WhatIsLeftIsKilled) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    ChildProcesses children;
    children.start(0, [](std::string& /*answer*/) {
      for (;;) ::pause();
      return 0;
    });
  }
  // Nobody holds the pipe's other end any more.
  ::close(ends[1]);
  char byte = 0;
  EXPECT_EQ(::read(ends[0], &byte, 1), 0);
  ::close(ends[0]);
}

}  // namespace
}  // namespace gltf_radiosity::tools
