#include "tests/support/child_process.h"

#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/contains.h"
#include "tests/support/running_program.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

ChildCommand shell(const std::string& script) {
  ChildCommand command;
  command.arguments = {"sh", "-c", script};
  return command;
}

TEST(ChildProcess, CapturesBothStreamsAndExitCode) {
  const FinishedProcess finished = run_to_end(shell("echo out; echo error >&2; exit 3"), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_EQ(finished.standard_output, "out\n");
  EXPECT_EQ(finished.standard_error, "error\n");
}

TEST(ReadFile, ReturnsNothingWhereReadingFails) {
  const TempDir directory;
  EXPECT_EQ(read_file(directory.path("missing")), "");
  EXPECT_EQ(read_file(directory.path("")), "") << "a directory can be opened and not read";
  EXPECT_EQ(read_file(directory.write("file", "text")), "text");
}

TEST(ChildProcess, DoesNotBlockOnLargeOutput) {
  const FinishedProcess finished = run_to_end(shell("head -c 1000000 /dev/zero"), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.standard_output.size(), 1000000U);
}

TEST(ChildProcess, IsReadableWhileRunningAndEndsBySignal) {
  ChildProcess child(shell("echo ready; exec sleep 600"));
  EXPECT_TRUE(child.wait_for_text("ready\n", kWaitTimeout));
  EXPECT_EQ(child.wait(0.0), std::nullopt);
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 128 + SIGTERM);
}

TEST(ChildProcess, StopsWaitingForTextWhenChildEnds) {
  ChildProcess child(shell("echo something else"));
  EXPECT_FALSE(child.wait_for_text("ready", kWaitTimeout));
  EXPECT_EQ(child.wait(0.0), 0);
}

TEST(ChildProcess, KillsChildInDestructor) {
  pid_t pid = 0;
  {
    const ChildProcess child(shell("exec sleep 600"));
    pid = child.pid();
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

ChildCommand with_descendants(const std::string& script) {
  ChildCommand command = shell(script);
  command.with_descendants = true;
  return command;
}

// Starts two processes in sessions of their own, one of which has lost its parent, and prints their ids.
const std::string kStartDescendants =
    "setsid sh -c 'echo $$; exec sleep 600' & (setsid sh -c 'echo $$; exec sleep 600' &); "
    "while [ $(wc -l <out) -lt 2 ]; do sleep 0.01; done; ";

class ChildProcessDescendants : public testing::Test {
 protected:
  // A command whose output goes to the file whose lines kStartDescendants counts.
  ChildCommand command(const std::string& script) const {
    ChildCommand whole = with_descendants(kStartDescendants + script);
    whole.directory = directory_.path("");
    whole.standard_output = directory_.path("out");
    return whole;
  }
  // The number of running processes among those that the program printed.
  int count_running() const {
    std::ifstream file(directory_.path("out"));
    int count = 0;
    for (pid_t pid = 0; file >> pid;) count += kill(pid, 0) == 0 ? 1 : 0;
    return count;
  }

 private:
  TempDir directory_;
};

TEST_F(ChildProcessDescendants, AreKilledWhenProgramEnds) {
  ChildProcess child(command("exit 3"));
  EXPECT_EQ(child.wait(kWaitTimeout), 3);
  EXPECT_EQ(count_running(), 0);
}

TEST_F(ChildProcessDescendants, AreKilledInDestructor) {
  {
    ChildProcess child(command("echo started >&2; exec sleep 600"));
    EXPECT_TRUE(child.wait_for_text("started", kWaitTimeout));
    EXPECT_EQ(count_running(), 2);
  }
  EXPECT_EQ(count_running(), 0);
}

TEST_F(ChildProcessDescendants, AreKilledWhenProgramHandlesSignal) {
  ChildProcess child(command("trap 'exit 5' TERM; echo started >&2; while :; do sleep 0.01; done"));
  EXPECT_TRUE(child.wait_for_text("started", kWaitTimeout));
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 5);
  EXPECT_EQ(count_running(), 0);
  child.send_signal(SIGTERM);
}

TEST(ChildProcess, SetsEnvironmentDirectoryAndOutputFile) {
  ChildCommand command = shell("echo $GREETING $(pwd); test -e /dev/full");
  command.environment = {"GREETING=hello"};
  command.directory = std::string("/");
  EXPECT_EQ(run_to_end(command, kWaitTimeout).standard_output, "hello /\n");
  command.standard_output = "/dev/full";
  EXPECT_EQ(run_to_end(command, kWaitTimeout).standard_output, "");
}

TEST(ChildProcess, ExitsWith127IfProgramIsMissing) {
  ChildCommand command;
  command.arguments = {"/no/such/program"};
  const FinishedProcess finished = run_to_end(command, kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 127);
  EXPECT_TRUE(contains(finished.standard_error, "/no/such/program"));
}

TEST(RunningProgram, ReturnsOnceProgramIsReady) {
  // The program starts slowly, so that a constructor that did not wait would return before.
  RunningProgram program(shell("sleep 0.2; echo ready: >&2; exec sleep 600"));
  EXPECT_EQ(program.standard_error(), "ready:\n");
  EXPECT_EQ(program.wait(0.0), std::nullopt);
}

TEST(RunningProgram, ThrowsStandardErrorIfProgramEndsFirst) {
  try {
    const RunningProgram program(shell("echo no scene >&2; exit 2"));
    FAIL() << "it is not ready";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "sh did not become ready: no scene\n");
  }
}

}  // namespace
}  // namespace buoyancy
