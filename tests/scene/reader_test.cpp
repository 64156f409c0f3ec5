#include "scene/reader.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scenes.h"

namespace tsubu::scene {
namespace {

constexpr double pi = std::numbers::pi;

Scene readShort(const Overrides& overrides = {}) { return readText(shortScene, "folder/scene.toml", overrides); }

std::string complaintOf(const std::string& text, const Overrides& overrides = {}) {
  try {
    readText(text, "scene.toml", overrides);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Reader, ShortSceneHasTheDocumentedDefaults) {
  const Scene scene = readShort();
  Scene expected;
  expected.folder = "folder";
  expected.simulation.end = 1;
  expected.materials.push_back({"glass", {}, {}});
  expected.materials[0].properties[sim::Property::density] = 2500;
  expected.pairs.all[sim::Property::normalStiffness] = 1000;
  expected.pairs.all[sim::Property::restitution] = 0.5;
  expected.pairs.all[sim::Property::friction] = 0.4;
  GrainSource bed;
  bed.name = "bed";
  bed.from = Packing{{sim::BoxRegion{Vec3::Zero(), Vec3::Constant(0.1)}}, ByCount{10}};
  bed.radii.kind = sim::ConstantRadius{0.002};
  expected.grains.push_back(bed);
  EXPECT_TRUE(scene == expected);

  // The defaults themselves, as docs/scene_reference.md promises them.
  EXPECT_EQ(scene.simulation.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(scene.simulation.integrator, sim::Integrator::velocityVerlet);
  EXPECT_FALSE(scene.simulation.timeStep.has_value());
  EXPECT_EQ(scene.simulation.safety, 0.25);
  EXPECT_EQ(scene.simulation.seed, 1u);
  EXPECT_TRUE(scene.simulation.ledger);
  EXPECT_EQ(scene.simulation.onViolation, OnViolation::stop);
  EXPECT_EQ(scene.simulation.overlapLimit, 0.1);
  EXPECT_EQ(scene.simulation.travelLimit, 0.1);
  EXPECT_EQ(scene.contact, (sim::ContactChoice{"linear", "spring", "none", false}));
  EXPECT_EQ(frameInterval(scene.output), 1.0 / 30);
  EXPECT_EQ(ledgerInterval(scene.output), 1.0 / 30);
  EXPECT_EQ(slowMotion(scene.output), 1);
}

TEST(Reader, EveryAlternativeOfTheFormat) {
  const Scene scene = readText(richScene, "scene.toml");
  EXPECT_EQ(scene.title, "Every \"alternative\" – ö");
  EXPECT_EQ(scene.simulation.overlapLimit, 0.2);
  EXPECT_EQ(scene.simulation.domain->min, Vec3::Constant(-10));
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[1].name, "stainless steel");
  ASSERT_EQ(scene.pairs.special.size(), 1u);
  EXPECT_EQ(scene.pairs.special[0].second, "stainless steel");
  ASSERT_EQ(scene.grains.size(), 6u);
  EXPECT_TRUE(scene.grains[0].spin.isApprox(Vec3(2 * pi, 0, 0)));
  EXPECT_EQ(std::get<ByFill>(std::get<Packing>(scene.grains[0].from).amount).fraction, 0.2);
  EXPECT_EQ(std::get<sim::UniformRadius>(scene.grains[0].radii.kind).max, 1.5e-3);
  EXPECT_EQ(std::get<ByMass>(std::get<Packing>(scene.grains[1].from).amount).mass, 0.05);
  EXPECT_EQ(std::get<sim::NormalRadius>(scene.grains[1].radii.kind).deviation, 0.2e-3);
  EXPECT_EQ(std::get<Lattice>(scene.grains[2].from).kind, LatticeKind::fcc);
  EXPECT_EQ(std::get<Inlet>(scene.grains[3].from).rateKind, RateKind::mass);
  EXPECT_EQ(std::get<Inlet>(scene.grains[3].from).rate, 0.2);
  EXPECT_EQ(std::get<Inlet>(scene.grains[4].from).rateKind, RateKind::number);
  EXPECT_EQ(std::get<Inlet>(scene.grains[4].from).rate, 50);
  EXPECT_EQ(std::get<Listed>(scene.grains[5].from).positions[1], Vec3(0.51, 0, 0));
  ASSERT_EQ(scene.walls.size(), 4u);
  EXPECT_EQ(scene.walls[3].body->force, -3);
  ASSERT_EQ(scene.walls[2].motions.size(), 3u);
  EXPECT_DOUBLE_EQ(std::get<Rotate>(scene.walls[2].motions[1].kind).speed, -12 * 2 * pi / 60);
  EXPECT_EQ(scene.walls[2].motions[1].start, 0.5);
  EXPECT_EQ(scene.walls[2].motions[1].end, forever);
  EXPECT_EQ(scene.counters[0].normal, Vec3(0, 0, -1));
  EXPECT_EQ(std::get<sim::BoxRegion>(scene.sinks[0].region.shape).max, Vec3(forever, forever, -1));
  EXPECT_DOUBLE_EQ(slowMotion(scene.output), 10);  // 25 frames a second, one every 4 ms
  EXPECT_EQ(std::get<render::KeyFrameCamera>(scene.camera).frames.size(), 2u);
  EXPECT_EQ(scene.colours.range->high, 2);
}

TEST(Reader, ThingsKeepTheOrderOfTheFile) {
  const Scene scene = readText(
      shortScene +
          "[materials.zinc]\n[materials.ash]\n[walls.zulu]\nplane={}\nmaterial=\"ash\"\n[walls.alpha]\nplane={}\nmaterial=\"zinc\"\n",
      "scene.toml", {"grains.bed.material=glass"});
  EXPECT_EQ(scene.materials[1].name, "zinc");
  EXPECT_EQ(scene.materials[2].name, "ash");
  EXPECT_EQ(scene.walls[0].name, "zulu");
}

TEST(Reader, OverridesReplaceAndAdd) {
  EXPECT_EQ(readShort({"simulation.end=2"}).simulation.end, 2);
  EXPECT_EQ(readShort({"simulation.end = 2 ms "}).simulation.end, 0.002);
  EXPECT_EQ(readShort({"simulation.end=\"3 ms\""}).simulation.end, 0.003);
  EXPECT_EQ(readShort({"simulation.gravity=[0, 0, -1]"}).simulation.gravity, Vec3(0, 0, -1));
  EXPECT_EQ(readShort({"picture.width=320", "picture.height=200"}).picture.height, 200);
  EXPECT_EQ(readShort({"simulation.end=2", "simulation.end=3"}).simulation.end, 3);
  EXPECT_EQ(readShort({"pairs.glass.glass.friction=0.9"}).pairs.special[0].properties[sim::Property::friction], 0.9);
  EXPECT_EQ(readText(richScene, "s.toml", {"walls.roof.motion.1.speed=1"}).walls[2].motions[1].start, 0.5);
  EXPECT_EQ(std::get<Rotate>(readText(richScene, "s.toml", {"walls.roof.motion.1.speed=1"}).walls[2].motions[1].kind).speed, 1);
  EXPECT_EQ(
      readText(richScene, "s.toml", {"pairs.glass.\"stainless steel\".friction=0.3"}).pairs.special[0].properties[sim::Property::friction],
      0.3);
}

TEST(Reader, OverridesThatFitNothingSayWhatIsNear) {
  EXPECT_EQ(complaintOf(shortScene, {"simulation.en=2"}), "--set simulation.en: Unknown key 'en' in 'simulation'. (did you mean 'end'?)");
  EXPECT_EQ(complaintOf(shortScene, {"grains.bad.count=3"}),
            "--set grains.bad.count: There is no 'grains.bad' in the scene. (did you mean 'bed'?)");
  EXPECT_EQ(complaintOf(shortScene, {"materials.glas.density=3"}),
            "--set materials.glas.density: There is no 'materials.glas' in the scene. (did you mean 'glass'?)");
  EXPECT_EQ(complaintOf(shortScene, {"simulation.end.x=3"}),
            "--set simulation.end.x: 'simulation.end' is the text '1 s': it has no part 'x'.");
  EXPECT_EQ(complaintOf(richScene, {"walls.roof.motion.7.speed=3"}),
            "--set walls.roof.motion.7.speed: 'walls.roof.motion' has 3 elements and none is called '7'. (count from 0)");
  EXPECT_EQ(complaintOf(shortScene, {"simulation.end"}),
            "--set simulation.end: 'simulation.end' is not an override. (write --set path.to.key=value)");
  EXPECT_EQ(complaintOf(shortScene, {"=3"}), "--set : '=3' is not an override. (write --set path.to.key=value)");
  EXPECT_EQ(complaintOf(shortScene, {"simulation.end=5 kg"}),
            "--set simulation.end: '5 kg' is a mass; a time was expected, such as \"10 ms\".");
}

TEST(Reader, AllComplaintsComeAtOnceInTheOrderOfTheFile) {
  const std::string complaint = complaintOf(shortScene + "[walls.floor]\nplane = 3\nlook = \"opaqe\"\n", {"simulation.endd=1", "title=1"});
  EXPECT_EQ(
      complaint,
      "scene.toml:16:9: 'walls.floor.plane' is the number 3; a table was expected: an endless plane, solid behind.\n"
      "scene.toml:17:8: 'walls.floor.look' is the text 'opaqe'; expected \"auto\", \"opaque\", \"translucent\", \"wire\", \"ground\" or "
      "\"hidden\". (did you mean 'opaque'?)\n"
      "--set title: 'title' is the number 1; a text in quotes was expected.\n"
      "--set simulation.endd: Unknown key 'endd' in 'simulation'. (did you mean 'end'?)");
}

TEST(Reader, ValuesThatNoLawReadsAreWorthAWarning) {
  std::vector<Diagnostic> warnings;
  readText(shortScene, "scene.toml", {"contact.tangential=none"}, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(toString(warnings[0]), "scene.toml:9:12: None of the chosen contact laws reads 'friction'. (see [contact])");
}

TEST(Reader, AnUnreadableFileIsAnErrorOfFiles) {
  for (const char* path : {"/no/such/scene.toml", "/tmp"}) {
    try {
      read(path);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::files);
    }
  }
}

// Complaints about nothing but missing files are errors of files; mixed with others they are errors of the scene.
TEST(Reader, MissingMeshIsAnErrorOfFiles) {
  const std::string text = shortScene + "[walls.hopper]\nmesh = \"no.stl\"\n";
  const auto kindOf = [&](const Overrides& overrides) {
    try {
      readText(text, "scene.toml", overrides);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::simulation;
  };
  EXPECT_EQ(kindOf({}), ErrorKind::files);
  EXPECT_EQ(kindOf({"grains.bed.material=gold"}), ErrorKind::scene);
}

}  // namespace
}  // namespace tsubu::scene
