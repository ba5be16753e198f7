#include "base/text_file.h"

#include <cerrno>
#include <cstdio>
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

Expected<void> write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  const bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;  // closing may set another
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (written && closed) return {};
  return make_error({path.string(), std::generic_category().message(written ? errno : write_error),
                     "a file that can be written", "", ""});
}

}  // namespace buoyancy
