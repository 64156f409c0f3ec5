#include <numbers>

#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;
constexpr double pi = std::numbers::pi;

void describeFrame(Form& form, render::Picture& picture, render::Background& background) {
  const auto pixels = [&form](const Field& field, int& value) {
    std::uint64_t number = static_cast<std::uint64_t>(value);
    form.integer(field, number, 16, 8192);
    value = static_cast<int>(number);
  };
  pixels({"width", "Pixels; films want an even number."}, picture.width);
  pixels({"height", "Pixels; films want an even number."}, picture.height);
  words(form, {"quality", "How smooth edges are: 1, 4 or 9 samples a pixel."}, picture.quality, render::qualityWords);
  form.table({"background", "A gradient."}, [&](Form& f) {
    f.colour({"top", "Colour at the top, \"#rrggbb\"."}, background.top);
    f.colour({"bottom", "Colour at the bottom."}, background.bottom);
  });
}

struct DescribeCamera {
  Form& form;

  void operator()(render::AutoCamera& c) const {
    form.quantity({"azimuth", "Where the eye is around the scene; 0 looks from +x, 90 deg from +y."}, c.azimuth, angle);
    form.quantity({"elevation", "Of the eye above the horizon."}, c.elevation, angle, between(-pi / 2, pi / 2));
    form.quantity({"margin", "Share of the picture left free on every side."}, c.margin, number, between(0, 0.45));
    lens(c);
  }
  void operator()(render::FixedCamera& c) const {
    form.vector(required("eye", "Where the camera is."), c.eye, length);
    form.vector(required("target", "What it looks at."), c.target, length);
    lens(c);
  }
  void operator()(render::OrbitCamera& c) const {
    form.vector(required("target", "What it looks at, and goes around."), c.target, length);
    form.quantity(required("distance", "From the target."), c.distance, length, positive);
    form.quantity({"azimuth", "Where the eye is at time 0; 0 looks from +x, 90 deg from +y."}, c.azimuth, angle);
    form.quantity({"elevation", "Of the eye above the horizon."}, c.elevation, angle, between(-pi / 2, pi / 2));
    form.quantity(required("speed", "Angular velocity in simulated time, counter-clockwise seen from above."), c.angularVelocity,
                  angularVelocity);
    lens(c);
  }
  void operator()(render::KeyFrameCamera& c) const {
    form.list(required("frames", "Where the camera is at some times; in between it moves smoothly."),
              plainEntries(c.frames, [](Form& f, render::KeyFrame& k) {
                f.quantity(required("time", "Simulated time."), k.time, dimension::time);
                f.vector(required("eye", "Where the camera is."), k.eye, length);
                f.vector(required("target", "What it looks at."), k.target, length);
                DescribeCamera{f}.lens(k);
              }));
  }

  void lens(auto& c) const {
    form.vector({"up", "What is up in the picture; any length."}, c.up, number, VectorRule::notZero);
    form.quantity({"field_of_view", "Vertical opening angle."}, c.fovY, angle, between(0.001, 3.0));
  }
};

Dimension dimensionOfColour(render::ColourBy by) {
  switch (by) {
    case render::ColourBy::speed:
      return velocity;
    case render::ColourBy::radius:
      return length;
    case render::ColourBy::force:
      return force;
    case render::ColourBy::angularVelocity:
      return angularVelocity;
    case render::ColourBy::temperature:
      return temperature;
    case render::ColourBy::uniform:
    case render::ColourBy::material:
      break;
  }
  return number;
}

void describeColours(Form& form, render::Grains& grains) {
  words(form, {"by", "What the colour of a grain shows."}, grains.by, render::colourByWords);
  words(form, {"map", "The colours of a quantity from low to high."}, grains.map, render::colourMapWords);
  form.rangeOrAuto({"range", "[low, high] of the quantity, with units. \"auto\": of each frame."}, grains.range,
                   dimensionOfColour(grains.by));
  form.colour({"uniform", "The colour of all grains when by = \"uniform\"."}, grains.uniform);
  words(form,
        {"pattern",
         "What is painted on the grains, so that one sees them turn. How far they have is kept only then: a twentieth of the time of a "
         "step."},
        grains.pattern, render::patternWords);
}

void describeShow(Form& form, Show& show) {
  form.boolean({"grains", "Draw the grains."}, show.grains);
  form.boolean({"bonds", "Draw the bonds, where there are any: cylinders, coloured by stress over strength."}, show.bonds);
  form.quantityOrAuto({"grain_scale",
                       "Drawn radius of grains over their radius: small ones show the bonds and forces between them. \"auto\": "
                       "1, and 0.25 where forces are drawn."},
                      show.grainScale, number, {0.01, 1, true, false});
  form.quantity({"bond_scale", "Drawn radius of bonds over their radius."}, show.bondScale, number, {0.01, 2, true, false});
  words(form, {"bond_map", "The colours of bonds from unloaded to breaking."}, show.bondMap, render::colourMapWords);
  form.rangeOrAuto({"bond_range", "[low, high] of stress over strength. \"auto\": 0 to 1."}, show.bondRange, number);
  form.quantityOrAuto(
      {"broken_for", "Simulated time for which a broken bond leaves a mark that shrinks. \"auto\": a third of a second of film."},
      show.brokenFor, time, notNegative);
  words(form,
        {"forces", "Draw the forces of contacts as bars between centres, as thick as the force is large: \"chains\" those above the mean."},
        show.forces, render::shownForcesWords);
  words(form, {"force_map", "The colours of contact forces from low to high."}, show.forceMap, render::colourMapWords);
  form.rangeOrAuto({"force_range", "[low, high] of contact forces, with units. \"auto\": of each frame, but for its largest fiftieth."},
                   show.forceRange, force);
  form.quantityOrAuto({"force_radius", "Of the bar of the largest force in the range. \"auto\": half the radius of the smallest grain."},
                      show.forceRadius, length, positive);
}

void describeLight(Form& form, render::Light& light) {
  form.vector({"from", "Towards the sun; any length."}, light.from, number, VectorRule::notZero);
  form.quantity({"sun", "Strength of the sun."}, light.sun, number, between(0, 4));
  form.quantity({"sky", "Strength of the sky."}, light.sky, number, between(0, 4));
  form.boolean({"shadows", "Does the sun throw shadows?"}, light.shadows);
  form.quantity({"shadow_strength", "1: no sun at all in the shadow."}, light.shadowStrength, number, share);
  form.boolean({"ambient_occlusion", "Do neighbours hide the sky?"}, light.ambientOcclusion);
  form.quantity({"occlusion_strength", "1 is the share of the sky that is hidden; up to 2 for more depth."}, light.occlusionStrength,
                number, between(0, 2));
}

void describeOverlay(Form& form, Overlay& overlay) {
  form.boolean({"title", "Write the title of the scene."}, overlay.title);
  form.boolean({"time", "Write the simulated time, and the slow motion."}, overlay.time);
  std::uint64_t decimals = static_cast<std::uint64_t>(overlay.timeDecimals);
  form.integer({"time_decimals", "Decimals of the time in seconds."}, decimals, 0, 9);
  overlay.timeDecimals = static_cast<int>(decimals);
  form.boolean({"legend", "Draw the colour map with its numbers, when colour shows a quantity."}, overlay.legend);
  static constexpr Choice places[] = {{"bottom_right", "Beside the time."}, {"top_right", "For scenes that end in the lower corner."}};
  form.word({"legend_place", "Where the legend lies."}, overlay.legendPlace, places);
}

}  // namespace

void describePicture(Form& form, Scene& scene) {
  static constexpr Choice views[] = {{"auto", "Frames the scene from a direction."},
                                     {"fixed", "Stands still."},
                                     {"orbit", "Goes around a point."},
                                     {"key_frames", "Moves through given places."}};
  form.table({"picture", "Size and background of the frames."}, [&](Form& f) { describeFrame(f, scene.picture, scene.background); });
  form.table({"camera", "From where the scene is seen."}, [&](Form& f) {
    byWord(f, {"view", "How the camera is placed."}, scene.camera, views, DescribeCamera{f});
  });
  form.table({"colours", "The colours of the grains."}, [&](Form& f) { describeColours(f, scene.colours); });
  form.table({"show", "What of grains, bonds and forces is drawn."}, [&](Form& f) { describeShow(f, scene.show); });
  form.table({"light", "A sun and a sky."}, [&](Form& f) { describeLight(f, scene.light); });
  form.table({"overlay", "What is written on the frames."}, [&](Form& f) { describeOverlay(f, scene.overlay); });
}

}  // namespace tsubu::scene
