#include "tests/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

ChildCommand shell(const std::string& script) {
  ChildCommand command;
  command.arguments = {"sh", "-c", script};
  return command;
}

TEST(ChildProcess, CapturesBothStreamsAndTheExitCode) {
  const FinishedProcess finished = run_to_end(shell("echo out; echo error >&2; exit 3"), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_EQ(finished.standard_output, "out\n");
  EXPECT_EQ(finished.standard_error, "error\n");
}

TEST(ChildProcess, DoesNotBlockOnMoreOutputThanAPipeHolds) {
  const FinishedProcess finished = run_to_end(shell("head -c 1000000 /dev/zero"), kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.standard_output.size(), 1000000U);
}

TEST(ChildProcess, IsReadableWhileItRunsAndEndsBySignal) {
  ChildProcess child(shell("echo ready; exec sleep 600"));
  EXPECT_TRUE(child.wait_for_text("ready\n", kWaitTimeout));
  EXPECT_EQ(child.wait(0.0), std::nullopt);
  child.send_signal(SIGTERM);
  EXPECT_EQ(child.wait(kWaitTimeout), 128 + SIGTERM);
}

TEST(ChildProcess, StopsWaitingForTextThatNeverCame) {
  ChildProcess child(shell("echo something else"));
  EXPECT_FALSE(child.wait_for_text("ready", kWaitTimeout));
  EXPECT_EQ(child.wait(0.0), 0);
}

TEST(ChildProcess, IsGoneAfterItsDestructor) {
  pid_t pid = 0;
  {
    const ChildProcess child(shell("exec sleep 600"));
    pid = child.pid();
  }
  EXPECT_EQ(kill(pid, 0), -1);
}

TEST(ChildProcess, GivesEnvironmentDirectoryAndOutputFile) {
  ChildCommand command = shell("echo $GREETING $(pwd); test -e /dev/full");
  command.environment = {"GREETING=hello"};
  command.directory = std::string("/");
  EXPECT_EQ(run_to_end(command, kWaitTimeout).standard_output, "hello /\n");
  command.standard_output = "/dev/full";
  EXPECT_EQ(run_to_end(command, kWaitTimeout).standard_output, "");
}

TEST(ChildProcess, ExitsWith127WhereTheProgramIsMissing) {
  ChildCommand command;
  command.arguments = {"/no/such/program"};
  const FinishedProcess finished = run_to_end(command, kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 127);
  EXPECT_NE(finished.standard_error.find("/no/such/program"), std::string::npos);
}

}  // namespace
}  // namespace buoyancy
