#include "study/observer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "scene/pairs.h"
#include "sim/diagnostics/survey.h"
#include "study/measure.h"

namespace tsubu::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The present instant: what has been asked for once is kept for the other gauges.
class Row {
 public:
  explicit Row(sim::Simulation& simulation) : simulation_(simulation) {}

  double time() const { return simulation_.time(); }
  const sim::Counts& counts() const { return simulation_.counts(); }
  std::size_t grains() const { return simulation_.grains(); }
  const Snapshot& snapshot() {
    if (!snapshot_) simulation_.fill(snapshot_.emplace());
    return *snapshot_;
  }
  const sim::Ledger& ledger() { return ledger_ ? *ledger_ : ledger_.emplace(simulation_.ledger()); }
  const sim::Instant& instant() { return instant_ ? *instant_ : instant_.emplace(simulation_.instant()); }
  double deepestOverlap() { return deepest_ ? *deepest_ : deepest_.emplace(simulation_.contacts().deepestOverlap); }

 private:
  sim::Simulation& simulation_;
  std::optional<Snapshot> snapshot_;
  std::optional<sim::Ledger> ledger_;
  std::optional<sim::Instant> instant_;
  std::optional<double> deepest_;
};

double meanDiameter(const Snapshot& snapshot) {
  double sum = 0;
  for (const double r : snapshot.radius) sum += 2 * r;
  return snapshot.grains() > 0 ? sum / static_cast<double>(snapshot.grains()) : 0;
}

std::size_t placeOf(const auto& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return static_cast<std::size_t>(found - items.begin());
}

}  // namespace

struct Observer::Gauge {
  std::string name;
  virtual ~Gauge() = default;
  virtual void add(Row& row) = 0;
  virtual Measured result() const = 0;
};

namespace {

using Gauge = Observer::Gauge;

/// What a counter has seen at each row.
struct CountedGauge : Gauge {
  std::size_t counter;
  std::vector<double> times, counts;

  explicit CountedGauge(std::size_t place) : counter(place) {}
  void add(Row& row) override {
    row.snapshot();  // brings the counters up to date
    times.push_back(row.time());
    counts.push_back(static_cast<double>(row.counts().crossed[counter]));
  }
};

struct RateGauge final : CountedGauge {
  double from, to;

  RateGauge(std::size_t place, double begin, double end) : CountedGauge(place), from(begin), to(end) {}
  void add(Row& row) override {
    if (row.time() >= from && row.time() <= to) CountedGauge::add(row);
  }
  Measured result() const override {
    const double rate = slope(times, counts);
    return {name, "1/s", rate, std::abs(rate)};
  }
};

struct CounterEmptyGauge final : CountedGauge {
  double share, all = 0;

  CounterEmptyGauge(std::size_t place, double part) : CountedGauge(place), share(part) {}
  void add(Row& row) override {
    CountedGauge::add(row);
    all = static_cast<double>(row.grains() + row.counts().removed + row.counts().lost);
  }
  Measured result() const override {
    const double time = firstReach(times, counts, share * all);
    return {name, "s", time, std::abs(time)};
  }
};

struct BoxEmptyGauge final : Gauge {
  Box box;
  double share;
  std::vector<double> times, gone;  // by how much the box holds less than the most it ever held
  double most = 0;

  BoxEmptyGauge(const sim::BoxRegion& region, double part) : box(region.min, region.max), share(part) {}
  void add(Row& row) override {
    double inside = 0;
    for (const Vec3& x : row.snapshot().position) inside += box.contains(x) ? 1 : 0;
    if (inside > most) most = inside, times.clear(), gone.clear();
    times.push_back(row.time());
    gone.push_back(most - inside);
  }
  Measured result() const override {
    const double time = most > 0 ? firstReach(times, gone, share * most) : none;
    return {name, "s", time, std::abs(time)};
  }
};

struct CentreGauge final : Gauge {
  Vec3 axis;
  std::vector<double> density;  // by material
  std::optional<double> first;
  double last = none, travelled = 0, diameter = 0;

  CentreGauge(const Vec3& along, std::vector<double> densities) : axis(along.normalized()), density(std::move(densities)) {}
  void add(Row& row) override {
    const Snapshot& s = row.snapshot();
    double mass = 0, moment = 0;
    for (std::size_t g = 0; g < s.grains(); ++g) {
      const double m = density[s.material[g]] * std::pow(s.radius[g], 3);
      mass += m;
      moment += m * axis.dot(s.position[g]);
    }
    if (mass == 0) return;
    last = moment / mass;
    if (!first) first = last;
    travelled = std::max(travelled, std::abs(last - *first));
    diameter = meanDiameter(s);
  }
  Measured result() const override { return {name, "m", last, std::max(travelled, diameter)}; }
};

struct SlopeGauge final : Gauge {
  Vec3 point, gravity;
  double angle = none;

  SlopeGauge(const Vec3& place, const Vec3& pull) : point(place), gravity(pull) {}
  void add(Row& row) override { angle = angleOfRepose(row.snapshot(), point, -gravity, gravity.norm()); }
  Measured result() const override { return {name, "rad", angle, std::abs(angle)}; }
};

struct FrontGauge final : Gauge {
  Vec3 direction;
  double share;
  double first = none, last = none, diameter = 0;

  FrontGauge(const Vec3& along, double part) : direction(along), share(part) {}
  void add(Row& row) override {
    last = front(row.snapshot().position, direction, share);
    if (std::isnan(first)) first = last;
    diameter = meanDiameter(row.snapshot());
  }
  Measured result() const override { return {name, "m", last - first, std::max(std::abs(last - first), diameter)}; }
};

struct ForceGauge final : Gauge {
  std::size_t wall, walls;
  double most = 0;

  ForceGauge(std::size_t place, std::size_t all) : wall(place), walls(all) {}
  void add(Row& row) override { most = std::max(most, sim::surveyWalls(row.instant(), walls)[wall].force.norm()); }
  Measured result() const override { return {name, "N", most, most}; }
};

struct MixingGauge final : Gauge {
  std::size_t material;
  double cell, index = none;

  MixingGauge(std::size_t place, double edge) : material(place), cell(edge) {}
  void add(Row& row) override {
    const Snapshot& s = row.snapshot();
    std::vector<char> kind;
    for (const std::uint16_t m : s.material) kind.push_back(m == material);
    index = mixingIndex(s.position, kind, cell);
  }
  Measured result() const override { return {name, "", index, 1}; }
};

struct BrokenGauge final : Gauge {
  double broken = 0;

  void add(Row& row) override {
    row.snapshot();
    broken = static_cast<double>(row.counts().broken);
  }
  Measured result() const override { return {name, "", broken, std::max(broken, 1.0)}; }
};

struct OverlapGauge final : Gauge {
  double most = 0;

  void add(Row& row) override { most = std::max(most, row.deepestOverlap()); }
  Measured result() const override { return {name, "", most, most}; }
};

struct ResidualGauge final : Gauge {
  double share = 0;

  void add(Row& row) override { share = row.ledger().residualFraction(); }
  Measured result() const override { return {name, "", share, 1}; }
};

struct KineticGauge final : Gauge {
  double last = 0, most = 0;

  void add(Row& row) override {
    const sim::Ledger& ledger = row.ledger();
    last = ledger.kinetic() - ledger.kineticWalls;
    most = std::max(most, last);
  }
  Measured result() const override { return {name, "J", last, most}; }
};

/// From the words of the scene to a gauge.
struct MakeGauge {
  using Made = std::unique_ptr<Gauge>;
  const scene::Scene& scene;

  Made operator()(const scene::DischargeRate& o) const {
    return std::make_unique<RateGauge>(placeOf(scene.counters, o.counter), o.from, o.to);
  }
  Made operator()(const scene::TimeToEmpty& o) const {
    if (o.box) return std::make_unique<BoxEmptyGauge>(*o.box, o.share);
    return std::make_unique<CounterEmptyGauge>(placeOf(scene.counters, o.counter), o.share);
  }
  Made operator()(const scene::CentreOfMass& o) const {
    std::vector<double> densities;  // nought for grains that do not count
    for (const scene::Material& material : scene.materials)
      densities.push_back(o.material.empty() || o.material == material.name ? material.properties[sim::Property::density].value_or(0) : 0);
    return std::make_unique<CentreGauge>(o.axis, std::move(densities));
  }
  Made operator()(const scene::AngleOfRepose& o) const { return std::make_unique<SlopeGauge>(o.point, scene.simulation.gravity); }
  Made operator()(const scene::RunOut& o) const { return std::make_unique<FrontGauge>(o.direction, o.share); }
  Made operator()(const scene::PeakForce& o) const {
    return std::make_unique<ForceGauge>(placeOf(scene.walls, o.wall), scene.walls.size());
  }
  Made operator()(const scene::MixingIndex& o) const {
    return std::make_unique<MixingGauge>(scene::materialIndex(scene, o.material), o.cell);
  }
  Made operator()(const scene::BrokenBonds&) const { return std::make_unique<BrokenGauge>(); }
  Made operator()(const scene::LargestOverlap&) const { return std::make_unique<OverlapGauge>(); }
  Made operator()(const scene::EnergyResidual&) const { return std::make_unique<ResidualGauge>(); }
  Made operator()(const scene::KineticEnergy&) const { return std::make_unique<KineticGauge>(); }
};

}  // namespace

std::vector<scene::Observable> observablesOf(const scene::Scene& scene) {
  if (!scene.observe.empty()) return scene.observe;
  std::vector<scene::Observable> wanted;
  if (scene.simulation.ledger) wanted.push_back({"energy_residual", scene::EnergyResidual{}});
  wanted.push_back({"largest_overlap", scene::LargestOverlap{}});
  const Vec3& gravity = scene.simulation.gravity;
  wanted.push_back({"centre_of_mass", scene::CentreOfMass{gravity.norm() > 0 ? Vec3(-gravity) : Vec3(Vec3::UnitZ())}});
  if (scene.simulation.ledger) wanted.push_back({"kinetic_energy", scene::KineticEnergy{}});
  return wanted;
}

Observer::Observer(const scene::Scene& scene, const std::vector<scene::Observable>& wanted) {
  for (const scene::Observable& observable : wanted) {
    gauges_.push_back(std::visit(MakeGauge{scene}, observable.kind));
    gauges_.back()->name = observable.name;
  }
}
Observer::~Observer() = default;
Observer::Observer(Observer&&) noexcept = default;

void Observer::add(sim::Simulation& simulation) {
  Row row(simulation);
  for (const auto& gauge : gauges_) gauge->add(row);
}

std::vector<Measured> Observer::results() const {
  std::vector<Measured> results;
  for (const auto& gauge : gauges_) results.push_back(gauge->result());
  return results;
}

}  // namespace tsubu::study
