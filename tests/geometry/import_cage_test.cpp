// What an import may read, whatever the file says. What the importer may do besides: import_process_test.cpp,
// and tests/packaging/unit_permits, which watches its system calls.
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/unique_fd.h"
#include "geometry/importer_program.h"
#include "geometry/mesh_folder.h"
#include "geometry/mesh_import.h"
#include "tests/geometry/import_checks.h"
#include "tests/geometry/mesh_files.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

// Tells whether any process opens a file or reads of it.
class Watch {
 public:
  explicit Watch(const fs::path& file) : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    EXPECT_GE(::inotify_add_watch(events_.value(), file.c_str(), IN_OPEN | IN_ACCESS), 0);
  }

  bool touched() {
    char events[4096];
    return ::read(events_.value(), events, sizeof(events)) > 0;
  }

 private:
  UniqueFd events_;
};

// The others are names of files that do not exist.
bool leads_out(const std::string& name) {
  return name[0] == '/' || name.starts_with("../") || name.find("/../") != std::string::npos ||
         name == "link.bin" || name.starts_with("up/");
}

// A folder with meshes, beside a file outside it that a mesh could use.
class ImportCage : public ImportTest {
 protected:
  ImportCage() {
    fs::create_directories(folder_ / "sub");
    fs::create_symlink(outside_, folder_ / "link.bin");
    fs::create_directory_symlink(directory_.path(), folder_ / "up");
    fs::create_symlink("sub/buffer.bin", folder_ / "inside.bin");
    directory_.write("meshes/sub/buffer.bin", tetrahedron::gltf_buffer());
  }

  std::vector<std::string> ways_out() const {
    const std::string absolute = outside_.string();
    return {"../outside.bin",
            "sub/../../outside.bin",
            absolute,
            "link.bin",
            "up/outside.bin",
            "file://" + absolute,
            "..\\outside.bin",
            "%2e%2e/outside.bin",
            "/proc/" + std::to_string(::getpid()) + "/root" + absolute,
            "//" + absolute};
  }
  fs::path write_gltf(const std::string& uri) const {
    std::string escaped;
    for (const char c : uri) escaped += c == '\\' ? std::string("\\\\") : std::string(1, c);
    return directory_.write("meshes/hull.gltf",
                            tetrahedron::gltf(R"([{"mesh":0}])", "\"uri\":\"" + escaped + "\","));
  }

  const fs::path folder_ = directory_.path() / "meshes";
  const fs::path outside_ = directory_.write("outside.bin", tetrahedron::gltf_buffer());
};

TEST_F(ImportCage, ReadsNothingOutsideFolderForGltf) {
  Watch watch(outside_);
  for (const std::string& name : ways_out()) {
    SCOPED_TRACE(name);
    const std::string message = import_error(write_gltf(name));
    EXPECT_FALSE(watch.touched());
    if (leads_out(name)) {
      EXPECT_TRUE(contains(message, "which leads out of its folder"));
    }
  }
}

TEST_F(ImportCage, ReadsNothingOutsideFolderForObjAndCollada) {
  Watch watch(outside_);
  for (const std::string& name : ways_out()) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(
        import_mesh(directory_.write("meshes/hull.obj", "mtllib " + name + "\n" + tetrahedron::obj())));
    std::string collada = tetrahedron::collada();
    const std::string images =
        "<library_images><image id=\"i\"><init_from>" + name + "</init_from></image></library_images>";
    collada.insert(collada.find("<library_geometries>"), images);
    EXPECT_TRUE(import_mesh(directory_.write("meshes/hull.dae", collada)));
    EXPECT_FALSE(watch.touched());
  }
}

TEST_F(ImportCage, ReadsFilesBelowFolder) {
  for (const char* name : {"sub/buffer.bin", "./sub/buffer.bin", "sub/../sub/buffer.bin", "inside.bin"}) {
    EXPECT_TRUE(import_mesh(write_gltf(name))) << name;
  }
}

TEST_F(ImportCage, ReadsMeshBySymbolicLinkThatUserNames) {
  directory_.write("elsewhere.off", tetrahedron::off());
  fs::create_symlink(directory_.path("elsewhere.off"), folder_ / "hull.off");
  EXPECT_TRUE(import_mesh(folder_ / "hull.off"));
}

TEST_F(ImportCage, ReadsFilesThatOnlyThisUserMayRead) {
  const fs::path gltf = write_gltf("sub/buffer.bin");
  for (const fs::path& file : {gltf, folder_ / "sub/buffer.bin"})
    fs::permissions(file, fs::perms::owner_read);
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_TRUE(import_mesh(gltf));
}

TEST_F(ImportCage, ChecksPathsWithoutTheKernelsHelp) {
  Watch watch(outside_);
  for (const auto open : {open_below, open_below_by_path}) {
    for (const std::string& name : ways_out()) {
      SCOPED_TRACE(name);
      const FileBelow found = open(folder_, name);
      EXPECT_FALSE(found.file.valid());
      EXPECT_EQ(found.outside, leads_out(name));
      EXPECT_FALSE(watch.touched());
    }
    for (const char* name : {"sub/buffer.bin", "sub/../sub/buffer.bin", "inside.bin"}) {
      EXPECT_TRUE(open(folder_, name).file.valid()) << name;
    }
    EXPECT_FALSE(open(folder_, "none.bin").file.valid());
  }
}

TEST_F(ImportCage, LimitsSizeOfFilesThatMeshRefersTo) {
  ImportLimits limits;
  const fs::path gltf = write_gltf("sub/buffer.bin");
  directory_.write("meshes/sub/buffer.bin", tetrahedron::gltf_buffer() + std::string(10'000, '\0'));
  limits.mesh_bytes = 5'000;
  import_error(gltf, limits);
  limits.mesh_bytes = 11'000;
  EXPECT_TRUE(import_mesh(gltf, limits));
}

TEST(ImporterProgram, IsFoundBesideThisProgram) {
  const Expected<std::string> program = importer_program();
  ASSERT_TRUE(program);
  EXPECT_EQ(fs::path(*program).filename(), "buoyancy-import-mesh");
}

TEST_F(ImportCage, NamesImporterThatCannotBeStarted) {
  ASSERT_EQ(::setenv("BUOYANCY_IMPORTER", "/nonexistent/importer", 1), 0);
  const std::string missing = import_error(directory_.write("a.off", tetrahedron::off()));
  EXPECT_TRUE(contains(missing, "starting /nonexistent/importer failed: No such file or directory"));
  ::setenv("BUOYANCY_IMPORTER", "/bin/false", 1);
  EXPECT_TRUE(contains(import_error(directory_.path("a.off")), "the importer failed (exit status 1)"));
  ::unsetenv("BUOYANCY_IMPORTER");
}

}  // namespace
}  // namespace buoyancy
