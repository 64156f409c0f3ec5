#pragma once
// How a film looks: everything the renderer can be told, as plain values that can be compared, filled by the scene reader.
// Lengths in metres, angles in radians, times in seconds of the simulation, colours sRGB-encoded as people write them.

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/vec.h"

namespace tsubu::render {

/// A word of a scene file and what it means. Each enumeration below has its table `…Words`, which is the list of what may be written.
template <class E>
struct Word {
  std::string_view text;
  E value;
};

/// A colour as written in "#rrggbb": sRGB-encoded, 8 bits a channel.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;

  auto operator<=>(const Colour&) const = default;
};

/// The colour of "#rrggbb" or "#rgb"; nothing for any other text.
std::optional<Colour> parseColour(std::string_view text);
/// "#rrggbb", lower case.
std::string toString(Colour colour);

/// A closed interval of a quantity, in the unit of that quantity.
struct Range {
  double low = 0, high = 1;

  bool operator==(const Range&) const = default;
};

// --- picture ------------------------------------------------------------------------------------------------------------

/// How many samples find out what a pixel shows: 1, 4 or 9. Each surface within a pixel is shaded once, however many samples it has.
/// Drafts have hard shadows.
enum class Quality { draft, normal, fine };
inline constexpr std::array<Word<Quality>, 3> qualityWords{
    {{"draft", Quality::draft}, {"normal", Quality::normal}, {"fine", Quality::fine}}};

/// 1, 2 or 3 samples along each side of a pixel.
int samplesAlongSide(Quality quality);

struct Picture {
  int width = 1280, height = 720;  ///< pixels, 16 to 8192 each; films want them even
  Quality quality = Quality::normal;

  bool operator==(const Picture&) const = default;
};

/// A vertical gradient.
struct Background {
  Colour top{0xe9, 0xee, 0xf2}, bottom{0xc3, 0xcd, 0xd6};

  bool operator==(const Background&) const = default;
};

// --- light --------------------------------------------------------------------------------------------------------------

/// One sun, and a sky that is brighter above than below.
struct Light {
  Vec3 from{-0.45, -0.55, 0.9};  ///< towards the sun, any length but zero
  double sun = 1;                ///< strength of the sun, 0 to 4
  double sky = 1;                ///< strength of the sky, 0 to 4
  bool shadows = true;
  double shadowStrength = 0.85;  ///< 0 (none) to 1 (no sun at all in the shadow)
  double softness = 0.03;        ///< of shadows: width of a penumbra per distance to what throws it, 0 to 0.2
  bool ambientOcclusion = true;  ///< neighbours hide the sky: what makes a heap read as a heap
  double occlusionStrength = 1;  ///< 0 (none) to 2 (darker than nature); 1 is the geometric share of the sky that is hidden

  bool operator==(const Light&) const = default;
};

// --- camera -------------------------------------------------------------------------------------------------------------

/// Frames the bounds of the scene from the given direction.
struct AutoCamera {
  double azimuth = -0.96;   ///< of the eye about `up`, from the first axis across it (x when up is z); 0 looks from +x
  double elevation = 0.35;  ///< of the eye above the horizon, −π/2 to π/2
  double fovY = 0.52;       ///< full vertical opening angle
  double margin = 0.06;     ///< share of the picture left free on every side
  Vec3 up{0, 0, 1};

  bool operator==(const AutoCamera&) const = default;
};

struct FixedCamera {
  Vec3 eye{0, -1, 0.5}, target = Vec3::Zero(), up{0, 0, 1};
  double fovY = 0.52;

  bool operator==(const FixedCamera&) const = default;
};

/// Goes round the target at constant angular velocity.
struct OrbitCamera {
  Vec3 target = Vec3::Zero(), up{0, 0, 1};
  double distance = 1;
  double elevation = 0.35;
  double azimuth = -0.96;      ///< at time 0
  double angularVelocity = 0;  ///< rad/s, counter-clockwise seen from above
  double fovY = 0.52;

  bool operator==(const OrbitCamera&) const = default;
};

struct KeyFrame {
  double time = 0;
  Vec3 eye{0, -1, 0.5}, target = Vec3::Zero(), up{0, 0, 1};
  double fovY = 0.52;

  bool operator==(const KeyFrame&) const = default;
};

/// Passes smoothly (C1, no overshoot in time) through key frames in ascending time; rests before the first and after the last.
struct KeyFrameCamera {
  std::vector<KeyFrame> frames;  ///< at least one

  bool operator==(const KeyFrameCamera&) const = default;
};

using Camera = std::variant<AutoCamera, FixedCamera, OrbitCamera, KeyFrameCamera>;

// --- grains -------------------------------------------------------------------------------------------------------------

enum class ColourBy { uniform, material, speed, radius, force, angularVelocity, temperature };
inline constexpr std::array<Word<ColourBy>, 7> colourByWords{{{"uniform", ColourBy::uniform},
                                                              {"material", ColourBy::material},
                                                              {"speed", ColourBy::speed},
                                                              {"radius", ColourBy::radius},
                                                              {"force", ColourBy::force},
                                                              {"angular_velocity", ColourBy::angularVelocity},
                                                              {"temperature", ColourBy::temperature}}};

/// All perceptually uniform; `vik` is diverging, for a range whose middle means something.
enum class ColourMap { viridis, cividis, batlow, vik };
inline constexpr std::array<Word<ColourMap>, 4> colourMapWords{
    {{"viridis", ColourMap::viridis}, {"cividis", ColourMap::cividis}, {"batlow", ColourMap::batlow}, {"vik", ColourMap::vik}}};

/// What is painted on a grain, so that one sees it turn. Needs the orientation in the snapshot.
enum class Pattern { none, twoTone, stripes };
inline constexpr std::array<Word<Pattern>, 3> patternWords{
    {{"none", Pattern::none}, {"two_tone", Pattern::twoTone}, {"stripes", Pattern::stripes}}};

/// What bonds look like, when they are drawn: cylinders coloured by their load, the stress over the strength.
struct Bonds {
  bool shown = false;
  ColourMap map = ColourMap::batlow;
  std::optional<Range> range;  ///< of the load; without it 0 to 1
  double scale = 1;            ///< drawn radius over the radius
  Colour broken{0xe6, 0x39, 0x46};
  double brokenFor = 0;  ///< s of the simulation: how long a broken bond leaves a mark

  bool operator==(const Bonds&) const = default;
};

/// Which contact forces are drawn: those above the mean are the force chains.
enum class ShownForces { none, chains, all };
inline constexpr std::array<Word<ShownForces>, 3> shownForcesWords{
    {{"none", ShownForces::none}, {"chains", ShownForces::chains}, {"all", ShownForces::all}}};

/// Contact forces as bars from centre to centre, as thick as the force is large.
struct Forces {
  ShownForces which = ShownForces::none;
  ColourMap map = ColourMap::batlow;
  std::optional<Range> range;  ///< N; without it each frame has its own
  double radius = 0;           ///< m: of the bar for the upper end of the range

  bool operator==(const Forces&) const = default;
};

struct Grains {
  bool shown = true;
  double scale = 1;  ///< drawn radius over the radius
  ColourBy by = ColourBy::material;
  ColourMap map = ColourMap::viridis;
  std::optional<Range> range;  ///< SI units; without it each frame has its own, and the legend says so
  Colour uniform{0xd8, 0xb4, 0x78};
  std::vector<Colour> materials;  ///< by index of the material; beyond its end the palette of colour_map.h continues
  Pattern pattern = Pattern::none;

  bool operator==(const Grains&) const = default;
};

// --- walls --------------------------------------------------------------------------------------------------------------

/// `wire` draws the borders and creases of the mesh, not its triangulation.
enum class WallStyle { opaque, translucent, wire, hidden };
inline constexpr std::array<Word<WallStyle>, 4> wallStyleWords{
    {{"opaque", WallStyle::opaque}, {"translucent", WallStyle::translucent}, {"wire", WallStyle::wire}, {"hidden", WallStyle::hidden}}};

struct WallLook {
  WallStyle style = WallStyle::opaque;
  Colour colour{0xa9, 0xb4, 0xbd};
  double opacity = 0.14;  ///< of a translucent wall seen face on, 0 to 1
  bool ground = false;    ///< a floor without end: fades into the background, throws no shadow, is not outlined

  bool operator==(const WallLook&) const = default;
};

// --- overlay ------------------------------------------------------------------------------------------------------------

enum class LegendPlace { bottomRight, topRight };

struct Overlay {
  bool time = true;
  int timeDecimals = 2;              ///< of the time stamp in seconds, 0 to 9
  std::optional<double> slowMotion;  ///< seconds of film per simulated second; printed when it is not 1
  bool legend = true;                ///< drawn when the colour shows a quantity
  LegendPlace legendPlace = LegendPlace::bottomRight;
  std::string title;  ///< UTF-8; what the font lacks becomes a box

  bool operator==(const Overlay&) const = default;
};

// --- all of it ----------------------------------------------------------------------------------------------------------

struct Style {
  Picture picture;
  Background background;
  Light light;
  Camera camera;
  Grains grains;
  Bonds bonds;
  Forces forces;
  Overlay overlay;

  bool operator==(const Style&) const = default;
};

}  // namespace tsubu::render
