#include "geometry/import_channel.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace buoyancy {
namespace {

enum class Kind : std::int64_t { kError, kMesh, kFile };

// Every message of the importer begins with this header. A kFile message has one text, the file's name.
struct Header {
  Kind kind = Kind::kError;
  std::array<std::uint64_t, 4> text_bytes{};  // sizes of the texts: four for an Error, three for a mesh
  std::int64_t nodes = 0;
  std::int64_t ignored_primitives = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t polygons = 0;  // if this is above 0, there are no triangles
  std::uint64_t corners = 0;   // of all polygons
};
static_assert(std::is_trivially_copyable_v<Header>);

struct RequestHeader {
  std::uint64_t name_bytes = 0;
  MeshFormat format = MeshFormat::kObj;
  ImportLimits limits;
};
static_assert(std::is_trivially_copyable_v<RequestHeader>);

constexpr std::uint64_t kMaxTextBytes = 4096;  // the length of a path, too

bool send_bytes(int socket, const void* data, std::size_t bytes) {
  const auto* next = static_cast<const std::byte*>(data);
  while (bytes > 0) {
    const ssize_t sent = ::send(socket, next, bytes, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    next += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_bytes(int socket, void* data, std::size_t bytes) {
  auto* next = static_cast<std::byte*>(data);
  while (bytes > 0) {
    const ssize_t received = ::recv(socket, next, bytes, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    next += received;
    bytes -= static_cast<std::size_t>(received);
  }
  return true;
}

// One byte and perhaps a descriptor: the response to a request for a file.
struct FileResponse {
  FileResponse() {
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
  }

  char byte = 0;
  iovec content{&byte, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
};

bool send_file(int socket, const UniqueFd& file) {
  FileResponse response;
  if (file.valid()) {
    cmsghdr* header = CMSG_FIRSTHDR(&response.message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    const int descriptor = file.value();
    std::memcpy(CMSG_DATA(header), &descriptor, sizeof(descriptor));
  } else {
    response.message.msg_controllen = 0;
  }
  // MSG_DONTWAIT: an importer that asks without reading the responses must not block this process.
  while (::sendmsg(socket, &response.message, MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

template <typename T>
bool send_array(int socket, const std::vector<T>& values) {
  return send_bytes(socket, values.data(), values.size() * sizeof(T));
}

class Reader {
 public:
  Reader(int socket, ImportDeadline deadline) : socket_(socket), deadline_(deadline) {}

  bool read(void* data, std::size_t bytes) {
    auto* next = static_cast<std::byte*>(data);
    while (bytes > 0) {
      if (!wait()) return false;
      const ssize_t received = ::recv(socket_, next, bytes, MSG_DONTWAIT);
      if (received < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (received <= 0) return false;
      next += received;
      bytes -= static_cast<std::size_t>(received);
    }
    return true;
  }

  // The vector grows with the bytes that arrive: a false count costs address space, not memory.
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
    return read(text.data(), text.size());
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
      pollfd descriptor{socket_, POLLIN, 0};
      const int ready =
          ::poll(&descriptor, 1, static_cast<int>(std::min(left, milliseconds(60'000)).count()));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
  }

  int socket_;
  ImportDeadline deadline_;
  bool timed_out_ = false;
};

// A polygon of n corners becomes n - 2 triangles or more.
bool counts_in_range(const Header& header, const ImportLimits& limits) {
  const bool are_triangles =
      header.polygons == 0 && header.corners == 0 && header.triangles > 0 && header.triangles <= limits.faces;
  const bool are_polygons = header.polygons > 0 && header.triangles == 0 &&
                            header.polygons <= header.corners / 3 &&
                            header.corners - 2 * header.polygons <= limits.faces;
  return header.vertices <= limits.vertices && (are_triangles || are_polygons) && header.nodes >= 0 &&
         header.ignored_primitives >= 0;
}

bool are_valid_ends(const Polygons& polygons) {
  std::int64_t previous = 0;
  for (const std::int64_t end : polygons.ends) {
    if (end < previous || end - previous < 3) return false;
    previous = end;
  }
  return previous == static_cast<std::int64_t>(polygons.corners.size());
}

bool is_valid(const StoredMesh& stored) {
  const auto vertices = static_cast<std::int64_t>(stored.mesh.vertex_count());
  const auto in_range = [vertices](std::int32_t i) { return i >= 0 && i < vertices; };
  return std::ranges::all_of(
             stored.mesh.triangles,
             [&](const Triangle& triangle) { return std::ranges::all_of(triangle, in_range); }) &&
         std::ranges::all_of(stored.polygons.corners, in_range) && are_valid_ends(stored.polygons);
}

}  // namespace

std::string printable_ascii(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::optional<ImportRequest> receive_request(int socket) {
  RequestHeader header;
  if (!receive_bytes(socket, &header, sizeof(header)) || header.name_bytes > kMaxTextBytes) {
    return std::nullopt;
  }
  ImportRequest request{std::string(header.name_bytes, '\0'), header.format, header.limits};
  if (!receive_bytes(socket, request.name.data(), request.name.size())) return std::nullopt;
  return request;
}

UniqueFd request_file(int socket, std::string_view name) {
  if (name.size() > kMaxTextBytes || name.find('\0') != std::string_view::npos) return {};
  Header header;
  header.kind = Kind::kFile;
  header.text_bytes[0] = name.size();
  if (!send_bytes(socket, &header, sizeof(header)) || !send_bytes(socket, name.data(), name.size())) {
    return {};
  }
  FileResponse response;
  ssize_t received = -1;
  while ((received = ::recvmsg(socket, &response.message, MSG_CMSG_CLOEXEC)) < 0 && errno == EINTR) {
  }
  const cmsghdr* control = received == 1 ? CMSG_FIRSTHDR(&response.message) : nullptr;
  if (control == nullptr || control->cmsg_type != SCM_RIGHTS) return {};
  int descriptor = -1;
  std::memcpy(&descriptor, CMSG_DATA(control), sizeof(descriptor));
  return UniqueFd(descriptor);
}

bool send_import(int socket, const Expected<StoredMesh>& result) {
  std::array<std::string, 4> texts;
  Header header;
  if (result) {
    texts = {result->source.format, result->source.up_axis, result->source.note, ""};
    header.kind = Kind::kMesh;
    header.nodes = result->source.nodes;
    header.ignored_primitives = result->source.ignored_primitives;
    header.vertices = result->mesh.vertex_count();
    header.triangles = result->mesh.triangles.size();
    header.polygons = result->polygons.size();
    header.corners = result->polygons.corners.size();
  } else {
    texts = {result.error().actual, result.error().expected, result.error().cause, result.error().hint};
  }
  for (std::size_t i = 0; i < texts.size(); ++i) {
    texts[i].resize(std::min<std::size_t>(texts[i].size(), kMaxTextBytes));
    header.text_bytes[i] = texts[i].size();
  }
  if (!send_bytes(socket, &header, sizeof(header))) return false;
  for (const std::string& text : texts) {
    if (!send_bytes(socket, text.data(), text.size())) return false;
  }
  if (!result) return true;
  const TriangleMesh& mesh = result->mesh;
  return send_array(socket, mesh.x) && send_array(socket, mesh.y) && send_array(socket, mesh.z) &&
         send_array(socket, mesh.triangles) && send_array(socket, result->polygons.corners) &&
         send_array(socket, result->polygons.ends);
}

bool send_request(int socket, const ImportRequest& request) {
  const RequestHeader header{request.name.size(), request.format, request.limits};
  return send_bytes(socket, &header, sizeof(header)) &&
         send_bytes(socket, request.name.data(), request.name.size());
}

std::variant<ImportFailure, Expected<StoredMesh>> receive_import(int socket, const ImportLimits& limits,
                                                                 ImportDeadline deadline,
                                                                 const OpenFile& open) {
  Reader reader(socket, deadline);
  Header header;
  std::array<std::string, 4> texts;
  while (true) {
    if (!reader.read(&header, sizeof(header))) return reader.failure();
    for (std::size_t i = 0; i < texts.size(); ++i) {
      if (!reader.read_text(texts[i], header.text_bytes[i])) return reader.failure();
    }
    if (header.kind != Kind::kFile) break;
    if (!send_file(socket, open(texts[0]))) return ImportFailure::kBroken;
  }
  for (std::string& text : texts)
    text = printable_ascii(std::move(text));  // importers quote bytes of the file
  if (header.kind != Kind::kMesh) return make_error({"", texts[0], texts[1], texts[2], texts[3]});
  if (!counts_in_range(header, limits)) return ImportFailure::kBroken;
  StoredMesh stored;
  stored.source = {texts[0], texts[1], texts[2], header.nodes, header.ignored_primitives};
  TriangleMesh& mesh = stored.mesh;
  if (!reader.read_array(mesh.x, header.vertices) || !reader.read_array(mesh.y, header.vertices) ||
      !reader.read_array(mesh.z, header.vertices) || !reader.read_array(mesh.triangles, header.triangles) ||
      !reader.read_array(stored.polygons.corners, header.corners) ||
      !reader.read_array(stored.polygons.ends, header.polygons)) {
    return reader.failure();
  }
  return is_valid(stored) ? std::variant<ImportFailure, Expected<StoredMesh>>(std::move(stored))
                          : ImportFailure::kBroken;
}

}  // namespace buoyancy
