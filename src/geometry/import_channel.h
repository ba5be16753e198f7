// Internal to mesh import: the protocol of this process and the importer on a pair of connected sockets. This
// process sends one request; the importer asks for the files that it needs, gets a descriptor for each, and
// sends the mesh or an error.
//
// The file being read may corrupt the importer, so this process trusts nothing: it checks counts against the
// limits before it reserves memory, bounds texts and makes them printable, touches memory only for bytes that
// have arrived, and checks that vertex indices are in range and that polygons have three corners or more. The
// caller checks the coordinates.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "base/unique_fd.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

using ImportDeadline = std::chrono::steady_clock::time_point;

// Both sides are of the same architecture but perhaps of different releases: the importer ends with
// kOtherProtocolExit if its first argument is not this number. Raise it with every change of the format.
inline constexpr const char* kImportProtocol = "2";

// The importer's descriptor of its socket.
inline constexpr int kImporterSocket = 3;

// Exit statuses of the importer, apart from EXIT_SUCCESS and EXIT_FAILURE.
inline constexpr int kOutOfMemoryExit = 71;
inline constexpr int kOtherProtocolExit = 72;

// Returns a descriptor of a regular file, by its name relative to the mesh's folder; not valid: it may not be
// read. Two descriptors of one file may share their offset.
using OpenFile = std::function<UniqueFd(const std::string&)>;

// A mesh as its file stores it. If all its faces are triangles, they are those of `mesh`; otherwise `mesh`
// has vertices only, and all faces are polygons.
struct StoredMesh {
  TriangleMesh mesh;
  Polygons polygons;
  MeshSource source;
};

struct ImportRequest {
  std::string name;  // of the mesh file, in its folder
  MeshFormat format = MeshFormat::kObj;
  ImportLimits limits;
};

// The importer calls these functions. Each returns false, nullopt or no descriptor if the other side has
// closed its socket; request_file() returns no descriptor for a file that may not be read, too.
std::optional<ImportRequest> receive_request(int socket);
UniqueFd request_file(int socket, std::string_view name);
bool send_import(int socket, const Expected<StoredMesh>& result);

enum class ImportFailure {
  kTimedOut,  // the deadline passed
  kBroken,    // the importer ended early, or its bytes are neither a valid mesh nor an error
};

// Returns the text with every byte that is no printable ASCII character replaced by '?'.
std::string printable_ascii(std::string text);

// The process that imports calls these functions. send_request() does not block: the socket is empty.
bool send_request(int socket, const ImportRequest& request);
// Opens files for the importer and waits for the complete result until the deadline. Throws std::bad_alloc
// when this process is out of memory.
std::variant<ImportFailure, Expected<StoredMesh>> receive_import(int socket, const ImportLimits& limits,
                                                                 ImportDeadline deadline,
                                                                 const OpenFile& open);

}  // namespace buoyancy
