#include "scene/mesh_placement.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

const Shape kRock = RockShape{.frequency = 6, .seed = 5};

std::string obj_of(const TriangleMesh& mesh) {
  std::string text;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 at = mesh.vertex(static_cast<std::int32_t>(v));
    text +=
        "v " + std::to_string(at.x()) + " " + std::to_string(at.y()) + " " + std::to_string(at.z()) + "\n";
  }
  for (const Triangle& t : mesh.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

class MeshPlacementTest : public testing::Test {
 protected:
  MeshPlacementTest() { directory_.write("rock.obj", obj_of(make_shape(kRock))); }

  Scene scene(const std::string& text) const { return scene_of(text, directory_.path()); }
  MassProperties mass(const std::string& body) const {
    return scene("[[body]]\nid = 1\n" + body).bodies()[0].prepared_mesh->mass_properties;
  }
  TempDir directory_;
};

TEST_F(MeshPlacementTest, MovesVolumeAndCentroid) {
  const MassProperties rock = mass("mesh = \"rock.obj\"\n");
  const Eigen::Quaterniond q(0.5, -0.5, 0.5, 0.1);
  for (const Vec3& scale :
       {Vec3(1, 2, 3), Vec3(1, -2, 3), Vec3(-1, -2, -3), Vec3(-1, -2, 3), Vec3(2, 2, 2)}) {
    const std::string text = "scale = [" + std::to_string(scale.x()) + ", " + std::to_string(scale.y()) +
                             ", " + std::to_string(scale.z()) + "]";
    const MassProperties placed = mass("mesh = { file = \"rock.obj\", " + text +
                                       ", position = [1, 2, 3], orientation = [0.5, -0.5, 0.5, 0.1] }\n");
    EXPECT_NEAR(placed.volume / (std::abs(scale.prod()) * rock.volume), 1.0, 1e-13);
    const Vec3 expected = q.normalized() * rock.centroid_B.cwiseProduct(scale) + Vec3(1, 2, 3);
    EXPECT_NEAR((placed.centroid_B - expected).norm(), 0.0, 1e-13);
    const MassProperties beside = mass("mesh = \"rock.obj\"\n" + text + "\n");
    EXPECT_NEAR((beside.centroid_B - rock.centroid_B.cwiseProduct(scale)).norm(), 0.0, 1e-13);
  }
}

TEST_F(MeshPlacementTest, KeepsTheOutsideOfAMirroredMesh) {
  const Scene mirrored = scene("[[body]]\nid = 1\nmesh = \"rock.obj\"\nscale = [1, -1, 1]\n");
  EXPECT_FALSE(mirrored.bodies()[0].prepared_mesh->report.flipped);
  EXPECT_GT(mirrored.bodies()[0].prepared_mesh->report.volume, 0.0);
}

TEST_F(MeshPlacementTest, GivesTheForceOfTheMovedMesh) {
  const std::string table =
      "mesh = { file = \"rock.obj\", scale = [1, -1, 1.5], position = [0.1, 0.2, 0], orientation = [1, 1, 0, "
      "0] }\n";
  const Scene placed = scene("[[body]]\nid = 1\n" + table);
  TriangleMesh moved = make_shape(kRock);
  std::istringstream as_written(obj_of(moved));  // six decimals
  ImportedMesh by_hand;
  std::string kind;
  for (double x = 0, y = 0, z = 0; as_written >> kind >> x >> y >> z;) {
    if (kind == "v") {
      const Vec3 scaled(static_cast<float>(x), -static_cast<float>(y), 1.5 * static_cast<float>(z));
      by_hand.mesh.add_vertex({scaled.x() + 0.1, -scaled.z() + 0.2, scaled.y()});
    } else {
      by_hand.mesh.triangles.push_back({static_cast<std::int32_t>(x) - 1, static_cast<std::int32_t>(z) - 1,
                                        static_cast<std::int32_t>(y) - 1});
    }
  }
  const Expected<PreparedMesh> expected = prepare_mesh(by_hand, "by hand", {}, {});
  ASSERT_TRUE(expected) << expected.error().message();
  const MassProperties& found = placed.bodies()[0].prepared_mesh->mass_properties;
  EXPECT_NEAR(found.volume, expected->mass_properties.volume, 1e-12);
  EXPECT_NEAR((found.centroid_B - expected->mass_properties.centroid_B).norm(), 0.0, 1e-12);
  EXPECT_NEAR((found.inertia_B - expected->mass_properties.inertia_B).norm(), 0.0, 1e-11);
}

TEST_F(MeshPlacementTest, ComesBeforeThatOfAPart) {
  const std::string hull = "shape = { type = \"box\", size = [1, 1, 1] }\n";
  const auto part_of = [&](const std::string& text) {
    const Scene with_part = scene("[[body]]\nid = 1\n" + hull + "[[body.part]]\n" + text);
    return with_part.bodies()[0].parts->at(1).prepared_mesh->mass_properties;
  };
  const std::string outer = "position = [5, 0, 0]\norientation = [1, 0, 0, 1]\n";  // turns x to y
  const MassProperties alone = part_of("mesh = \"rock.obj\"\n");
  const MassProperties both =
      part_of("mesh = { file = \"rock.obj\", position = [0, 7, 0], orientation = [1, 1, 0, 0] }\n" + outer);
  const Vec3& c = alone.centroid_B;
  const Vec3 inner(c.x(), 7.0 - c.z(), c.y());
  EXPECT_NEAR((both.centroid_B - Vec3(5.0 - inner.y(), inner.x(), inner.z())).norm(), 0.0, 1e-12);
}

TEST_F(MeshPlacementTest, ExplainsWhatIsWrong) {
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"mesh = { scale = 2 }\n", "no key 'file'"},
           {"mesh = { file = \"rock.obj\", size = 2 }\n", "unknown key 'size'"},
           {"mesh = { file = \"rock.obj\", scale = 2 }\nscale = 2\n", "both beside and in 'mesh'"},
           {"mesh = { file = \"rock.obj\", scale = 0 }\n", "scale = 0"},
           {"mesh = \"rock.obj\"\nscale = [1, 0, 1]\n", "none is 0"},
           {"mesh = \"rock.obj\"\nscale = [1, 1]\n", "scale = [1, 1]"},
           {"mesh = { file = \"rock.obj\", orientation = [0, 0, 0, 0] }\n", "not zero"},
           {"mesh = 5\n", "mesh"},
       }) {
    EXPECT_THAT(preparation_error("[[body]]\nid = 1\n" + text, directory_.path()), testing::HasSubstr(part));
  }
}

}  // namespace
}  // namespace buoyancy
