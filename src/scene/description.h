#pragma once
// A scene in plain structs: complete (every default filled in or said to be "auto"), valid, comparable, printable. Words are still
// words (names of materials, of laws, of files); scene::build turns them into types. All numbers SI.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/style.h"
#include "scene/bonds.h"
#include "scene/observe.h"
#include "sim/insertion/region.h"
#include "sim/insertion/size_distribution.h"
#include "sim/model.h"
#include "sim/properties.h"

namespace tsubu::scene {

inline constexpr double forever = std::numeric_limits<double>::infinity();

/// Heat conduction; absent from a scene that does not ask for it.
struct Heat {
  double temperature = 293.15;  ///< K, of grains whose source says nothing

  bool operator==(const Heat&) const = default;
};

/// A magnet that is not a grain.
struct FieldSource {
  std::string name;
  decltype(sim::FieldSource::kind) kind;
  std::string wall;  ///< that carries it; empty: it stands still

  bool operator==(const FieldSource&) const = default;
};

/// Grains act on each other as magnets.
struct Magnets {
  std::optional<double> cutOff;  ///< m; absent: four diameters of the largest magnet
  std::vector<FieldSource> sources;

  bool operator==(const Magnets&) const = default;
};

/// The properties that a scene gives, by sim::Property.
struct Properties {
  std::array<std::optional<double>, sim::propertyCount> values;

  std::optional<double>& operator[](sim::Property property) { return values[static_cast<std::size_t>(property)]; }
  const std::optional<double>& operator[](sim::Property property) const { return values[static_cast<std::size_t>(property)]; }
  bool operator==(const Properties&) const = default;
};

struct Material {
  std::string name;
  Properties properties;
  std::optional<render::Colour> colour;  ///< absent: from the palette

  bool operator==(const Material&) const = default;
};

/// What is special about two materials that meet, in the order of writing.
struct Pair {
  std::string first, second;
  Properties properties;

  bool operator==(const Pair&) const = default;
};

struct Pairs {
  Properties all;  ///< for every pair that says nothing else
  std::vector<Pair> special;

  bool operator==(const Pairs&) const = default;
};

/// What happens when a grain overlaps too deeply or moves too far in a step.
enum class OnViolation { stop, warn };

/// Where the automatic time step comes from.
enum class StepRule { packing, spectral };

struct Simulation {
  double end = 0;  ///< s
  Vec3 gravity{0, 0, -9.81};
  sim::Integrator integrator = sim::Integrator::velocityVerlet;
  sim::Precision precision = sim::Precision::full;
  std::optional<double> timeStep;  ///< s; absent: from the stability limit
  StepRule limit = StepRule::packing;
  double safety = 0.25;  ///< of the stability limit, when the time step is automatic
  std::uint64_t seed = 1;
  std::optional<sim::BoxRegion> domain;
  std::array<bool, 3> periodic{};  ///< x, y, z: directions in which the domain repeats itself
  std::optional<double> skin;      ///< m
  bool ledger = true;
  bool continuous = false;
  OnViolation onViolation = OnViolation::stop;
  double overlapLimit = 0.1, travelLimit = 0.1;

  bool operator==(const Simulation&) const = default;
};

// --- grains -------------------------------------------------------------------------------------------------------------

struct ByCount {
  std::uint64_t grains = 0;
  bool operator==(const ByCount&) const = default;
};
struct ByFill {
  double fraction = 0;  ///< volume of the grains over volume of the region
  bool operator==(const ByFill&) const = default;
};
struct ByMass {
  double mass = 0;  ///< kg
  bool operator==(const ByMass&) const = default;
};

/// At random places in a region, without overlap.
struct Packing {
  sim::Region region;
  std::variant<ByCount, ByFill, ByMass> amount;
  bool operator==(const Packing&) const = default;
};

enum class LatticeKind { sc, fcc, hcp };

/// On the points of a lattice inside a region.
struct Lattice {
  sim::Region region;
  LatticeKind kind = LatticeKind::hcp;
  std::optional<double> spacing;  ///< m between neighbours; absent: the largest diameter
  double jitter = 0;              ///< largest displacement of each coordinate, as a fraction of the free gap between neighbours
  bool operator==(const Lattice&) const = default;
};

enum class RateKind { number, mass };

/// An inlet: grains appear in a region at a rate.
struct Inlet {
  sim::Region region;
  double rate = 0;  ///< grains/s or kg/s
  RateKind rateKind = RateKind::number;
  double start = 0, end = forever;  ///< s
  std::optional<std::uint64_t> count;
  bool operator==(const Inlet&) const = default;
};

/// From a CSV file: x,y,z,radius[,vx,vy,vz,wx,wy,wz,material]; SI.
struct FromFile {
  std::string file;            ///< as written: relative to the scene
  Vec3 offset = Vec3::Zero();  ///< m, added to every position
  bool operator==(const FromFile&) const = default;
};

/// At given places.
struct Listed {
  std::vector<Vec3> positions;  ///< m
  bool operator==(const Listed&) const = default;
};

struct GrainSource {
  std::string name;
  std::variant<Packing, Lattice, Inlet, FromFile, Listed> from;
  std::string material;               ///< empty: the only one (or, from a file, the file says)
  sim::SizeDistribution radii;        ///< not of a file
  Vec3 velocity = Vec3::Zero();       ///< m/s; added to what a file says
  double velocitySpread = 0;          ///< m/s: largest random deviation of each component
  Vec3 spin = Vec3::Zero();           ///< rad/s; added to what a file says
  std::optional<double> temperature;  ///< K; absent: that of [heat]

  bool operator==(const GrainSource&) const = default;
};

// --- walls --------------------------------------------------------------------------------------------------------------

struct PlaneShape {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< towards the grains, any length but zero
  std::optional<double> size;   ///< m, edge of the square that is drawn around `point`; absent: as large as the scene
  bool operator==(const PlaneShape&) const = default;
};

struct MeshShape {
  std::string file;  ///< as written: relative to the scene
  double scale = 1;  ///< metres per unit of the file
  Vec3 position = Vec3::Zero();
  Vec3 rotationAxis = Vec3::UnitZ();
  double rotationAngle = 0;  ///< rad; scaled first, then turned, then moved
  bool operator==(const MeshShape&) const = default;
};

struct Translate {
  Vec3 velocity = Vec3::Zero();
  bool operator==(const Translate&) const = default;
};
struct Rotate {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  double speed = 0;  ///< rad/s
  bool operator==(const Rotate&) const = default;
};
struct Oscillate {
  Vec3 amplitude = Vec3::Zero();
  double frequency = 0, phase = 0;
  bool operator==(const Oscillate&) const = default;
};
struct Rock {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
  double amplitude = 0;  ///< rad
  double frequency = 0, phase = 0;
  bool operator==(const Rock&) const = default;
};

struct Motion {
  std::variant<Translate, Rotate, Oscillate, Rock> kind;
  double start = 0, end = forever;  ///< s
  bool operator==(const Motion&) const = default;
};

enum class Look { automatic, opaque, translucent, wire, ground, hidden };

struct Wall {
  std::string name;
  std::variant<PlaneShape, MeshShape> shape;
  std::string material;  ///< empty: the only one
  std::vector<Motion> motions;
  std::optional<sim::WallBody> body;
  std::optional<double> temperature;  ///< K
  Look look = Look::automatic;
  std::optional<render::Colour> colour;
  std::optional<double> opacity;  ///< of a translucent wall

  bool operator==(const Wall&) const = default;
};

struct Sink {
  std::string name;
  sim::Region region;
  bool operator==(const Sink&) const = default;
};

struct Counter {
  std::string name;
  Vec3 point = Vec3::Zero(), normal{0, 0, -1};
  double radius = forever;  ///< m
  bool operator==(const Counter&) const = default;
};

// --- output -------------------------------------------------------------------------------------------------------------

struct Output {
  double fps = 30;                       ///< frames per second of the film
  std::optional<double> slowMotion;      ///< seconds of film per simulated second; 1 when nothing is said
  std::optional<double> frameInterval;   ///< s of simulated time; the other way to say it
  std::optional<double> ledgerInterval;  ///< s; absent: with every frame

  bool operator==(const Output&) const = default;
};

/// A part of space that has its own rows.
struct DiagnosticRegion {
  std::string name;
  sim::BoxRegion box;

  bool operator==(const DiagnosticRegion&) const = default;
};

struct DiagnosticGrid {
  sim::BoxRegion box;
  std::array<std::uint64_t, 3> cells{1, 1, 1};

  bool operator==(const DiagnosticGrid&) const = default;
};

/// What is written beside the ledger.
struct Diagnostics {
  std::uint64_t every = 1;  ///< rows of the ledger
  std::vector<DiagnosticRegion> regions;
  std::optional<DiagnosticGrid> grid;

  bool operator==(const Diagnostics&) const = default;
};

/// What of grains, bonds and forces is drawn.
struct Show {
  bool grains = true, bonds = true;
  std::optional<double> grainScale;  ///< absent: 1, or, where forces are drawn, so small that they are seen
  double bondScale = 1;
  render::ColourMap bondMap = render::ColourMap::batlow;
  std::optional<render::Range> bondRange;
  std::optional<double> brokenFor;  ///< s; absent: a third of a second of film
  render::ShownForces forces = render::ShownForces::none;
  render::ColourMap forceMap = render::ColourMap::batlow;
  std::optional<render::Range> forceRange;
  std::optional<double> forceRadius;  ///< m; absent: half the radius of the smallest grain

  bool operator==(const Show&) const = default;
};

struct Overlay {
  bool time = true, legend = true, title = true;
  int timeDecimals = 2;
  std::size_t legendPlace = 0;  ///< 0: bottom right, 1: top right

  bool operator==(const Overlay&) const = default;
};

struct Scene {
  std::string title;
  Simulation simulation;
  sim::ContactChoice contact;
  std::vector<Material> materials;
  Pairs pairs;
  std::vector<GrainSource> grains;
  std::vector<Wall> walls;
  std::vector<Sink> sinks;
  std::vector<Counter> counters;
  std::vector<Bonds> bonds;
  sim::Fields fields;
  std::optional<Heat> heat;
  std::optional<Magnets> magnets;
  Output output;
  std::optional<Diagnostics> diagnostics;
  std::vector<Observable> observe;
  render::Picture picture;
  render::Background background;
  render::Light light;
  render::Camera camera;
  render::Grains colours;  ///< `materials` stays empty: each material has its own
  Show show;
  Overlay overlay;
  std::string folder;  ///< of the scene file: what paths are relative to

  bool operator==(const Scene&) const = default;
};

/// s of simulated time from frame to frame, from the two ways to say it.
double frameInterval(const Output& output);
/// Seconds of film per simulated second.
double slowMotion(const Output& output);
/// s of simulated time from one row of the ledger to the next.
double ledgerInterval(const Output& output);
/// The file as a path that can be opened: absolute, or relative to where the program runs.
std::string resolved(const Scene& scene, const std::string& file);

}  // namespace tsubu::scene
