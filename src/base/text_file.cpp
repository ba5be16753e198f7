#include "base/text_file.h"

#include <fstream>
#include <sstream>
#include <system_error>

namespace buoyancy {

Expected<std::string> read_text_file(const std::filesystem::path& path, const std::string& what,
                                     std::uintmax_t max_bytes) {
  const std::string name = path.string();
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) {
    return make_error({name, "no such file", what, {}, "Check the path"});
  }
  if (!std::filesystem::is_regular_file(status)) {
    const bool directory = std::filesystem::is_directory(status);
    return make_error({name, directory ? "is a directory" : "is not a regular file", what, {}, {}});
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path, code);
  if (!code && bytes > max_bytes) {
    return make_error({name,
                       std::to_string(bytes) + " bytes",
                       what + " of at most " + std::to_string(max_bytes) + " bytes",
                       "this is not " + what,
                       {}});
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (!file) {
    return make_error({name, "cannot be read", what, "no permission to read it", {}});
  }
  return text.str();
}

}  // namespace buoyancy
