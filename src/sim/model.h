#pragma once
// What a simulation consists of, in plain structs: no words, no files, no defaults of scenes. `scene::build` fills it.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "sim/bonds/bonding.h"
#include "sim/fields/fields.h"
#include "sim/fields/magnets.h"
#include "sim/insertion/stream.h"
#include "sim/properties.h"
#include "sim/scheme.h"
#include "sim/walls/body.h"
#include "sim/walls/motion.h"
#include "sim/walls/surface.h"

namespace tsubu::sim {

/// Names of laws, as in laws/catalogue.h.
struct ContactChoice {
  std::string normal = "linear";
  std::string tangential = "spring";
  std::string rolling = "none";
  bool tension = false;  ///< may the normal force pull at the end of a contact?
  std::string twisting = "none";
  bool rescale = true;   ///< T8: does a Mindlin spring relax with its stiffness? Without, it creates energy (for comparison)
  bool rotation = true;  ///< do grains with friction turn? Held, they slide and stick, and nothing rolls

  bool operator==(const ContactChoice&) const = default;
};

struct Material {
  std::string name;
  PropertyValues values;
};

/// Properties of pairs of materials, symmetric.
class PairTable {
 public:
  explicit PairTable(std::size_t materials = 0) : materials_(materials), values_(materials * materials) {}
  std::size_t materials() const { return materials_; }
  const PropertyValues& at(std::size_t a, std::size_t b) const { return values_[a * materials_ + b]; }
  void set(std::size_t a, std::size_t b, const PropertyValues& values) {
    values_[a * materials_ + b] = values_[b * materials_ + a] = values;
  }

 private:
  std::size_t materials_;
  std::vector<PropertyValues> values_;
};

/// A wall: a surface (in its own frame; an unbounded plane is one too), how it moves, and what it is made of.
struct Wall {
  std::string name;
  std::shared_ptr<const Surface> surface;
  WallMotion motion;
  std::optional<double> temperature;  ///< K, fixed; absent: insulated
  std::optional<WallBody> body;       ///< moves under load; then `motion` is still
  std::uint16_t material = 0;
};

/// Grains whose centre enters the region are taken out and counted as removed.
struct Sink {
  std::string name;
  Region region;
};

/// Counts the grains whose centre crosses the plane along `normal` (minus those that cross against it), within `radius` of `point`.
struct Counter {
  std::string name;
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double radius = std::numeric_limits<double>::infinity();
};

/// What to do with a grain that overlaps too deeply or moves too far in a step.
struct Watch {
  double overlapLimit = 0.1;  ///< of the smaller radius
  double travelLimit = 0.1;   ///< of the radius, per step
  bool stop = true;           ///< otherwise warn once for each kind and go on
};

/// What is computed in which numbers (docs/decisions/0012-precision.md). `mixed`: contacts between grains in single precision, from
/// differences of positions taken in double, and all else in double.
enum class Precision { full, mixed };

struct Model {
  std::vector<Material> materials;
  PairTable pairs;
  ContactChoice contact;
  Integrator integrator = Integrator::velocityVerlet;
  Precision precision = Precision::full;
  Vec3 gravity = Vec3::Zero();  ///< m/s²; before any change that `fields` tells of
  Fields fields;
  std::optional<Magnets> magnets;  ///< grains act on each other as magnets
  bool heat = false;               ///< conduct heat between grains that touch
  std::vector<Grain> grains;
  std::vector<Stream> streams;
  std::vector<Wall> walls;
  std::vector<Sink> sinks;
  std::vector<Counter> counters;
  std::vector<Bonding> bonds;       ///< a pair is bonded once: by the first that claims it
  Box domain;                       ///< grains whose centre leaves it are lost; empty: a box around all that is there, with a wide margin
  std::array<bool, 3> periodic{};   ///< directions in which the domain repeats itself; it must be finite there (periodic.h)
  double timeStep = 0;              ///< s; chosen by chooseTimeStep(), or by the user
  double skin = 0;                  ///< m, reach of the outer neighbour list beyond contact; 0: chosen from the radii
  bool ledger = true;               ///< keep the energy ledger
  std::optional<double> showBonds;  ///< snapshots carry the bonds, and broken ones for so long (s); absent: no bonds
  bool orientation = true;          ///< snapshots tell how grains that turn are turned; lasting magnets keep it in any case
  bool load = false;                ///< snapshots carry the sum of contact forces on each grain
  bool showForces = false;          ///< snapshots carry the forces of contacts; needs `contactForces`
  bool contactForces = false;       ///< an Instant may be asked for: contact forces are noted when somebody looks
  Watch watch;
  bool continuous = false;  ///< C: grains that go beyond the watch's travel limit in a step are swept, and not complained of
  std::uint64_t seed = 1;
};

/// Where the stiffness depends on the overlap, the time step is chosen for this one, in smaller radii (S4).
inline constexpr double expectedOverlap = 0.01;

/// The largest step that is safe before any contact is known, and which pair of materials set it.
struct TimeStepChoice {
  double limit = 0;  ///< s: stability limit of the stiffest way in which the smallest grains of a packing can swing (S2, S3)
  std::string limitedBy;
  std::string warning;  ///< empty, or why no step would be stable
};

/// \brief The stability limit from the model alone (docs/physics.md, S1–S5). Throws Error when there is nothing to derive it from.
TimeStepChoice chooseTimeStep(const Model& model);

/// The same beside the limit of the live network (S9): for grains that get their first contacts between one look at it and the next, and
/// for what the network does not know (drag, magnets, heat, bonds that are made later).
TimeStepChoice chooseStepForNewContacts(const Model& model);

}  // namespace tsubu::sim
