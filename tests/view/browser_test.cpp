#include "tests/view/browser.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"
#include "tests/view/page_test.h"
#include "view/live/page_server.h"

namespace buoyancy::view {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class BrowserTest : public PageTest {
 protected:
  BrowserTest() { may_report_errors_ = true; }

  // Opens a page with this body.
  void show(const std::string& body) {
    browser().open_file(directory_.write(
        "page #1.html",
        "<!doctype html><meta charset='utf-8'><meta name='viewport' content='width=device-width'>"
        "<style>body { margin: 0; background: white }</style>" +
            body));
  }

  static std::string thrown_message(const std::function<void()>& act) {
    try {
      act();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing";
  }

 private:
  TempDir directory_;
};

TEST_F(BrowserTest, ReturnsConsoleErrorsOnly) {
  show(R"(<script>
      console.log("logged");
      console.warn("warned");
      console.error("something", 42);
      setTimeout(() => { throw new Error("nobody caught me"); });
      Promise.reject(new Error("nobody caught the promise"));
      setTimeout(() => { window.done = true; });
    </script><img src="not_there.png">)");
  browser().wait_until("window.done");
  const std::vector<std::string> errors = browser().console_errors();
  EXPECT_EQ(errors.size(), 4U);
  EXPECT_THAT(errors, Contains(HasSubstr("\"something\" 42")));
  EXPECT_THAT(errors, Contains(HasSubstr("nobody caught me")));
  EXPECT_THAT(errors, Contains(HasSubstr("nobody caught the promise")));
  EXPECT_THAT(errors, Contains(HasSubstr("not_there.png")));
  EXPECT_THAT(browser().console_errors(), IsEmpty());
}

TEST_F(BrowserTest, DiscardsErrorsOfPreviousPage) {
  show("<script>console.error('of the previous page')</script>");
  show("<script>console.error('of this page')</script>");
  EXPECT_THAT(browser().console_errors(), ElementsAre(HasSubstr("of this page")));
}

TEST_F(BrowserTest, RefusesWhatItCannotDo) {
  show(R"(<button id="go">go</button><div style="position: fixed; inset: 0"></div>)");
  EXPECT_THAT(thrown_message([] { browser().run("throw new Error('out of water')"); }),
              HasSubstr("out of water"));
  EXPECT_THAT(thrown_message([] { browser().press("ArrowSideways"); }), HasSubstr("invalid argument"));
  EXPECT_THAT(thrown_message([] { browser().click("#go"); }), HasSubstr("click intercepted"));
  EXPECT_THAT(thrown_message([] { browser().click("#nowhere"); }), HasSubstr("#nowhere"));
}

TEST_F(BrowserTest, ReportsLastValueOnTimeout) {
  show("<script>console.error('the duck is lost'); window.steps = 0;</script>");
  EXPECT_THAT(
      thrown_message([] { browser().wait_until("steps > 0 && 'done'", 0.1); }),
      testing::AllOf(HasSubstr("steps > 0"), HasSubstr("it is false"), HasSubstr("the duck is lost")));
  EXPECT_THAT(thrown_message([] { browser().wait_until("replay.ready", 0.1); }),
              HasSubstr("ReferenceError: replay is not defined"));
  browser().run("setTimeout(() => { window.steps = 7; }, 50)");
  EXPECT_EQ(browser().wait_until("steps"), 7);
}

TEST_F(BrowserTest, ResolvesNoOtherHost) {
  show(R"(<script>
      const fetched = url => fetch(url, {mode: "no-cors"}).then(() => "reached", error => "refused");
      window.all = Promise.all([fetched("http://example.org/"), fetched("http://192.0.2.1/")]);
    </script>)");
  EXPECT_EQ(browser().run("return window.all"), nlohmann::json({"refused", "refused"}));
  const std::vector<std::string> errors = browser().console_errors();
  EXPECT_THAT(errors, ElementsAre(HasSubstr("ERR_NAME_NOT_RESOLVED"), HasSubstr("ERR_NAME_NOT_RESOLVED")));
}

TEST_F(BrowserTest, OpensPageWithEndlessEventStream) {
  SnapshotBroadcaster broadcaster;
  const auto server = PageServer::start("127.0.0.1", 0,
                                        {{"/", "text/html",
                                          "<!doctype html><link rel='icon' href='data:,'>"
                                          "<script src='page.js'></script>"},
                                         {"/page.js", "text/javascript",
                                          "const received = [];"
                                          "new EventSource('events').onmessage = event => "
                                          "received.push(event.data);"}},
                                        broadcaster);
  ASSERT_TRUE(server) << server.error().message();
  const std::jthread publishing([&broadcaster](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      broadcaster.publish("[]", "a wave");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });

  const std::string error = thrown_message([&] {
    browser().open((*server)->url());
    EXPECT_EQ(browser().wait_until("received.length > 3 && received[3]"), "a wave");
    EXPECT_THAT(browser().console_errors(), IsEmpty());
    browser().open("about:blank");
  });
  EXPECT_EQ(error, "nothing");
}

// The number of processes with the path in their environment or arguments and the option in their arguments.
// Chromium overwrites a child's environment with its title, and chromedriver has the path only in its
// environment.
int count_processes(const std::string& path, const std::string& option = {}) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    // A process that has exited has neither, and one that is exiting cannot be read.
    const std::string arguments = read_file(entry.path() / "cmdline");
    const std::string environment = read_file(entry.path() / "environ");
    if ((arguments + environment).find(path) != std::string::npos &&
        arguments.find(option) != std::string::npos) {
      ++count;
    }
  }
  return count;
}

template <typename Condition>
bool becomes_true(Condition&& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

// A test of this program as a separate process, whose browser keeps its files in `directory`.
ChildCommand this_program(std::vector<std::string> arguments, const TempDir& directory) {
  arguments.insert(arguments.begin(), std::filesystem::read_symlink("/proc/self/exe").string());
  ChildCommand command = command_of(std::move(arguments));
  command.environment = {"TMPDIR=" + directory.path("")};
  return command;
}

// Not a test itself: shows a page until its standard input ends.
TEST_F(BrowserTest, DISABLED_ShowsPageUntilInputEnds) {
  show("<p>a page</p>");
  std::cout << "the page is shown" << std::endl;
  EXPECT_EQ(std::cin.get(), std::char_traits<char>::eof());
}

// That test as a process; the constructor returns when the page is shown.
class PageInAnotherProcess {
 public:
  explicit PageInAnotherProcess(const TempDir& directory) : test_(command(directory)) {
    // Opening either end of the FIFO waits for the other; the child opens its end before it starts the
    // program.
    writer_.open(input_.path("input"));
    if (!test_.wait_for_text("the page is shown", kWaitTimeout)) {
      throw std::runtime_error(test_.standard_output());
    }
  }

  ChildProcess& test() { return test_; }
  void end_input() { writer_.close(); }

 private:
  ChildCommand command(const TempDir& directory) const {
    ChildCommand child = this_program(
        {"--gtest_filter=*DISABLED_ShowsPageUntilInputEnds", "--gtest_also_run_disabled_tests"}, directory);
    child.standard_input = input_.path("input");
    if (::mkfifo(child.standard_input.c_str(), 0600) != 0) throw std::runtime_error("cannot create the FIFO");
    return child;
  }

  TempDir input_;
  ChildProcess test_;
  std::ofstream writer_;
};

TEST(BrowserLifecycle, LeavesNoProcessesOrFiles) {
  const TempDir directory;
  PageInAnotherProcess page(directory);
  EXPECT_GT(count_processes(directory.path(""), "--type=renderer"), 0);
  page.end_input();
  EXPECT_EQ(page.test().wait(kWaitTimeout), 0) << page.test().standard_output();
  EXPECT_EQ(count_processes(directory.path("")), 0);
  EXPECT_TRUE(std::filesystem::is_empty(directory.path("")));
}

TEST(BrowserLifecycle, EndsProcessesOfKilledTest) {
  const TempDir directory;
  PageInAnotherProcess page(directory);
  EXPECT_GT(count_processes(directory.path(""), "--type=renderer"), 0);
  EXPECT_GT(count_processes(directory.path(""), "chromedriver"), 0);
  page.test().send_signal(SIGKILL);
  EXPECT_EQ(page.test().wait(kWaitTimeout), 128 + SIGKILL);
  EXPECT_TRUE(becomes_true([&] { return count_processes(directory.path("")) == 0; }));
}

TEST(BrowserLifecycle, NamesMissingPackages) {
  const TempDir directory;
  ChildCommand without = this_program({"--gtest_filter=BrowserTest.DiscardsErrorsOfPreviousPage"}, directory);
  without.environment.emplace_back("PATH=" + directory.path(""));
  const FinishedProcess finished = run_to_end(without, kWaitTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.standard_output, HasSubstr("Install Debian's packages chromium and chromium-driver"));
  EXPECT_THAT(finished.standard_output, testing::Not(HasSubstr("SKIPPED")));
}

}  // namespace
}  // namespace buoyancy::view
