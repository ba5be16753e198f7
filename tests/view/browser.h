// A page as somebody meets it: Debian's headless Chromium, WebGL drawn by the processor, driven through
// Debian's chromedriver (WebDriver: JSON over HTTP).
//
// The browser reaches this machine's loopback and files and nothing else: every other host is unknown to it,
// so that a page that needs the network fails everywhere, not only where there is none. It needs no display,
// no network beyond loopback and no right; one pixel of the page is one of the picture, colours are sRGB.
//
// Starting takes a second or two of an idle machine: one browser for all tests of a program, see page_test.h.
// Whatever goes wrong throws std::runtime_error that says what; nothing waits longer than kWaitTimeout. One
// thread at a time.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"
#include "tests/view/image.h"

namespace httplib {
class Client;
}

namespace buoyancy::view {

struct Screen {  // what the page has to itself, without the window around it
  int width = 0;
  int height = 0;
  bool phone = false;  // touch, and 980 pixels wide for a page without <meta name="viewport">
};

inline constexpr Screen kDesktop{1280, 720, false};
inline constexpr Screen kPhone{390, 844, true};

class Browser {
 public:
  // All its processes have ended when the destructor returns; if the test is killed, they end soon after it.
  explicit Browser(const Screen& screen = kDesktop);
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;
  ~Browser();

  // A page that is open is laid out anew.
  void resize(const Screen& screen);

  // Return after the page's load event; what an earlier page wrote to the console is forgotten.
  void open(const std::string& url);
  void open_file(const std::string& path);

  // Runs the body of a function, with arguments[0] and so on, and returns what it returns: JSON (undefined is
  // null), and of a promise what it comes to. Throws what the script throws.
  template <typename... Arguments>
  nlohmann::json run(const std::string& script, const Arguments&... arguments) {
    nlohmann::json list = nlohmann::json::array();
    (list.push_back(nlohmann::json(arguments)), ...);
    return execute(script, list);
  }

  // Returns the expression's value as soon as JavaScript takes it for true. An expression that throws is not
  // true yet. What it throws after `seconds` holds the last value, and the console's errors.
  nlohmann::json wait_until(const std::string& expression, double seconds = kWaitTimeout);

  // What the console got at level "error" since the page was opened or since the last call: console.error,
  // uncaught exceptions and rejections, whatever could not be loaded. Of a server Chromium also wants
  // /favicon.ico, unless the page has an icon: <link rel="icon" href="data:,">.
  std::vector<std::string> console_errors();

  // In the middle of the first element that fits the CSS selector, scrolled to if need be. Throws where there
  // is none, or where another element lies above it.
  void click(const std::string& selector);

  // From the element's middle with the left button down, to the right and down by so many pixels.
  void drag(const std::string& selector, int right, int down);

  // One key, down and up, for the element that has the focus: a character, or a name as KeyboardEvent.key has
  // it (ArrowLeft, ArrowUp, ArrowRight, ArrowDown, Home, End, PageUp, PageDown, Enter, Escape, Tab).
  void press(std::string_view key);

  // What is on the screen, as large as the screen.
  Image screenshot();

  // Where the first element that fits the selector is in a screenshot: the part of it that is on the screen,
  // which may be empty.
  Region region_of(const std::string& selector);

 private:
  nlohmann::json execute(const std::string& script, const nlohmann::json& arguments);
  nlohmann::json command(const std::string& path, const nlohmann::json& body);
  nlohmann::json send(const std::string& path, const std::string& body);  // an empty body: GET
  void development_tool(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json element(const std::string& selector);
  void act(const std::string& type, const nlohmann::json& actions);
  std::string console_errors_in_lines();

  TempDir directory_;  // its home, its profile, its temporary files
  ChildProcess chromium_;
  ChildProcess chromedriver_;
  std::unique_ptr<httplib::Client> client_;
  std::string session_;  // path
  Screen screen_;
};

}  // namespace buoyancy::view
