#include "view/page/page_assets.h"

#include <array>
#include <fstream>
#include <iterator>

#include "view/page_files.h"

namespace buoyancy::view {
namespace {

constexpr std::string_view kInsert = "<!-- insert ";
constexpr std::string_view kInsertEnd = " -->";

std::string element(std::string_view tag, std::string_view text) {
  std::string html = "<";
  html += tag;
  html += ">\n";
  html += text;
  html += "\n</";
  html += tag;
  html += ">";
  return html;
}

std::string insertion(std::string_view name, std::string_view three, bool subdivision) {
  if (name == "three.js") return element("script", three);
  return element(name.ends_with(".css") ? "style" : "script", page_text(name, subdivision));
}

std::string without_lines_of(std::string_view comment, std::string_view text) {
  std::string kept;
  kept.reserve(text.size());
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end == std::string_view::npos ? end : end + 1);
    if (line.find(comment) == std::string_view::npos) kept += line;
    text.remove_prefix(line.size());
  }
  return kept;
}

}  // namespace

std::string page_text(std::string_view file_name, bool subdivision) {
  for (const PageFile& file : kPageFiles) {
    if (file.name != file_name) continue;
    return subdivision ? std::string(file.text) : without_lines_of("only with subdivision", file.text);
  }
  return {};
}

Expected<std::string> three_js(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_directory = std::filesystem::is_directory(path, ignored);  // reading one would throw
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (!is_directory) text.assign(std::istreambuf_iterator<char>(file), {});
  const std::string subject = path.string();
  if (is_directory || !file.is_open() || file.bad()) {
    return make_error({subject, "cannot be read", "three.js as Debian installs it", "it is not installed",
                       "apt-get install libjs-three, or --three FILE"});
  }
  if (text.find("WebGLRenderer") == std::string::npos || text.find("</script") != std::string::npos) {
    return make_error({subject, "cannot be embedded in a page",
                       "three.js as a classic script (three.min.js) that defines THREE",
                       "a different file or a module build of three.js",
                       "--three /usr/share/javascript/three/three.min.js"});
  }
  return text;
}

std::string self_contained_page(std::string_view file_name, std::string_view three, bool subdivision) {
  std::string page;
  const std::string text = page_text(file_name, subdivision);
  std::string_view rest = text;
  while (true) {
    const std::size_t start = rest.find(kInsert);
    const std::size_t end = rest.find(kInsertEnd, start);
    page += rest.substr(0, start);
    if (start == std::string_view::npos) return page;
    page += insertion(rest.substr(start + kInsert.size(), end - start - kInsert.size()), three, subdivision);
    rest.remove_prefix(end + kInsertEnd.size());
  }
}

std::string escaped_for_script(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

void insert_data(std::string& page, std::string_view json) {
  constexpr std::string_view kData = "<!-- data -->";
  page.replace(page.find(kData), kData.size(),
               R"(<script type="application/json" id="data">)" + escaped_for_script(json) + "</script>");
}

}  // namespace buoyancy::view
