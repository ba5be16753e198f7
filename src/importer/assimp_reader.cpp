#include "importer/assimp_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <assimp/BaseImporter.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <unistd.h>

#include "base/format.h"
#include "importer/reader_errors.h"

namespace buoyancy {
namespace {

// assimp stores node transforms in single precision; their product along the tree is computed in double.
using Transform = Eigen::Matrix<double, 3, 4>;

Transform to_transform(const aiMatrix4x4& m) {
  Transform transform;
  transform << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return transform;
}

Transform compose(const Transform& outer, const Transform& inner) {
  Transform product;
  product.leftCols<3>() = outer.leftCols<3>() * inner.leftCols<3>();
  product.col(3) = outer.leftCols<3>() * inner.col(3) + outer.col(3);
  return product;
}

class OpenedFile : public Assimp::IOStream {
 public:
  explicit OpenedFile(UniqueFd file) : file_(std::move(file)) {}

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    std::size_t done = 0;
    while (done < size * count) {
      const ssize_t got = ::pread(file_.value(), static_cast<std::byte*>(buffer) + done, size * count - done,
                                  static_cast<off_t>(offset_ + done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    offset_ += done;
    return size == 0 ? 0 : done / size;
  }
  std::size_t Write(const void* /*buffer*/, std::size_t /*size*/, std::size_t /*count*/) override {
    return 0;
  }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    if (origin == aiOrigin_CUR) offset += offset_;
    if (origin == aiOrigin_END) offset = FileSize() - offset;
    if (offset > FileSize()) return aiReturn_FAILURE;
    offset_ = offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return offset_; }
  std::size_t FileSize() const override {
    const off_t end = ::lseek(file_.value(), 0, SEEK_END);
    return end > 0 ? static_cast<std::size_t>(end) : 0;
  }
  void Flush() override {}

 private:
  UniqueFd file_;
  std::size_t offset_ = 0;
};

class OpenedFiles : public Assimp::IOSystem {
 public:
  explicit OpenedFiles(OpenFile open) : open_(std::move(open)) {}

  bool Exists(const char* name) const override { return open_(name).valid(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    UniqueFd file = *mode == 'r' ? open_(name) : UniqueFd();
    return file.valid() ? new OpenedFile(std::move(file)) : nullptr;
  }
  void Close(Assimp::IOStream* file) override { delete file; }

 private:
  OpenFile open_;
};

// assimp continues after errors that change the geometry (an index out of range, a polygon that it cannot
// split) and reports them only to its log.
struct LoggedErrors {
  std::string first;
  std::int64_t count = 0;
};

class ErrorLog : public Assimp::LogStream {
 public:
  explicit ErrorLog(LoggedErrors& errors) : errors_(errors) {}

  void write(const char* message) override {
    std::string text = message;  // "Error, T0: OFF: Vertex index is out of range\n"
    if (text.find("aterial") != std::string::npos) return;  // materials do not affect geometry
    if (++errors_.count > 1) return;
    if (const std::size_t colon = text.find(": "); colon != std::string::npos) text.erase(0, colon + 2);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    errors_.first = text;
  }

 private:
  LoggedErrors& errors_;
};

// Collects assimp's error messages during the lifetime of the object.
class ErrorLogging {
 public:
  ErrorLogging() {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new ErrorLog(errors_), Assimp::Logger::Err);
  }
  ~ErrorLogging() { Assimp::DefaultLogger::kill(); }
  ErrorLogging(const ErrorLogging&) = delete;
  ErrorLogging& operator=(const ErrorLogging&) = delete;

  const LoggedErrors& errors() const { return errors_; }

 private:
  LoggedErrors errors_;
};

// Unregisters all importers but those of `extension`, so that assimp cannot select another by content.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* candidate = importer.GetImporter(i);
    std::set<std::string> extensions;
    candidate->GetExtensionList(extensions);
    if (extensions.count(extension) > 0) continue;
    importer.UnregisterLoader(candidate);
    delete candidate;  // unregistering transfers ownership to the caller
  }
}

// Returns the root's transform without the rotation that assimp's 3DS importer adds: x, y, z to x, z, -y.
Transform root_transform(const aiScene& scene, MeshFormat format) {
  Transform root = to_transform(scene.mRootNode->mTransformation);
  if (format != MeshFormat::k3ds) return root;
  root.row(1).swap(root.row(2));
  root.row(1) *= -1.0;
  return root;
}

struct PlacedNode {
  const aiNode* node;
  Transform x_BN;  // from the node's frame N to the file's frame
};

// Returns every node with its transform, in the file's order. It does not recurse, since a file may nest
// nodes to any depth.
std::vector<PlacedNode> placed_nodes(const aiScene& scene, const Transform& root) {
  std::vector<PlacedNode> done;
  std::vector<PlacedNode> open{{scene.mRootNode, root}};
  while (!open.empty()) {
    const PlacedNode placed = open.back();
    open.pop_back();
    done.push_back(placed);
    for (unsigned int i = placed.node->mNumChildren; i-- > 0;) {
      const aiNode* child = placed.node->mChildren[i];
      open.push_back({child, compose(placed.x_BN, to_transform(child->mTransformation))});
    }
  }
  return done;
}

struct FaceCounts {
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;  // at least, after splitting
  std::uint64_t points_and_lines = 0;
};

FaceCounts count_faces(const aiMesh& mesh) {
  FaceCounts counts;
  for (unsigned int f = 0; f < mesh.mNumFaces; ++f) {
    const unsigned int corners = mesh.mFaces[f].mNumIndices;
    if (corners >= 3) {
      ++counts.faces;
      counts.triangles += corners - 2;
    }
    if (corners == 1 || corners == 2) ++counts.points_and_lines;
  }
  return counts;
}

// Appends the faces as triangles if all faces of the scene are triangles, else as polygons.
void append_instance(const aiMesh& part, const Transform& x_BN, bool as_triangles, StoredMesh& stored) {
  TriangleMesh& mesh = stored.mesh;
  const auto first = static_cast<std::int32_t>(mesh.vertex_count());
  for (unsigned int v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D& vertex = part.mVertices[v];
    const Vec3 vertex_N(vertex.x, vertex.y, vertex.z);
    mesh.add_vertex(x_BN.leftCols<3>() * vertex_N + x_BN.col(3));
  }
  const bool mirrored = x_BN.leftCols<3>().determinant() < 0.0;
  std::vector<std::int32_t> corners;
  for (unsigned int f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3) continue;
    if (as_triangles) {
      const auto corner = [&](int i) { return first + static_cast<std::int32_t>(face.mIndices[i]); };
      mesh.triangles.push_back({corner(0), corner(mirrored ? 2 : 1), corner(mirrored ? 1 : 2)});
      continue;
    }
    corners.clear();
    for (unsigned int corner = 0; corner < face.mNumIndices; ++corner) {
      corners.push_back(first + static_cast<std::int32_t>(face.mIndices[corner]));
    }
    if (mirrored) std::reverse(corners.begin() + 1, corners.end());
    stored.polygons.add(corners);
  }
}

// Meshes that no node refers to are not part of the scene and are left out.
Expected<StoredMesh> flatten(const aiScene& scene, const ImportRequest& request) {
  std::vector<FaceCounts> counts;
  for (unsigned int m = 0; m < scene.mNumMeshes; ++m) counts.push_back(count_faces(*scene.mMeshes[m]));

  StoredMesh stored;
  const std::vector<PlacedNode> nodes = placed_nodes(scene, root_transform(scene, request.format));
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint64_t triangles = 0;
  for (const PlacedNode& placed : nodes) {
    std::uint64_t triangles_here = 0;
    for (unsigned int i = 0; i < placed.node->mNumMeshes; ++i) {
      const unsigned int m = placed.node->mMeshes[i];
      faces += counts[m].faces;
      triangles_here += counts[m].triangles;
      vertices += counts[m].triangles > 0 ? scene.mMeshes[m]->mNumVertices : 0;
      stored.source.ignored_primitives += static_cast<std::int64_t>(counts[m].points_and_lines);
    }
    triangles += triangles_here;
    if (triangles_here > 0) ++stored.source.nodes;
  }
  if (std::optional<Error> error = check_limits(vertices, triangles, request.limits))
    return make_error(*std::move(error));

  stored.mesh.x.reserve(vertices);
  stored.mesh.y.reserve(vertices);
  stored.mesh.z.reserve(vertices);
  const bool as_triangles = faces == triangles;
  if (as_triangles) {
    stored.mesh.triangles.reserve(triangles);
  } else {
    stored.polygons.corners.reserve(triangles + 2 * faces);
    stored.polygons.ends.reserve(faces);
  }
  for (const PlacedNode& placed : nodes) {
    for (unsigned int i = 0; i < placed.node->mNumMeshes; ++i) {
      const unsigned int m = placed.node->mMeshes[i];
      if (counts[m].triangles > 0) append_instance(*scene.mMeshes[m], placed.x_BN, as_triangles, stored);
    }
  }
  return stored;
}

// Values of single precision have six significant digits: 0.01, not 0.009999999776.
std::string six_digits(double value) {
  return format_number(value, 6);
}

void add_note(MeshSource& source, const std::string& text) {
  if (!source.note.empty()) source.note += "; ";
  source.note += text;
}

// assimp stores the unit of a Collada or 3DS file in the root node's transform.
double root_scale(const aiScene& scene) {
  return to_transform(scene.mRootNode->mTransformation).col(0).norm();
}

// Returns "z", "x", "y" or "" (not stated).
std::string collada_up_axis(UniqueFd file) {
  std::string head(65'536, '\0');  // <asset> is a Collada file's first element
  OpenedFile(std::move(file)).Read(head.data(), 1, head.size());
  constexpr std::string_view kTag = "up_axis>";
  const std::size_t tag = head.find(kTag);
  if (tag == std::string::npos) return "";
  const std::size_t value = head.find_first_not_of(" \t\r\n", tag + kTag.size());
  if (value == std::string::npos) return "";
  if (head.compare(value, 4, "X_UP") == 0) return "x";
  if (head.compare(value, 4, "Y_UP") == 0) return "y";
  return head.compare(value, 4, "Z_UP") == 0 ? "z" : "";
}

std::string fbx_up_axis(const aiScene& scene) {
  int axis = -1;
  int sign = 1;
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UpAxis", axis) || axis < 0 || axis > 2) return "";
  const std::string name(1, static_cast<char>('x' + axis));
  return scene.mMetaData->Get("UpAxisSign", sign) && sign < 0 ? "-" + name : name;
}

std::string up_axis_of(const aiScene& scene, const ImportRequest& request, const OpenFile& open) {
  const MeshFormat format = request.format;
  std::string axis;
  if (format == MeshFormat::kGltf) return "y";  // by its specification
  if (format == MeshFormat::kCollada) axis = collada_up_axis(open(request.name));
  if (format == MeshFormat::kFbx) axis = fbx_up_axis(scene);
  return axis.empty() ? "not stated" : axis;
}

void note_collada(const aiScene& scene, MeshSource& source) {
  const double scale = root_scale(scene);
  if (scale != 1.0) add_note(source, "scaled by " + six_digits(scale) + " to metres by the importer");
}

void note_3ds(const aiScene& scene, MeshSource& source) {
  const double scale = root_scale(scene);
  if (std::abs(scale - 1.0) > 1e-6) {
    add_note(source, "scaled by " + six_digits(scale) + ", the file's master scale, by the importer");
  }
}

void note_fbx(const aiScene& scene, MeshSource& source) {
  float centimetres = 0.0F;
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UnitScaleFactor", centimetres)) return;
  if (!(centimetres > 0.0F) || centimetres == 100.0F) return;
  add_note(source, "not scaled by the importer; by the file one unit is " + six_digits(centimetres) +
                       " cm, so that scale = " + six_digits(centimetres / 100.0) + " makes metres of it");
}

void describe(const aiScene& scene, const ImportRequest& request, const OpenFile& open,
              const LoggedErrors& logged, MeshSource& source) {
  const MeshFormat format = request.format;
  source.format = to_string(format);
  source.up_axis = up_axis_of(scene, request, open);
  if (format == MeshFormat::kCollada) note_collada(scene, source);
  if (format == MeshFormat::k3ds) note_3ds(scene, source);
  if (format == MeshFormat::kFbx) note_fbx(scene, source);
  if (logged.count > 0) {
    add_note(source, "the importer reported " + std::to_string(logged.count) +
                         (logged.count == 1 ? " error: " : " errors, the first: ") + logged.first);
  }
}

// Returns whether assimp's message means that there is no mesh, rather than that the file is unreadable.
bool reports_empty_file(const std::string& message) {
  constexpr std::array kEmptyFilePhrases{"too small",         "contains no vertices", "There are no facets",
                                         "no valid vertices", "came out empty",       "mNumMeshes is 0",
                                         "No scene"};
  return std::ranges::any_of(kEmptyFilePhrases, [&message](const char* phrase) {
    return message.find(phrase) != std::string::npos;
  });
}

Error no_mesh(MeshFormat format, const std::string& message) {
  return {"", "no mesh in it (" + message + ")",
          "a " + std::string(to_string(format)) + " file of triangles or polygons",
          "an empty export, a header alone, or content of another format", "Export the surface as polygons"};
}

}  // namespace

Expected<StoredMesh> read_with_assimp(const ImportRequest& request, const OpenFile& open) {
  const MeshFormat format = request.format;
  const ErrorLogging logging;
  Assimp::Importer importer;
  importer.SetIOHandler(new OpenedFiles(open));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  keep_only(importer, lowercase_extension(request.name).substr(1));
  // assimp's post-processing steps edit geometry: they delete small triangles, move vertices, and drop
  // triangles of polygons with collinear corners. Validation does not.
  const aiScene* scene = importer.ReadFile(request.name, aiProcess_ValidateDataStructure);
  if (scene == nullptr) {
    if (const std::exception_ptr& exception = importer.GetException()) {
      try {
        std::rethrow_exception(exception);
      } catch (const std::bad_alloc&) {
        throw;
      } catch (...) {  // NOLINT(bugprone-empty-catch): GetErrorString() returns its text
      }
    }
    std::string message = importer.GetErrorString();
    if (message.empty()) message = logging.errors().first;
    if (message.find("contains no faces") != std::string::npos) return make_error(no_triangles(0));
    return make_error(reports_empty_file(message) ? no_mesh(format, message) : unreadable(format, message));
  }
  // The OFF importer reports success even if it drops a face, invents a vertex or clamps an index; only its
  // log shows that.
  if (format == MeshFormat::kOff && logging.errors().count > 0) {
    return make_error(unreadable(format, logging.errors().first));
  }
  if (scene->mRootNode == nullptr) return make_error(unreadable(format, "no scene in it"));

  Expected<StoredMesh> stored = flatten(*scene, request);
  if (stored && stored->source.nodes == 0) return make_error(no_triangles(stored->source.ignored_primitives));
  if (stored) describe(*scene, request, open, logging.errors(), stored->source);
  return stored;
}

}  // namespace buoyancy
