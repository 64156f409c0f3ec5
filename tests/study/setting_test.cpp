#include "study/setting.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scene/scenes.h"
#include "scenes.h"

namespace tsubu::study {
namespace {

scene::Scene shortScene(const scene::Overrides& more = {}) { return scene::readText(scene::shortScene, "scene.toml", more); }

template <class Value>
Setting with(Value Setting::*member, Value value) {
  Setting setting;
  setting.*member = value;
  return setting;
}

TEST(Setting, AsItIsNeedsNoOverride) { EXPECT_TRUE(overridesOf({}, shortScene()).empty()); }

TEST(Setting, SoftensEveryPair) {
  const std::string more =
      "[materials.\"hard steel\"]\ndensity = 7800\n[pairs.glass.\"hard steel\"]\nnormal_stiffness = 4000\n[grains.bed]\nmaterial = "
      "\"glass\"\n";
  std::string text = scene::shortScene;
  const std::string place = "[grains.bed]\n";
  const scene::Scene scene = scene::readText(text.replace(text.find(place), place.size(), more), "scene.toml");
  const scene::Overrides soft = overridesOf(with(&Setting::softening, 0.1), scene);
  EXPECT_EQ(soft, (scene::Overrides{"pairs.normal_stiffness=100", "pairs.glass.\"hard steel\".normal_stiffness=400"}));
}

TEST(Setting, SoftensTheModulusUnderHertz) {
  const scene::Overrides hertz{"contact.normal=hertz", "contact.tangential=mindlin", "materials.glass.young_modulus=1 GPa",
                               "materials.glass.poisson_ratio=0.2"};
  EXPECT_EQ(overridesOf(with(&Setting::softening, 0.01), shortScene(hertz)), scene::Overrides{"materials.glass.young_modulus=10000000"});
}

// An eighth of the grains, twice as large, and as stiff as a material of the same modulus: k ∝ E r.
TEST(Setting, CoarserGrainsAreFewerAndKeepTheirModulus) {
  const scene::Overrides coarse = overridesOf(with(&Setting::coarsening, 2.0), shortScene({"grains.bed.count=80"}));
  EXPECT_EQ(coarse, (scene::Overrides{"grains.bed.count=10", "grains.bed.radius=0.004", "pairs.normal_stiffness=2000"}));
  const scene::Scene read = shortScene(coarse);
  EXPECT_EQ(std::get<scene::ByCount>(std::get<scene::Packing>(read.grains[0].from).amount).grains, 10u);
}

std::string reason(const Setting& setting, const scene::Scene& scene) {
  try {
    overridesOf(setting, scene);
  } catch (const Error& error) {
    return error.diagnostics().front().message;
  }
  return "none";
}

TEST(Setting, SaysWhyGrainsCannotBeCoarser) {
  EXPECT_EQ(reason(with(&Setting::coarsening, 3.0), shortScene()), "of the source 'bed' no grain would be left");
  const scene::Scene listed = scene::readText(swinging, "scene.toml");
  EXPECT_EQ(reason(with(&Setting::coarsening, 2.0), listed), "the grains of 'ball' have given places");
  EXPECT_EQ(reason(with(&Setting::equalGrains, true), listed), "the grains of each source are alike already");
}

// The mean volume stays: between 1 and 2 mm it is (2⁴ − 1)/(4 (2 − 1)) mm³.
TEST(Setting, EqualGrainsKeepTheMeanVolume) {
  const scene::Scene scene = shortScene({"grains.bed.radius={ min = 0.001, max = 0.002 }"});
  const scene::Overrides equal = overridesOf(with(&Setting::equalGrains, true), scene);
  ASSERT_EQ(equal.size(), 1u);
  EXPECT_NEAR(std::stod(equal[0].substr(equal[0].find('=') + 1)), 1e-3 * std::cbrt(15.0 / 4), 1e-12);
}

TEST(Setting, AGivenTimeStepGivesWayToItsAxis) {
  Setting half;
  half.safety = 0.5;
  EXPECT_EQ(overridesOf(half, shortScene()), scene::Overrides{"simulation.safety=0.5"});
  EXPECT_EQ(overridesOf(half, shortScene({"simulation.time_step=1e-6"})),
            (scene::Overrides{"simulation.time_step=auto", "simulation.safety=0.5"}));
}

// All that the axes offer can be read by the scene, or is refused with a reason; labels tell them apart.
TEST(Setting, EveryPlaceOfEveryAxisIsReadableOrRefused) {
  const scene::Scene scene = scene::readText(scene::shortScene, "scene.toml");
  std::vector<std::string> labels;
  for (const std::string& name : axisNames()) {
    for (const Axis::Place& place : axisOf(name, scene).places) {
      labels.push_back(labelOf(place.setting));
      try {
        EXPECT_NE(scene::readText(scene::shortScene, "scene.toml", overridesOf(place.setting, scene)), scene) << labels.back();
      } catch (const Error& error) {
        EXPECT_FALSE(error.diagnostics().front().message.empty());
      }
    }
  }
  std::sort(labels.begin(), labels.end());
  EXPECT_EQ(std::adjacent_find(labels.begin(), labels.end()), labels.end());
  EXPECT_GT(labels.size(), 20u);
  EXPECT_THROW(axisOf("stp", scene), Error);
}

TEST(Setting, FeaturesThatAreNotThereAreNotSwitchedOff) {
  for (const Feature& feature : featuresOf(scene::readText(swinging, "scene.toml"))) {
    const bool there = feature.name == "one-sided contacts" || feature.name == "tension" || feature.name == "sizes of grains";
    EXPECT_EQ(feature.impossible.empty(), there) << feature.name;
  }
}

TEST(Setting, RotationGoesWithWhatResistsIt) {
  const scene::Scene scene = scene::readText(heap, "scene.toml");
  const std::vector<Feature> features = featuresOf(scene);
  const auto rotation = std::find_if(features.begin(), features.end(), [](const Feature& f) { return f.name == "rotation"; });
  ASSERT_NE(rotation, features.end());
  EXPECT_TRUE(rotation->impossible.empty()) << rotation->impossible;
  const scene::Overrides overrides = overridesOf(rotation->without, scene);
  EXPECT_FALSE(scene::readText(heap, "scene.toml", overrides).contact.rotation);
}

TEST(Setting, CombinesFactors) {
  const Setting both = combined(with(&Setting::softening, 0.5), with(&Setting::softening, 0.5));
  EXPECT_EQ(both.softening, 0.25);
  EXPECT_EQ(labelOf(both), "stiffness / 4");
}

TEST(Trial, CommandCanBeTypedAgain) {
  EXPECT_EQ(commandOf({"a b.toml", {"x.y=3", "z=[1, 2]"}}), "tsubu run 'a b.toml' --no-frames --set x.y=3 --set 'z=[1, 2]'");
}

}  // namespace
}  // namespace tsubu::study
