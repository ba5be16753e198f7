#include "importer/stl_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include <unistd.h>

#include "importer/reader_errors.h"

namespace buoyancy {
namespace {

constexpr std::uint64_t kHeaderBytes = 84;  // a text of 80 bytes and the number of triangles
constexpr std::uint64_t kTriangleBytes = 50;
constexpr std::size_t kNormalBytes = 12;  // before the three corners; two bytes of attributes follow them
constexpr std::uint64_t kTrianglesPerRead = 16'384;

bool read_at(const UniqueFd& file, std::uint64_t offset, void* to, std::size_t bytes) {
  auto* next = static_cast<std::byte*>(to);
  while (bytes > 0) {
    const ssize_t got = ::pread(file.value(), next, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    next += got;
    offset += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

std::optional<Expected<StoredMesh>> read_binary_stl(const ImportRequest& request, const OpenFile& open) {
  static_assert(std::endian::native == std::endian::little);
  const UniqueFd file = open(request.name);
  const off_t size = file.valid() ? ::lseek(file.value(), 0, SEEK_END) : -1;
  std::uint32_t count = 0;
  if (size < static_cast<off_t>(kHeaderBytes) ||
      !read_at(file, kHeaderBytes - sizeof(count), &count, sizeof(count))) {
    return std::nullopt;
  }
  const std::uint64_t bytes = kHeaderBytes + kTriangleBytes * count;
  if (count == 0 || static_cast<std::uint64_t>(size) != bytes ||
      bytes > std::numeric_limits<std::uint32_t>::max()) {
    return std::nullopt;
  }
  if (std::optional<Error> error = check_limits(std::uint64_t{3} * count, count, request.limits))
    return make_error(*std::move(error));

  StoredMesh stored;
  stored.source.format = to_string(request.format);
  stored.source.up_axis = "not stated";
  stored.source.nodes = 1;
  TriangleMesh& mesh = stored.mesh;
  for (std::vector<double>* const coordinates : {&mesh.x, &mesh.y, &mesh.z})
    coordinates->reserve(std::size_t{3} * count);
  mesh.triangles.reserve(count);
  std::vector<std::byte> part(kTrianglesPerRead * kTriangleBytes);
  for (std::uint64_t first = 0; first < count; first += kTrianglesPerRead) {
    const std::uint64_t here = std::min<std::uint64_t>(kTrianglesPerRead, count - first);
    if (!read_at(file, kHeaderBytes + kTriangleBytes * first, part.data(), kTriangleBytes * here))
      return std::nullopt;
    for (std::uint64_t t = 0; t < here; ++t) {
      std::array<std::array<float, 3>, 3> corners;
      std::memcpy(&corners, part.data() + t * kTriangleBytes + kNormalBytes, sizeof(corners));
      const auto v = static_cast<std::int32_t>(mesh.vertex_count());
      for (const std::array<float, 3>& corner : corners) {
        const Vec3 vertex(corner[0], corner[1], corner[2]);
        if (!vertex.allFinite()) return std::nullopt;
        mesh.add_vertex(vertex + Vec3::Zero());  // as a transform does: -0 becomes 0
      }
      mesh.triangles.push_back({v, v + 1, v + 2});
    }
  }
  return Expected<StoredMesh>(std::move(stored));
}

}  // namespace buoyancy
