#include "geometry/import_pipe.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <poll.h>
#include <unistd.h>

namespace buoyancy {
namespace {

// Writer and reader are the same program after fork(), so the format needs no byte order and no version.
struct Header {
  std::int64_t is_mesh = 0;
  std::array<std::uint64_t, 4> text_bytes{};  // sizes of the texts: four for an Error, three for a mesh
  std::int64_t nodes = 0;
  std::int64_t ignored_primitives = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};
static_assert(std::is_trivially_copyable_v<Header>);

constexpr std::uint64_t kMaxTextBytes = 4096;

bool send_bytes(int pipe, const void* data, std::size_t bytes) {
  const auto* next = static_cast<const std::byte*>(data);
  while (bytes > 0) {
    const ssize_t sent = ::write(pipe, next, bytes);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    next += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

template <typename T>
bool send_array(int pipe, const std::vector<T>& values) {
  return send_bytes(pipe, values.data(), values.size() * sizeof(T));
}

class PipeReader {
 public:
  PipeReader(int pipe, ImportDeadline deadline) : pipe_(pipe), deadline_(deadline) {}

  bool read(void* data, std::size_t bytes) {
    auto* next = static_cast<std::byte*>(data);
    while (bytes > 0) {
      if (!wait()) return false;
      const ssize_t received = ::read(pipe_, next, bytes);
      if (received < 0 && errno == EINTR) continue;
      if (received <= 0) return false;
      next += received;
      bytes -= static_cast<std::size_t>(received);
    }
    return true;
  }

  // Grows with the bytes that arrive: a false count costs address space, not memory.
  template <typename T>
  bool read_array(std::vector<T>& values, std::uint64_t count) {
    constexpr std::uint64_t kChunk = 65'536;
    values.reserve(count);
    while (values.size() < count) {
      const std::size_t have = values.size();
      const std::size_t more = std::min(kChunk, count - have);
      values.resize(have + more);
      if (!read(values.data() + have, more * sizeof(T))) return false;
    }
    return true;
  }

  bool read_text(std::string& text, std::uint64_t bytes) {
    if (bytes > kMaxTextBytes) return false;
    text.resize(bytes);
    if (!read(text.data(), text.size())) return false;
    for (char& c : text) {
      if (c < ' ' || c > '~') c = '?';  // importers quote bytes of the file
    }
    return true;
  }

  ImportFailure failure() const { return timed_out_ ? ImportFailure::kTimedOut : ImportFailure::kBroken; }

 private:
  bool wait() {
    using std::chrono::milliseconds;
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(deadline_ - ImportDeadline::clock::now());
      if (left <= milliseconds(0)) {
        timed_out_ = true;
        return false;
      }
      pollfd descriptor{pipe_, POLLIN, 0};
      const int ready =
          ::poll(&descriptor, 1, static_cast<int>(std::min(left, milliseconds(60'000)).count()));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
  }

  int pipe_;
  ImportDeadline deadline_;
  bool timed_out_ = false;
};

bool indices_in_range(const TriangleMesh& mesh) {
  const auto vertices = static_cast<std::int64_t>(mesh.vertex_count());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [vertices](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [vertices](std::int32_t i) { return i >= 0 && i < vertices; });
  });
}

}  // namespace

bool send_import(int pipe, const Expected<ImportedMesh>& result) {
  std::array<std::string, 4> texts;
  Header header;
  if (result) {
    texts = {result->source.format, result->source.up_axis, result->source.note, ""};
    header.is_mesh = 1;
    header.nodes = result->source.nodes;
    header.ignored_primitives = result->source.ignored_primitives;
    header.vertices = result->mesh.vertex_count();
    header.triangles = result->mesh.triangles.size();
  } else {
    texts = {result.error().actual, result.error().expected, result.error().cause, result.error().hint};
  }
  for (std::size_t i = 0; i < texts.size(); ++i) {
    texts[i].resize(std::min<std::size_t>(texts[i].size(), kMaxTextBytes));
    header.text_bytes[i] = texts[i].size();
  }
  if (!send_bytes(pipe, &header, sizeof(header))) return false;
  for (const std::string& text : texts) {
    if (!send_bytes(pipe, text.data(), text.size())) return false;
  }
  if (!result) return true;
  const TriangleMesh& mesh = result->mesh;
  return send_array(pipe, mesh.x) && send_array(pipe, mesh.y) && send_array(pipe, mesh.z) &&
         send_array(pipe, mesh.triangles);
}

std::variant<ImportFailure, Expected<ImportedMesh>> receive_import(int pipe, const ImportLimits& limits,
                                                                   ImportDeadline deadline) {
  PipeReader reader(pipe, deadline);
  Header header;
  if (!reader.read(&header, sizeof(header))) return reader.failure();
  std::array<std::string, 4> texts;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!reader.read_text(texts[i], header.text_bytes[i])) return reader.failure();
  }
  if (header.is_mesh != 1) return make_error({"", texts[0], texts[1], texts[2], texts[3]});
  if (header.vertices > limits.vertices || header.triangles > limits.faces || header.triangles == 0 ||
      header.nodes < 0 || header.ignored_primitives < 0) {
    return ImportFailure::kBroken;
  }
  ImportedMesh imported;
  imported.source = {texts[0], texts[1], texts[2], header.nodes, header.ignored_primitives};
  TriangleMesh& mesh = imported.mesh;
  if (!reader.read_array(mesh.x, header.vertices) || !reader.read_array(mesh.y, header.vertices) ||
      !reader.read_array(mesh.z, header.vertices) || !reader.read_array(mesh.triangles, header.triangles)) {
    return reader.failure();
  }
  return indices_in_range(mesh) ? std::variant<ImportFailure, Expected<ImportedMesh>>(std::move(imported))
                                : ImportFailure::kBroken;
}

}  // namespace buoyancy
