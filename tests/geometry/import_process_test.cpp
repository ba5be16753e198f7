#include "geometry/import_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "geometry/mesh_import.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/shared_mesh_files.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;
#elif defined(__has_feature)
constexpr bool kShadowMemory = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kShadowMemory = false;
#endif

// assimp splits a polygon of n corners in about n^2 steps: minutes for these. A file that hangs, in effect.
std::string endless_obj() {
  constexpr int kCorners = 32'000;
  std::ostringstream text;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * M_PI * i / kCorners;
    text << "v " << std::cos(angle) << " " << std::sin(angle) << " 0\n";
  }
  for (int face = 0; face < 100; ++face) {
    text << "f";
    for (int i = 1; i <= kCorners; ++i) text << " " << i;
    text << "\n";
  }
  return text.str();
}

// A property of an unknown type shifts all that follows: assimp 5.2.5 ends in abort(), over a broken
// assumption.
std::string crashing_ply() {
  std::string content = tetrahedron::binary_ply();
  content.replace(content.find("float y"), 7, "floa y");
  return content;
}

// One line that names the file, what was found and what was expected, in printable characters.
void expect_clear(const Error& error, const fs::path& file) {
  const std::string message = error.message();
  EXPECT_EQ(error.subject, file.string());
  EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0U) << message;
  EXPECT_FALSE(error.found.empty()) << message;
  EXPECT_FALSE(error.expectation.empty()) << message;
  for (const char c : error.found + error.expectation + error.cause + error.remedy) {
    EXPECT_TRUE(c >= ' ' && c <= '~') << message;
  }
}

// The error's message; a failure of the test if there is a mesh.
std::string refusal(const fs::path& file, const ImportLimits& limits = {}) {
  const Expected<ImportedMesh> result = import_mesh(file, limits);
  if (result) {
    ADD_FAILURE() << file << " gave " << result->mesh.triangles.size() << " triangles";
    return "";
  }
  expect_clear(result.error(), file);
  return result.error().message();
}

void expect_usable_or_clear(const fs::path& file, const ImportLimits& limits) {
  const Expected<ImportedMesh> result = import_mesh(file, limits);
  if (!result) return expect_clear(result.error(), file);
  EXPECT_FALSE(result->mesh.triangles.empty()) << file;
  const auto vertices = static_cast<std::int32_t>(result->mesh.vertex_count());
  for (const Triangle& triangle : result->mesh.triangles) {
    for (const std::int32_t i : triangle) ASSERT_TRUE(i >= 0 && i < vertices) << file;
  }
}

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no '" << part << "' in: " << text;
}

std::size_t open_descriptors() {
  const fs::directory_iterator descriptors("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(descriptors), end(descriptors)));
}

class MeshImportRefusal : public testing::Test {
 protected:
  ~MeshImportRefusal() override {
    EXPECT_EQ(open_descriptors(), descriptors_before_);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was left behind";
    EXPECT_EQ(errno, ECHILD);
  }

  TemporaryDirectory directory_;

 private:
  std::size_t descriptors_before_ = open_descriptors();
};

TEST_F(MeshImportRefusal, NamesAFileThatIsNotThere) {
  const std::string message = refusal(directory_.path() / "none.ply");
  EXPECT_TRUE(contains(message, "no such file"));
}

TEST_F(MeshImportRefusal, TakesNothingButRegularFiles) {
  EXPECT_TRUE(contains(refusal(directory_.path()), "is a directory"));
  EXPECT_TRUE(contains(refusal("/dev/zero"), "is a device"));
  const fs::path pipe = directory_.path() / "pipe.stl";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(contains(refusal(pipe), "is a named pipe"));
  fs::create_directory(directory_.path() / "folder.obj");
  EXPECT_TRUE(contains(refusal(directory_.path() / "folder.obj"), "is a directory"));
}

TEST_F(MeshImportRefusal, TakesNothingEmptyTooLargeOrUnreadable) {
  EXPECT_TRUE(contains(refusal(directory_.write("empty.obj", "")), "0 bytes"));

  ImportLimits small;
  small.mesh_bytes = 100;
  const std::string large = refusal(directory_.write("large.ply", tetrahedron::ascii_ply()), small);
  EXPECT_TRUE(contains(large, std::to_string(tetrahedron::ascii_ply().size()) + " bytes"));
  EXPECT_TRUE(contains(large, "at most 100 (limit 'mesh_bytes')"));

  const fs::path closed = directory_.write("closed.obj", tetrahedron::obj());
  fs::permissions(closed, fs::perms::none);
  if (::geteuid() != 0) {  // nothing is closed to root
    EXPECT_TRUE(contains(refusal(closed), "Permission denied"));
  }
}

TEST_F(MeshImportRefusal, NamesTheAcceptedExtensions) {
  for (const char* name :
       {"mesh.3mf", "mesh.blend", "mesh.x", "mesh.zae", "mesh.xml", "mesh.stl.gz", "mesh"}) {
    const std::string message = refusal(directory_.write(name, tetrahedron::obj()));
    EXPECT_TRUE(contains(message, ".obj, .stl, .ply, .off, .dae, .gltf, .glb, .fbx, .3ds"));
  }
  EXPECT_TRUE(contains(refusal(directory_.write("m.3MF", "PK\x03\x04")), "format '.3MF' is not accepted"));
}

// Every format under the extension of every other: never a mesh made of something else, and the content
// named.
TEST_F(MeshImportRefusal, SaysWhatTheContentLooksLikeWhereTheExtensionIsWrong) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  for (const auto& [name, content] : tetrahedron_files()) {
    const std::string own = fs::path(name).extension();
    for (const std::string other :
         {".obj", ".stl", ".ply", ".off", ".dae", ".gltf", ".glb", ".fbx", ".3ds"}) {
      if (other == own) continue;
      SCOPED_TRACE(std::string(name).append(" as ").append(other));
      const std::string message = refusal(directory_.write("disguised" + other, content));
      if (name == "binary.stl") continue;  // its first bytes are free text
      EXPECT_TRUE(contains(message, "the content looks like"));
      EXPECT_TRUE(contains(message, "give it the extension " + own));
    }
  }
}

TEST_F(MeshImportRefusal, CannotBeLedToOtherImportersByContent) {
  const std::string x = "xof 0303txt 0032\nMesh { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; 3;0,1,2;; }\n";
  for (const char* name :
       {"x.obj", "x.stl", "x.ply", "x.off", "x.dae", "x.gltf", "x.glb", "x.fbx", "x.3ds"}) {
    EXPECT_TRUE(contains(refusal(directory_.write(name, x)), "the content looks like DirectX X")) << name;
  }
}

TEST_F(MeshImportRefusal, TakesNoMeshWithoutTriangles) {
  const std::string no_faces =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 0\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0\n";
  EXPECT_TRUE(contains(refusal(directory_.write("none.ply", no_faces)), "no triangles"));
  EXPECT_TRUE(contains(refusal(directory_.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "triangles"));
  EXPECT_TRUE(contains(refusal(directory_.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n")),
                       "no triangles, but 2 points and lines"));
  refusal(directory_.write("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"));
  refusal(directory_.write("none.stl", "solid\nendsolid\n"));
}

TEST_F(MeshImportRefusal, NamesTheFirstVertexThatIsNotFinite) {
  std::string stl = tetrahedron::binary_stl();
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(stl.data() + 84 + 12 + 12, &not_a_number,
              sizeof(not_a_number));  // first facet, second corner, x
  EXPECT_TRUE(contains(refusal(directory_.write("nan.stl", stl)), "vertex 1 of 12 is (nan, "));
  EXPECT_TRUE(
      contains(refusal(directory_.write("large.obj", "v 1e39 0 0\n" + tetrahedron::obj())), "finite"));
}

TEST_F(MeshImportRefusal, HoldsTheLimitsOnVerticesAndFaces) {
  ImportLimits limits;
  limits.faces = 3;
  const fs::path file = directory_.write("t.off", tetrahedron::off());
  EXPECT_TRUE(contains(refusal(file, limits), "4 triangles; expected at most 3 (limit 'faces')"));
  limits.faces = 4;
  limits.vertices = 3;
  EXPECT_TRUE(contains(refusal(file, limits), "4 vertices; expected at most 3 (limit 'vertices')"));
  limits.vertices = 4;
  EXPECT_TRUE(import_mesh(file, limits));
}

TEST_F(MeshImportRefusal, CountsInstancesAgainstTheLimits) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  const fs::path file =
      directory_.write("two.gltf", tetrahedron::gltf(R"([{"mesh":0,"children":[1]},{"mesh":0}])"));
  ImportLimits limits;
  limits.faces = 7;
  EXPECT_TRUE(contains(refusal(file, limits), "8 triangles"));
}

TEST_F(MeshImportRefusal, TakesNoOffFileThatTheImporterHadToMend) {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  EXPECT_TRUE(contains(refusal(directory_.write("index.off", "OFF\n4 1 0\n" + corners + "3 0 1 9\n")),
                       "Vertex index is out of range"));
  refusal(directory_.write("short.off", "OFF\n9 4 0\n" + corners + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
}

TEST_F(MeshImportRefusal, ReadsNothingButRegularFilesThatAMeshFileNames) {
  const fs::path pipe = directory_.path() / "pipe.bin";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* buffer : {R"("uri":"pipe.bin",)", R"("uri":"/dev/zero",)", R"("uri":"missing.bin",)"}) {
    refusal(directory_.write("linked.gltf", tetrahedron::gltf(R"([{"mesh":0}])", buffer)));
  }
  const Expected<ImportedMesh> endless_material =
      import_mesh(directory_.write("linked.obj", "mtllib /dev/zero\n" + tetrahedron::obj()));
  EXPECT_TRUE(endless_material);
}

TEST_F(MeshImportRefusal, StopsAnImporterThatHangs) {
  ImportLimits limits;
  limits.import_seconds = 0.5;
  const std::string message = refusal(directory_.write("endless.obj", endless_obj()), limits);
  EXPECT_TRUE(contains(message, "had not finished after 0.5 s"));
  EXPECT_TRUE(contains(message, "'import_seconds'"));
}

TEST_F(MeshImportRefusal, OutlivesAnImporterThatCrashes) {
  EXPECT_TRUE(contains(refusal(directory_.write("crash.ply", crashing_ply())),
                       kShadowMemory ? "the importer " : "the importer crashed on it (signal "));
}

TEST_F(MeshImportRefusal, FindsAPlyHeaderWithoutItsEndAtOnce) {
  std::string content = tetrahedron::ascii_ply();
  content.replace(content.find("end_header"), 10, "end_heaber");
  EXPECT_TRUE(contains(refusal(directory_.write("endless.ply", content)), "without its 'end_header' line"));
}

TEST_F(MeshImportRefusal, StopsAnImporterThatEatsMemory) {
  if (kShadowMemory) GTEST_SKIP() << "address space cannot be limited under a sanitizer with shadow memory";
  ImportLimits limits;
  limits.memory_bytes = 200'000'000;
  const std::string header = "OFF\n50000000 50000000 0\n";
  const std::string message = refusal(directory_.write("greedy.off", header + "0 0 0\n"), limits);
  EXPECT_TRUE(contains(message, "needed more than 0.2 GB"));
}

TEST_F(MeshImportRefusal, GivesAMeshOrOneClearErrorForEveryTruncation) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  std::vector<NamedContent> files = tetrahedron_files();
  const fs::path models =
      "/usr/share/assimp/models";  // Debian's assimp-testmodels; absent, the files above do
  for (const char* name : {"OBJ/spider.obj", "STL/Spider_ascii.stl", "STL/Spider_binary.stl", "PLY/Wuson.ply",
                           "PLY/cube_binary.ply", "OFF/Wuson.off", "Collada/duck.dae",
                           "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf",
                           "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "FBX/spider.fbx",
                           "FBX/box.fbx", "3DS/fels.3ds"}) {
    if (fs::exists(models / name)) {
      files.push_back({"model" + fs::path(name).extension().string(), read_bytes(models / name)});
    }
  }
  ImportLimits limits;
  limits.import_seconds = 2.0;
  for (const auto& [name, content] : files) {
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
      SCOPED_TRACE(name + " cut at " + std::to_string(tenth) + "0 %");
      expect_usable_or_clear(directory_.write(name, content.substr(0, content.size() * tenth / 10)), limits);
    }
  }
}

TEST_F(MeshImportRefusal, GivesAMeshOrOneClearErrorForFilesWithWrongBytes) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  ImportLimits limits;
  limits.import_seconds = 0.2;
  std::uint32_t state = 1;
  const auto random = [&state] { return (state = state * 1664525U + 1013904223U) >> 8; };
  for (const auto& [name, content] : tetrahedron_files()) {
    for (int round = 0; round < 20; ++round) {
      std::string wrong = content;
      for (int i = 0; i < 1 + round % 4; ++i) wrong[random() % wrong.size()] = static_cast<char>(random());
      SCOPED_TRACE(name + " round " + std::to_string(round));
      expect_usable_or_clear(directory_.write(name, wrong), limits);
    }
  }
}

TEST_F(MeshImportRefusal, RefusesTheMalformedFilesBesideTheProject) {
  const fs::path malformed = shared_mesh_file("malformed");
  if (!fs::exists(malformed)) {
    GTEST_SKIP() << "the meshes beside the project are not here; set BUOYANCY_MESHES to their directory";
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(malformed)) refusal(entry.path());
}

TEST_F(MeshImportRefusal, WorksFromSeveralThreadsAtOnce) {
  const fs::path good = directory_.write("good.off", tetrahedron::off());
  const fs::path crash = directory_.write("crash.ply", crashing_ply());
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  ImportLimits limits;
  limits.import_seconds = 1.0;
  std::vector<std::future<bool>> imports;
  for (const fs::path& file : {endless, good, crash, good, crash, good}) {
    imports.push_back(std::async(std::launch::async, [=] { return import_mesh(file, limits).has_value(); }));
  }
  for (std::size_t i = 0; i < imports.size(); ++i) EXPECT_EQ(imports[i].get(), i % 2 == 1) << i;
}

TEST_F(MeshImportRefusal, WorksWhereTheProgramReapsItsChildrenItself) {
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;  // the kernel then reaps every child at once
  ASSERT_EQ(::sigaction(SIGCHLD, &ignore, &before), 0);
  EXPECT_TRUE(import_mesh(directory_.write("good.off", tetrahedron::off())));
  refusal(directory_.write("crash.ply", crashing_ply()));
  ASSERT_EQ(::sigaction(SIGCHLD, &before, nullptr), 0);
}

TEST_F(MeshImportRefusal, IsNotDisturbedBySignalsToTheProgram) {
  struct sigaction before {};
  struct sigaction handle {};
  handle.sa_handler = [](int) {};  // without SA_RESTART: every system call is interrupted
  ASSERT_EQ(::sigaction(SIGALRM, &handle, &before), 0);
  const itimerval every_millisecond{{0, 1000}, {0, 1000}};
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &every_millisecond, nullptr);
  ImportLimits limits;
  limits.import_seconds = 0.3;
  EXPECT_TRUE(contains(refusal(directory_.write("endless.obj", endless_obj()), limits), "had not finished"));
  EXPECT_TRUE(import_mesh(directory_.write("good.off", tetrahedron::off())));
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ASSERT_EQ(::sigaction(SIGALRM, &before, nullptr), 0);
}

// The state letter of /proc/<pid>/stat; nothing if there is no such process.
std::optional<char> process_state(pid_t pid) {
  const std::string stat = read_bytes("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_end = stat.rfind(") ");
  if (name_end == std::string::npos) return std::nullopt;
  return stat[name_end + 2];
}

template <typename Condition>
bool becomes_true(Condition condition) {
  for (int i = 0; i < 1000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

// The importer that this thread of this process has started, once it has done its set-up; 0 if that never
// comes.
pid_t importer_of(pid_t process, pid_t thread) {
  const std::string children =
      "/proc/" + std::to_string(process) + "/task/" + std::to_string(thread) + "/children";
  pid_t importer = 0;
  const bool started =
      becomes_true([&] { return static_cast<bool>(std::ifstream(children) >> importer) && importer > 0; });
  const std::string score = "/proc/" + std::to_string(importer) + "/oom_score_adj";
  return started && becomes_true([&] { return read_bytes(score) == "1000\n"; }) ? importer : 0;
}

TEST_F(MeshImportRefusal, LeavesNoImporterBehindWhenTheProgramIsKilled) {
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  const pid_t program = ::fork();
  ASSERT_GE(program, 0);
  if (program == 0) {
    ImportLimits limits;
    limits.import_seconds = 30.0;
    (void)import_mesh(endless, limits);
    ::_exit(0);
  }
  const pid_t importer = importer_of(program, program);
  ::kill(program, SIGKILL);
  ASSERT_EQ(::waitpid(program, nullptr, 0), program);
  ASSERT_GT(importer, 0);
  EXPECT_TRUE(becomes_true([&] { return process_state(importer).value_or('Z') == 'Z'; }));
}

TEST_F(MeshImportRefusal, KeepsNoDescriptorOfTheProgramOpen) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::promise<pid_t> thread;
  const fs::path endless = directory_.write("endless.obj", endless_obj());
  auto import = std::async(std::launch::async, [&] {
    thread.set_value(::gettid());
    ImportLimits limits;
    limits.import_seconds = 30.0;
    return import_mesh(endless, limits);
  });
  const pid_t importer = importer_of(::getpid(), thread.get_future().get());
  ::close(ends[1]);
  pollfd end{ends[0], POLLIN, 0};  // it ends when nobody holds the other end
  EXPECT_EQ(::poll(&end, 1, 10'000), 1);
  ::close(ends[0]);
  ASSERT_GT(importer, 0);
  ::kill(importer, SIGKILL);
  const Expected<ImportedMesh> result = import.get();
  ASSERT_FALSE(result);
  EXPECT_TRUE(contains(result.error().message(), "was killed while it read it (signal 9)"));
}

}  // namespace
}  // namespace buoyancy
