// buoyancy-import-mesh reads one mesh file for the program that started it (geometry/import_process.h). It
// does so in a sandbox (cage.h), since files exist that crash importers or make them do what the file says.
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>

#include <sys/socket.h>
#include <unistd.h>

#include "base/standard_descriptors.h"
#include "geometry/import_channel.h"
#include "importer/assimp_reader.h"
#include "importer/cage.h"
#include "importer/panel_reader.h"
#include "importer/stl_reader.h"

namespace buoyancy {
namespace {

// The kernel sends no signal for a parent that died before PR_SET_PDEATHSIG; its socket is closed then.
bool parent_is_gone() {
  char byte = 0;
  return ::recv(kImporterSocket, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

Expected<StoredMesh> read(const ImportRequest& request, const OpenFile& open) {
  if (is_panel_format(request.format)) return read_panels(request, open);
  if (request.format == MeshFormat::kStl) {
    if (std::optional<Expected<StoredMesh>> stored = read_binary_stl(request, open))
      return *std::move(stored);
  }
  return read_with_assimp(request, open);
}

int run() {
  const std::optional<ImportRequest> request = receive_request(kImporterSocket);
  if (!request) return EXIT_FAILURE;
  enter_cage(request->limits);
  if (parent_is_gone()) return EXIT_FAILURE;
  const auto open = [](const std::string& name) { return request_file(kImporterSocket, name); };
  std::set_new_handler([] { ::_exit(kOutOfMemoryExit); });
  try {
    return send_import(kImporterSocket, read(*request, open)) ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::bad_alloc&) {
    return kOutOfMemoryExit;
  } catch (...) {
    return EXIT_FAILURE;
  }
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  buoyancy::open_standard_descriptors();
  const bool same_protocol = argc == 2 && std::strcmp(argv[1], buoyancy::kImportProtocol) == 0;
  ::_exit(same_protocol ? buoyancy::run() : buoyancy::kOtherProtocolExit);
}
