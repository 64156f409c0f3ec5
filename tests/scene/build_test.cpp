#include "scene/build.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/reader.h"
#include "scene/writer.h"
#include "scenes.h"
#include "sim/simulation.h"

namespace tsubu::scene {
namespace {

Built built(const std::string& more = {}, const Overrides& overrides = {}) {
  return build(readText(shortScene + more, "scene.toml", overrides));
}

TEST(Build, TheShortSceneRuns) {
  Built b = built("[walls.floor]\nplane = {}\n");
  EXPECT_EQ(b.model.grains.size(), 10u);
  EXPECT_EQ(b.model.watch.stop, true);
  sim::Simulation simulation(std::move(b.model), 1);
  simulation.advance(10);
  EXPECT_EQ(simulation.grains(), 10u);
}

TEST(Build, EveryAlternativeOfTheFormatRuns) {
  Built b = build(readText(richScene, "scene.toml"));
  EXPECT_EQ(b.model.integrator, sim::Integrator::symplecticEuler);
  EXPECT_EQ(b.model.contact.rolling, "elastic_plastic");
  EXPECT_EQ(b.model.domain.max(), Vec3::Constant(10));
  EXPECT_EQ(b.model.periodic, (std::array{true, false, true}));
  ASSERT_EQ(b.model.streams.size(), 2u);
  EXPECT_EQ(b.model.streams[0].kilogramsPerSecond, 0.2);
  EXPECT_EQ(b.model.streams[0].count, 100u);
  EXPECT_EQ(b.model.streams[1].grainsPerSecond, 50);
  EXPECT_EQ(b.model.walls.size(), 4u);
  EXPECT_EQ(b.walls.size(), 4u);
  EXPECT_EQ(b.model.walls[2].motion.parts().size(), 3u);
  EXPECT_FALSE(b.model.watch.stop);
  EXPECT_EQ(b.style.grains.materials.size(), 1u);
  EXPECT_EQ(b.style.overlay.title, "");
  EXPECT_NEAR(b.style.overlay.slowMotion.value(), 10, 1e-9);
  EXPECT_EQ(b.walls[2].look.style, render::WallStyle::wire);
  sim::Simulation simulation(std::move(b.model), 1);
  simulation.advance(5);
}

TEST(Build, SpecialPairsOverrideThoseOfAll) {
  const Built b = built("[materials.steel]\ndensity = 7850\n[pairs.steel.glass]\nfriction = 0.1\n", {"grains.bed.material=glass"});
  EXPECT_EQ(b.model.pairs.at(0, 0)[sim::Property::friction], 0.4);
  EXPECT_EQ(b.model.pairs.at(0, 1)[sim::Property::friction], 0.1);
  EXPECT_EQ(b.model.pairs.at(1, 0)[sim::Property::friction], 0.1);
  EXPECT_EQ(b.model.pairs.at(1, 0)[sim::Property::restitution], 0.5);
}

// A damping rate for one pair displaces the restitution that all have: only one of the two can be meant.
TEST(Build, ASpecialAlternativeDisplacesTheGeneralOne) {
  const Built b =
      built("[materials.steel]\ndensity = 7850\n[pairs.steel.glass]\nnormal_damping_rate = 100\n", {"grains.bed.material=glass"});
  EXPECT_FALSE(b.model.pairs.at(0, 1).has(sim::Property::restitution));
  EXPECT_EQ(b.model.pairs.at(0, 1)[sim::Property::normalDampingRate], 100);
  EXPECT_TRUE(b.model.pairs.at(0, 0).has(sim::Property::restitution));
}

TEST(Build, PlanesDecideHowTheyLook) {
  const Built b = built(R"(
[walls.floor]
plane = {}
[walls.slope]
plane = { normal = [0, -0.5, 0.866] }
[walls.front]
plane = { point = [0.1, 0, 0], normal = [-1, 0, 0] }
[walls.unseen]
plane = { point = [0, 0, 5], normal = [0, 0, -1] }
look = "hidden"
)");
  EXPECT_TRUE(b.walls[0].look.ground);
  EXPECT_EQ(b.walls[1].look.style, render::WallStyle::translucent);
  EXPECT_EQ(b.walls[2].look.style, render::WallStyle::translucent);
  EXPECT_EQ(b.walls[3].look.style, render::WallStyle::hidden);
}

// Four resting planes make a box without a lid: what is drawn of each side ends where the next begins.
TEST(Build, DrawnPlanesEndAtOtherPlanes) {
  const Built b = built(R"(
[walls.floor]
plane = {}
[walls.left]
plane = { normal = [1, 0, 0] }
[walls.right]
plane = { point = [0.1, 0, 0], normal = [-1, 0, 0] }
)");
  for (const Vec3& v : b.walls[1].mesh.vertices) EXPECT_GE(v.z(), -1e-12);
  for (const Vec3& v : b.walls[2].mesh.vertices) {
    EXPECT_NEAR(v.x(), 0.1, 1e-12);
    EXPECT_GE(v.z(), -1e-12);
  }
  EXPECT_GE(b.walls[1].mesh.triangles.size(), 2u);
}

TEST(Build, ADrawnSizeIsASquareAroundThePoint) {
  const Built b = built("[walls.w]\nplane = { point = [1, 2, 3], normal = [0, 0, 2], size = \"2 m\" }\n");
  Box box;
  for (const Vec3& v : b.walls[0].mesh.vertices) box.extend(v);
  EXPECT_TRUE(box.isApprox(Box(Vec3(0, 1, 3), Vec3(2, 3, 3))));
}

class BuildWithFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("tsubu_build_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void put(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  Built builtHere(const std::string& more) { return build(readText(shortScene + more, (folder_ / "scene.toml").string())); }

  std::filesystem::path folder_;
};

// A triangle with corners (0,0,0), (1,0,0), (0,1,0) in millimetres, turned by 90° about x and moved by 1 m along z.
TEST_F(BuildWithFiles, MeshesAreScaledTurnedAndMoved) {
  put("t.obj", "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n");
  const Built b = builtHere(
      "[walls.t]\nmesh = \"t.obj\"\nscale = \"1 mm\"\nrotation = { axis = [3, 0, 0], angle = \"90 deg\" }\nposition = [0, 0, 1]\n");
  ASSERT_EQ(b.walls[0].mesh.vertices.size(), 3u);
  EXPECT_TRUE(b.walls[0].mesh.vertices[1].isApprox(Vec3(1, 0, 1)));
  EXPECT_TRUE(b.walls[0].mesh.vertices[2].isApprox(Vec3(0, 0, 2)));
  EXPECT_TRUE(b.model.walls[0].surface->bounds().isApprox(Box(Vec3(0, 0, 1), Vec3(1, 0, 2))));
  EXPECT_EQ(b.walls[0].look.style, render::WallStyle::opaque);
}

// 5° to and fro at 2 Hz: after an eighth of a second it has turned by 5°.
TEST_F(BuildWithFiles, MeshesRock) {
  put("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string more =
      "[walls.t]\nmesh = \"t.obj\"\nmotion = { kind = \"rock\", axis = [1, 0, 0], amplitude = \"5 deg\", frequency = \"2 Hz\" }\n";
  const Pose pose = builtHere(more).model.walls[0].motion.at(0.125);
  EXPECT_NEAR(Eigen::AngleAxisd(pose.rotation).angle(), 5 * M_PI / 180, 1e-12);
  const Scene scene = readText(shortScene + more, (folder_ / "scene.toml").string());
  EXPECT_TRUE(readText(write(scene), (folder_ / "scene.toml").string()) == scene);
}

TEST_F(BuildWithFiles, GrainsFromATable) {
  put("g.csv", "# settled bed\nx,y,z,radius,vx,material\n1,2,3,0.01,4,glass\n-1,0,0.5,2e-3,0,\n");
  const Built b = builtHere("[grains.more]\nsource = \"file\"\nfile = \"g.csv\"\noffset = [0, 0, \"1 m\"]\nvelocity = [0, 1, 0]\n");
  ASSERT_EQ(b.model.grains.size(), 12u);
  EXPECT_EQ(b.model.grains[10].position, Vec3(1, 2, 4));
  EXPECT_EQ(b.model.grains[10].velocity, Vec3(4, 1, 0));
  EXPECT_EQ(b.model.grains[10].radius, 0.01);
  EXPECT_EQ(b.model.grains[11].position, Vec3(-1, 0, 1.5));
}

TEST_F(BuildWithFiles, BadTablesAreRefusedWithTheirLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"x,y,z,radus\n", "g.csv:1:1: Unknown column 'radus'. (did you mean 'radius'?)"},
      {"x,y,radius\n", "g.csv:1:1: The column 'z' is missing. (needed are x,y,z,radius)"},
      {"x,y,z,radius,x\n", "g.csv:1:1: The column 'x' is there twice."},
      {"x,y,z,radius\n\n1,2,3,0\n", "g.csv:3:1: The radius is 0; it must be positive."},
      {"x,y,z,radius\n1,2,3\n", "g.csv:2:1: This row has 3 fields; the header names 4 columns."},
      {"x,y,z,radius\n1,2 mm,3,1\n", "g.csv:2:1: '2 mm' in column 'y' is not a number. (numbers are SI, without units)"},
      {"x,y,z,radius\n1,nan,3,1\n", "g.csv:2:1: 'nan' in column 'y' is not a number. (numbers are SI, without units)"},
      {"x,y,z,radius,material\n1,2,3,1,glas\n", "g.csv:2:1: There is no material 'glas'. (did you mean 'glass'?)"},
  };
  for (const auto& [text, message] : cases) {
    SCOPED_TRACE(text);
    put("g.csv", text);
    try {
      builtHere("[grains.more]\nsource = \"file\"\nfile = \"g.csv\"\n");
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), (folder_ / message).string());
    }
  }
}

TEST(Build, AFailedPackingNamesItsSource) {
  try {
    built({}, {"grains.bed.radius=1 cm", "grains.bed.count=170"});  // a solid fraction of 0.71
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 92),
              "In 'grains.bed': 170 grains, a solid fraction of 0.712, do not fit into the region at random");
  }
}

TEST(Build, SourcesThatOverlapAreNamed) {
  try {
    built(
        "[grains.one]\nsource = \"list\"\npositions = [[1, 0, 0]]\nradius = 0.1\n[grains.two]\nsource = \"list\"\npositions = [[1.1, 0, "
        "0]]\nradius = 0.1\n");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "A grain of 'one' and one of 'two' overlap by 1 of the radius at (1.1, 0, 0) m, at most 0.1 is allowed. (move the regions apart)");
  }
}

}  // namespace
}  // namespace tsubu::scene
