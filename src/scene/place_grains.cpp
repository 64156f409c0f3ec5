#include "scene/place_grains.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/hash.h"
#include "core/names.h"
#include "io/csv_file.h"
#include "scene/pairs.h"
#include "sim/insertion/packing.h"

namespace tsubu::scene {

namespace {

constexpr std::uint64_t mostLatticePoints = 100'000'000;

// Keys random numbers by the name of the source: another source before it does not change its grains.
std::uint64_t keyOf(const std::string& name) {
  Hash hash;
  for (const char c : name) hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  return hash.value();
}

class Placer {
 public:
  Placer(const Scene& scene, const GrainSource& source, std::vector<sim::Grain>& grains)
      : scene_(scene), source_(source), seed_(scene.simulation.seed), key_(keyOf(source.name)), grains_(grains) {
    const std::size_t material = materialIndex(scene, source.material);
    if (material != noMaterial) material_ = static_cast<std::uint16_t>(material);
  }

  void operator()(const Packing& packing) {
    const std::vector<double> radii = sim::drawRadii(source_.radii, amountOf(packing), seed_, key_);
    try {
      const std::vector<Vec3> centres = sim::packSpheres(packing.region, radii, seed_, key_);
      for (std::size_t i = 0; i < centres.size(); ++i) add(centres[i], radii[i]);
    } catch (const Error& error) {
      const Diagnostic& what = error.diagnostics().front();
      throw Error(ErrorKind::scene, fmt::format("In 'grains.{}': {}", source_.name, what.message), what.hint);
    }
  }

  void operator()(const Lattice& lattice);
  void operator()(const Inlet&) {}
  void operator()(const FromFile& from);

  void operator()(const Listed& listed) {
    for (const Vec3& place : listed.positions) add(place, drawRadius());
  }

 private:
  sim::PackingAmount amountOf(const Packing& packing) const {
    if (const auto* by = std::get_if<ByCount>(&packing.amount)) return {by->grains, {}};
    if (const auto* by = std::get_if<ByFill>(&packing.amount)) return {{}, by->fraction * packing.region.volume()};
    const double density = *scene_.materials[material_].properties[sim::Property::density];
    return {{}, std::get<ByMass>(packing.amount).mass / density};
  }

  double drawRadius() {
    Random random(seed_, mix64(key_ + 1), count_);
    return source_.radii.draw(random);
  }

  sim::Grain& add(const Vec3& place, double radius) {
    Random random(seed_, mix64(key_ + 2), count_++);
    sim::Grain grain;
    grain.position = place;
    grain.radius = radius;
    grain.velocity = sim::spreadAround(source_.velocity, source_.velocitySpread, random);
    grain.angularVelocity = source_.spin;
    grain.orientation = sim::randomRotation(random);
    grain.material = material_;
    return grains_.emplace_back(grain);
  }

  const Scene& scene_;
  const GrainSource& source_;
  std::uint64_t seed_, key_;
  std::uint64_t count_ = 0;
  std::uint16_t material_ = 0;
  std::vector<sim::Grain>& grains_;
};

/// Rows of points, layers of rows: all three lattices with neighbours at distance 1.
struct LatticeGeometry {
  double row, layer;  // distance of rows and of layers
  double rowShift;    // every second row is shifted along x by this
  Vec3 layerShift;    // each layer is shifted by this, times its number modulo `period`
  int period;
};

LatticeGeometry geometryOf(LatticeKind kind) {
  const double triangle = std::sqrt(3.0) / 2, stacked = std::sqrt(2.0 / 3.0);
  switch (kind) {
    case LatticeKind::sc:
      return {1, 1, 0, Vec3::Zero(), 1};
    // Square layers, each over the hollows of the one below.
    case LatticeKind::fcc:
      return {1, std::sqrt(0.5), 0, Vec3(0.5, 0.5, 0), 2};
    case LatticeKind::hcp:
      break;
  }
  return {triangle, stacked, 0.5, Vec3(0.5, triangle / 3, 0), 2};
}

void Placer::operator()(const Lattice& lattice) {
  const double largest = source_.radii.largest(), spacing = lattice.spacing.value_or(2 * largest);
  const double shake = lattice.jitter * std::max(0.0, spacing - 2 * largest) / 2 / std::numbers::sqrt3;
  const LatticeGeometry g = geometryOf(lattice.kind);
  const Box bounds = lattice.region.bounds();
  const Vec3 first = bounds.min() + Vec3::Constant(largest);
  const double slack = 1e-9 * largest;  // a row that fits exactly must not fall to rounding
  const auto steps = [&](int k, double distance) {
    return std::floor((bounds.sizes()[k] - 2 * largest + slack) / (distance * spacing)) + 1;
  };
  const double rows = steps(1, g.row), layers = steps(2, g.layer), columns = steps(0, 1);
  if (rows * layers * columns > static_cast<double>(mostLatticePoints)) {
    throw Error(ErrorKind::scene, fmt::format("The lattice of 'grains.{}' has {:.3g} points.", source_.name, rows * layers * columns),
                "are spacing and radius in the right unit?");
  }
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < rows; ++y) {
      const Vec3 shift = (z % g.period) * g.layerShift + Vec3(y % 2 ? g.rowShift : 0, y * g.row, z * g.layer);
      const double along = shift.x() - std::floor(shift.x());
      for (int x = 0; x < columns; ++x) {
        const Vec3 place = first + spacing * Vec3(x + along, shift.y(), shift.z());
        if (!lattice.region.containsSphere(place, largest - slack)) continue;
        Random random(seed_, mix64(key_ + 3), count_);
        const Vec3 shaken = sim::spreadAround(place, shake, random);
        add(lattice.region.containsSphere(shaken, largest - slack) ? shaken : place, drawRadius());
      }
    }
  }
}

// One row of a table of grains.
class RowReader {
 public:
  RowReader(const Scene& scene, const io::CsvReader& table) : scene_(scene), table_(table) {
    static const std::vector<std::string> known{"x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz", "material"};
    for (std::size_t c = 0; c < table.columns().size(); ++c) {
      std::size_t which = 0;
      while (which < known.size() && known[which] != table.columns()[c]) ++which;
      if (which == known.size()) {
        const auto nearest = nearestName(table.columns()[c], known);
        refuse(1, fmt::format("Unknown column '{}'.", table.columns()[c]),
               nearest ? fmt::format("did you mean '{}'?", *nearest) : listNames(known));
      }
      if (columns_[which] != absent) refuse(1, fmt::format("The column '{}' is there twice.", table.columns()[c]));
      columns_[which] = c;
    }
    for (std::size_t which = 0; which < 4; ++which) {
      if (columns_[which] == absent) refuse(1, fmt::format("The column '{}' is missing.", known[which]), "needed are x,y,z,radius");
    }
  }

  sim::Grain read(const io::CsvReader::Row& row, std::optional<std::uint16_t> material) const {
    sim::Grain grain;
    for (std::size_t k = 0; k < 3; ++k) {
      grain.position[static_cast<int>(k)] = number(row, k);
      grain.velocity[static_cast<int>(k)] = number(row, 4 + k);
      grain.angularVelocity[static_cast<int>(k)] = number(row, 7 + k);
    }
    grain.radius = number(row, 3);
    if (!(grain.radius > 0)) refuse(row.line, fmt::format("The radius is {}; it must be positive.", grain.radius));
    grain.material = materialOf(row, material);
    return grain;
  }

 private:
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);

  [[noreturn]] void refuse(int line, std::string sentence, std::string hint = {}) const {
    throw Error(ErrorKind::scene, {{{table_.name(), line, 1}, std::move(sentence), std::move(hint)}});
  }

  double number(const io::CsvReader::Row& row, std::size_t which) const {
    if (columns_[which] == absent) return 0;
    const std::string_view text = row.fields[columns_[which]];
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, failure] = std::from_chars(begin, text.data() + text.size(), value);
    if (failure == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
    refuse(row.line, fmt::format("'{}' in column '{}' is not a number.", text, table_.columns()[columns_[which]]),
           "numbers are SI, without units");
  }

  std::uint16_t materialOf(const io::CsvReader::Row& row, std::optional<std::uint16_t> otherwise) const {
    const std::string name(columns_[10] == absent ? std::string_view() : row.fields[columns_[10]]);
    if (name.empty() && otherwise) return *otherwise;
    const std::size_t index = materialIndex(scene_, name);
    if (index != noMaterial) return static_cast<std::uint16_t>(index);
    std::vector<std::string> known;
    for (const Material& material : scene_.materials) known.push_back(material.name);
    if (name.empty()) refuse(row.line, "The material is missing.", "name it in the column 'material', or in the scene");
    const auto nearest = nearestName(name, known);
    refuse(row.line, fmt::format("There is no material '{}'.", name),
           nearest ? fmt::format("did you mean '{}'?", *nearest) : listNames(known));
  }

  const Scene& scene_;
  const io::CsvReader& table_;
  std::array<std::size_t, 11> columns_ = [] {
    std::array<std::size_t, 11> all;
    all.fill(absent);
    return all;
  }();
};

void Placer::operator()(const FromFile& from) {
  io::CsvReader table = io::CsvReader::fromFile(resolved(scene_, from.file));
  const RowReader reader(scene_, table);
  std::optional<std::uint16_t> material;
  if (!source_.material.empty()) material = material_;
  io::CsvReader::Row row;
  while (table.next(row)) {
    const sim::Grain read = reader.read(row, material);
    sim::Grain& grain = add(read.position + from.offset, read.radius);
    grain.velocity += read.velocity;
    grain.angularVelocity += read.angularVelocity;
    grain.material = read.material;
  }
}

}  // namespace

void placeGrains(const Scene& scene, const GrainSource& source, std::vector<sim::Grain>& grains) {
  std::visit(Placer(scene, source, grains), source.from);
}

void refuseOverlaps(const Scene& scene, const std::vector<sim::Grain>& grains, const std::vector<std::size_t>& firstOfSource) {
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (const sim::Grain& grain : grains) {
    centres.push_back(grain.position);
    radii.push_back(grain.radius);
  }
  const auto overlap = sim::deepestOverlap(centres, radii, scene.simulation.overlapLimit);
  if (!overlap || scene.simulation.onViolation != OnViolation::stop) return;
  const auto nameOf = [&](std::uint32_t grain) {
    std::size_t source = 0;
    while (source + 1 < firstOfSource.size() && firstOfSource[source + 1] <= grain) ++source;
    return scene.grains[source].name;
  };
  const Vec3& p = centres[overlap->second];
  const std::string first = nameOf(overlap->first), second = nameOf(overlap->second);
  const std::string who =
      first == second ? fmt::format("Two grains of '{}'", first) : fmt::format("A grain of '{}' and one of '{}'", first, second);
  throw Error(ErrorKind::scene,
              fmt::format("{} overlap by {:.3g} of the radius at ({:.6g}, {:.6g}, {:.6g}) m, at most {} is allowed.", who, overlap->depth,
                          p.x(), p.y(), p.z(), scene.simulation.overlapLimit),
              "move the regions apart");
}

}  // namespace tsubu::scene
