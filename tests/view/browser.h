// Drives a page in Debian's headless Chromium with software-rendered WebGL, through Debian's chromedriver
// (WebDriver: JSON over HTTP).
//
// The browser reaches only this machine's loopback and files; no other host resolves, so that a page that
// needs the network fails on every machine. It needs no display, no network beyond the loopback and no
// privileges. One pixel of the page is one pixel of a screenshot; colours are sRGB.
//
// Starting takes one to two seconds on an idle machine: use one browser for all tests of a program, see
// page_test.h. Every failure throws std::runtime_error with its cause; nothing waits longer than
// kWaitTimeout. Not thread-safe.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/json.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"
#include "tests/view/image.h"

namespace httplib {
class Client;
}

namespace buoyancy::view {

struct Screen {  // the viewport of the page
  int width = 0;
  int height = 0;
  bool phone = false;  // with touch; 980 pixels wide for a page without <meta name="viewport">
};

inline constexpr Screen kDesktop{1280, 720, false};
inline constexpr Screen kPhone{390, 844, true};

class Browser {
 public:
  // The destructor returns when all processes have ended; if the test is killed, they end soon after it.
  explicit Browser(const Screen& screen = kDesktop);
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;
  ~Browser();

  // Lays out an open page again.
  void resize(const Screen& screen);

  // These return after the page's load event and discard the console messages of an earlier page.
  void open(const std::string& url);
  void open_file(const std::string& path);

  // Runs the body of a function with arguments[0] and so on, and returns its result as JSON: null for
  // undefined, the resolved value for a promise. Throws what the script throws.
  template <typename... Arguments>
  nlohmann::json run(const std::string& script, const Arguments&... arguments) {
    nlohmann::json list = nlohmann::json::array();
    (list.push_back(nlohmann::json(arguments)), ...);
    return execute(script, list);
  }

  // Returns the expression's value as soon as it is truthy; an expression that throws counts as false. After
  // `seconds`, throws an error with the last value and the console's errors.
  nlohmann::json wait_until(const std::string& expression, double seconds = kWaitTimeout);

  // The console messages of level "error" since the page was opened or since the last call: console.error,
  // uncaught exceptions and rejections, resources that could not be loaded. From a server, Chromium also
  // requests /favicon.ico unless the page has an icon: <link rel="icon" href="data:,">.
  std::vector<std::string> console_errors();

  // Clicks the middle of the first element that matches the CSS selector, after scrolling to it if necessary.
  // Throws if there is none or if another element covers it.
  void click(const std::string& selector);

  // Drags from the element's middle with the left button, by `right` and `down` [pixels].
  void drag(const std::string& selector, int right, int down);

  // Presses and releases one key for the element that has the focus: a character, or a name of
  // KeyboardEvent.key (ArrowLeft, ArrowUp, ArrowRight, ArrowDown, Home, End, PageUp, PageDown, Enter, Escape,
  // Tab).
  void press(std::string_view key);

  // The viewport, in the size of the screen.
  Image screenshot();

  // The region of a screenshot with the first element that matches the selector, clipped to the screen; it
  // may be empty.
  Region region_of(const std::string& selector);

 private:
  nlohmann::json execute(const std::string& script, const nlohmann::json& arguments);
  nlohmann::json command(const std::string& path, const nlohmann::json& body);
  nlohmann::json send(const std::string& path, const std::string& body);  // GET if body is empty
  void development_tool(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json element(const std::string& selector);
  void act(const std::string& type, const nlohmann::json& actions);
  std::string format_console_errors();

  TempDir directory_;  // home, profile, temporary files
  ChildProcess chromium_;
  ChildProcess chromedriver_;
  std::unique_ptr<httplib::Client> client_;
  std::string session_;  // path of its WebDriver session
  Screen screen_;
};

}  // namespace buoyancy::view
