#include "tests/view/browser.h"

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <httplib.h>
#include <openssl/evp.h>

#include "tests/support/timeouts.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const std::string& message) {
  throw std::runtime_error("browser: " + message);
}

// Sets the home to a temporary directory; without D-Bus, Chromium does not look for the desktop's settings.
ChildCommand with_temporary_home(std::vector<std::string> arguments, const TempDir& directory) {
  std::filesystem::create_directories(directory.path("tmp"));
  ChildCommand command = command_of(std::move(arguments));
  command.with_descendants = true;
  command.environment = {
      "HOME=" + directory.path("home"),           "XDG_CONFIG_HOME=" + directory.path("home"),
      "XDG_CACHE_HOME=" + directory.path("home"), "TMPDIR=" + directory.path("tmp"),
      "DBUS_SESSION_BUS_ADDRESS=disabled:",       "LANGUAGE=en",
  };
  return command;
}

// Chromium is started here and chromedriver attaches to it: a Chromium that chromedriver starts outlives a
// killed chromedriver.
ChildCommand chromium(const TempDir& directory) {
  return with_temporary_home(
      {
          "chromium",
          "--headless=new",
          "--remote-debugging-port=0",
          "--user-data-dir=" + directory.path("profile"),
          // The sandbox is unavailable to root and in most containers, and the pages are trusted.
          "--no-sandbox",
          // A container's /dev/shm is often too small.
          "--disable-dev-shm-usage",
          "--use-angle=swiftshader",
          "--enable-unsafe-swiftshader",
          // GPU rasterization and compositing with software rendering only slow the page down.
          "--disable-gpu-compositing",
          "--disable-gpu-rasterization",
          // Chromium drops keys and clicks that arrive before the first frame of a page is drawn.
          // chromedriver sets this for each Chromium that it starts itself.
          "--allow-pre-commit-input",
          "--force-color-profile=srgb",
          "--force-device-scale-factor=1",
          "--lang=en-GB",
          "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE localhost, EXCLUDE 127.0.0.1",
          "--no-proxy-server",
          "--disable-background-networking",
          "--disable-component-update",
          "--disable-sync",
          "--no-first-run",
          "about:blank",
      },
      directory);
}

ChildCommand chromedriver(const TempDir& directory) {
  return with_temporary_home({"chromedriver", "--port=0"}, directory);
}

// The port in the line that a program prints when it listens.
int wait_for_port(ChildProcess& program, const std::string& name, const std::regex& pattern) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  std::optional<int> exit_code;
  std::string output;
  while (!exit_code && std::chrono::steady_clock::now() < deadline) {
    exit_code = program.wait(0.01);
    output = program.standard_output() + program.standard_error();
    std::smatch match;
    if (std::regex_search(output, match, pattern)) return std::stoi(match[1]);
  }
  if (exit_code == 127) {
    fail(name + " not found. Install Debian's packages chromium and chromium-driver (scripts/setup test). " +
         "Output: " + output);
  }
  if (exit_code)
    fail(name + " exited with " + std::to_string(*exit_code) + " before it was ready: " + output);
  fail(name + " did not become ready: " + output);
}

std::string decode_base64(const std::string& base64) {
  std::string bytes(base64.size() / 4 * 3, '\0');
  // OpenSSL uses unsigned char for bytes.
  const int size =
      EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                      reinterpret_cast<const unsigned char*>(base64.data()), static_cast<int>(base64.size()));
  if (size < 0) fail("the screenshot is not base64");
  // OpenSSL decodes the padding to zero bytes.
  const std::size_t padding = base64.size() - (base64.find_last_not_of('=') + 1);
  bytes.resize(static_cast<std::size_t>(size) - padding);
  return bytes;
}

std::string key_code(std::string_view key) {
  struct Key {
    std::string_view name;
    const char* code;
  };
  static constexpr std::array<Key, 11> kKeys{{{"ArrowLeft", "\uE012"},
                                              {"ArrowUp", "\uE013"},
                                              {"ArrowRight", "\uE014"},
                                              {"ArrowDown", "\uE015"},
                                              {"Home", "\uE011"},
                                              {"End", "\uE010"},
                                              {"PageUp", "\uE00E"},
                                              {"PageDown", "\uE00F"},
                                              {"Enter", "\uE007"},
                                              {"Escape", "\uE00C"},
                                              {"Tab", "\uE004"}}};
  for (const Key& named : kKeys) {
    if (named.name == key) return named.code;
  }
  return std::string(key);  // chromedriver rejects more than one character
}

}  // namespace

Browser::Browser(const Screen& screen)
    : chromium_(chromium(directory_)), chromedriver_(chromedriver(directory_)) {
  const int driver_port =
      wait_for_port(chromedriver_, "chromedriver", std::regex("started successfully on port ([0-9]+)\\."));
  const int browser_port = wait_for_port(chromium_, "chromium",
                                         std::regex("DevTools listening on ws://127\\.0\\.0\\.1:([0-9]+)/"));
  client_ = std::make_unique<httplib::Client>("127.0.0.1", driver_port);
  client_->set_keep_alive(true);
  client_->set_tcp_nodelay(true);
  client_->set_read_timeout(std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>(
      2.0 * kWaitTimeout)));  // so that chromedriver's timeout, whose message is better, comes first

  const json capabilities = {
      {"goog:chromeOptions", {{"debuggerAddress", "127.0.0.1:" + std::to_string(browser_port)}}},
      {"goog:loggingPrefs", {{"browser", "ALL"}}},
      {"timeouts", {{"pageLoad", kWaitTimeout * 1e3}, {"script", kWaitTimeout * 1e3}}}};
  const json session = command("/session", {{"capabilities", {{"alwaysMatch", capabilities}}}});
  session_ = "/session/" + session.at("sessionId").get<std::string>();
  resize(screen);
}

Browser::~Browser() {
  // Chromium terminates by itself if it can; its supervisor kills the rest. The members' destructors wait for
  // that, so that no process writes into the temporary directory while it is removed.
  chromium_.send_signal(SIGTERM);
  chromium_.wait(kWaitTimeout);
}

void Browser::resize(const Screen& screen) {
  screen_ = screen;
  // Not the window's size, which includes the frame and has a minimum width.
  development_tool("Emulation.setDeviceMetricsOverride", {{"width", screen.width},
                                                          {"height", screen.height},
                                                          {"deviceScaleFactor", 1},
                                                          {"mobile", screen.phone}});
  development_tool("Emulation.setTouchEmulationEnabled", {{"enabled", screen.phone}});
}

void Browser::open(const std::string& url) {
  console_errors();
  command("/url", {{"url", url}});
}

void Browser::open_file(const std::string& path) {
  std::string url = "file://";
  for (const char c : std::filesystem::absolute(path).string()) {
    switch (c) {
      case '%':
        url += "%25";
        break;
      case '#':
        url += "%23";
        break;
      case '?':
        url += "%3F";
        break;
      default:
        url += c;
    }
  }
  open(url);
}

json Browser::wait_until(const std::string& expression, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const std::string script =
      "let value, error;"
      "try { value = (" +
      expression +
      "); } catch (e) { error = String(e); }"
      "return {done: Boolean(value), value, error};";
  while (true) {
    json result = run(script);
    if (result.at("done") == true) return result.at("value");
    if (std::chrono::steady_clock::now() >= deadline) {
      std::ostringstream text;
      text << "waited " << seconds << " s for " << expression << "; it is ";
      if (result.at("error").is_null()) {
        text << result.at("value").dump();
      } else {
        text << "an exception: " << result.at("error").get<std::string>();
      }
      fail(text.str() + ". Errors on the console:" + format_console_errors());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

std::vector<std::string> Browser::console_errors() {
  std::vector<std::string> errors;
  for (const json& entry : command("/se/log", {{"type", "browser"}})) {
    if (entry.at("level") == "SEVERE") errors.push_back(entry.at("message").get<std::string>());
  }
  return errors;
}

void Browser::click(const std::string& selector) {
  command("/element/" + element(selector).begin().value().get<std::string>() + "/click", json::object());
}

void Browser::drag(const std::string& selector, int right, int down) {
  const json start = {{"type", "pointerMove"}, {"origin", element(selector)}, {"x", 0}, {"y", 0}};
  const json move = {
      {"type", "pointerMove"}, {"origin", "pointer"}, {"x", right}, {"y", down}, {"duration", 100}};
  act("pointer",
      {start, {{"type", "pointerDown"}, {"button", 0}}, move, {{"type", "pointerUp"}, {"button", 0}}});
}

void Browser::press(std::string_view key) {
  const std::string code = key_code(key);
  act("key", {{{"type", "keyDown"}, {"value", code}}, {{"type", "keyUp"}, {"value", code}}});
}

Image Browser::screenshot() {
  return Image(decode_base64(send(session_ + "/screenshot", "").get<std::string>()));
}

Region Browser::region_of(const std::string& selector) {
  const json box =
      run("const box = arguments[0].getBoundingClientRect();"
          "const clip = (value, limit) => Math.min(Math.max(Math.round(value), 0), limit);"
          "const left = clip(box.left, innerWidth), top = clip(box.top, innerHeight);"
          "return [left, top, clip(box.right, innerWidth) - left,"
          "        clip(box.bottom, innerHeight) - top];",
          element(selector));
  return {box.at(0), box.at(1), box.at(2), box.at(3)};
}

json Browser::execute(const std::string& script, const json& arguments) {
  return command("/execute/sync", {{"script", script}, {"args", arguments}});
}

json Browser::command(const std::string& path, const json& body) {
  return send(session_ + path, body.dump());
}

json Browser::send(const std::string& path, const std::string& body) {
  const httplib::Result result =
      body.empty() ? client_->Get(path) : client_->Post(path, body, "application/json");
  if (const std::optional<int> exit_code = chromium_.wait(0.0)) {
    fail("chromium has exited with " + std::to_string(*exit_code) + ": " + chromium_.standard_error());
  }
  if (!result) {
    fail("no response from chromedriver to " + path + ": " + httplib::to_string(result.error()) +
         "; output: " + chromedriver_.standard_output() + chromedriver_.standard_error());
  }
  json value = parse_json(result->body).at("value");
  if (result->status != 200) {
    // The lines after the first are chromedriver's stack trace.
    const std::string message = value.at("message").get<std::string>();
    fail(value.at("error").get<std::string>() + ": " + message.substr(0, message.find('\n')));
  }
  return value;
}

void Browser::development_tool(const std::string& method, const json& parameters) {
  command("/goog/cdp/execute", {{"cmd", method}, {"params", parameters}});
}

json Browser::element(const std::string& selector) {
  return command("/element", {{"using", "css selector"}, {"value", selector}});
}

void Browser::act(const std::string& type, const json& actions) {
  const json source = {{"type", type}, {"id", type}, {"actions", actions}};
  command("/actions", {{"actions", json::array({source})}});
}

std::string Browser::format_console_errors() {
  std::string lines;
  for (const std::string& error : console_errors()) lines += "\n  " + error;
  return lines.empty() ? " none" : lines;
}

}  // namespace buoyancy::view
