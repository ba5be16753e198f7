#include "scene/scene_fingerprint.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/scene/scene_texts.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

constexpr const char* kTwoBodies = R"(
[water]
density = 1000
[[body]]
id = 1
shape = { type = "box", size = [1, 2, 3] }
[[body]]
id = 2
shape = { type = "sphere", radius = 0.5 }
[body.client]
mass = 100
)";

std::int64_t fingerprint(const std::string& text) {
  return scene_fingerprint(prepared(text));
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("no " + old);
  return text.replace(at, old.size(), by);
}

TEST(SceneFingerprint, IsThatOfWhatTheWrenchesDependOn) {
  const std::int64_t original = fingerprint(kTwoBodies);
  for (const auto& [old, by] :
       {std::pair("density = 1000", "density = 1001"), std::pair("id = 2", "id = 3"),
        std::pair("[1, 2, 3]", "[1, 3, 2]"), std::pair("[1, 2, 3]", "[1, 2, 3.0000001]"),
        std::pair("radius = 0.5", "radius = 0.6"), std::pair("id = 2", "id = 2\nmethod = \"exact\""),
        std::pair("id = 2", "id = 2\nreference_point = [0, 0, 1]"),
        std::pair("density = 1000", "density = 1000\nlevel = 0.1"),
        std::pair("density = 1000",
                  "density = 1000\n[water.waves]\ntype = \"regular\"\n"
                  "height = 0.1\nperiod = 4\n")}) {
    EXPECT_NE(fingerprint(replaced(kTwoBodies, old, by)), original) << by;
  }
}

TEST(SceneFingerprint, IgnoresWhatTheyDoNotDependOn) {
  const std::int64_t original = fingerprint(kTwoBodies);
  for (const auto& [old, by] : {std::pair("mass = 100", "mass = 200"),
                                std::pair("density = 1000", "density = 1000.0 # of fresh water"),
                                std::pair("id = 1\nshape = { type = \"box\", size = [1, 2, 3] }",
                                          "shape = { size = [1, 2, 3.0], type = \"box\" }\n\nid = 1")}) {
    EXPECT_EQ(fingerprint(replaced(kTwoBodies, old, by)), original) << by;
  }
}

TEST(SceneFingerprint, IsThatOfMeshesAndNotOfTheirNames) {
  const TempDir directory;
  const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto of_mesh = [&](const std::string& name, const std::string& mesh) {
    return fingerprint("[[body]]\nid = 1\nmesh = \"" + directory.write(name, mesh) + "\"\n");
  };
  const std::int64_t original = of_mesh("a.obj", tetrahedron);
  EXPECT_EQ(of_mesh("b.obj", tetrahedron), original);
  EXPECT_NE(of_mesh("a.obj", replaced(tetrahedron, "v 1 0 0", "v 1.000001 0 0")), original);
  EXPECT_NE(of_mesh("a.obj", replaced(tetrahedron, "f 1 3 2", "f 3 2 1")), original);
}

}  // namespace
}  // namespace buoyancy
