#include "sim/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/random.h"
#include "sim/pair_constants.h"
#include "sim/pass.h"
#include "sim/state.h"
#include "sim/time_step.h"

namespace tsubu::sim {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// What laws tell of modes is told of 1/m* with the rotation of spheres: 7/2 of a tangential spring, 5/2 over R*² of a rolling one.
Link linkOf(const std::array<ContactMode, 4>& modes, double inverseMass, double effectiveRadius) {
  const auto spring = [](const ContactMode& mode, double per) { return Link::Spring{mode.stiffness / per, mode.damping / per}; };
  const double turning = 2.5 * inverseMass / (effectiveRadius * effectiveRadius);
  Link link{};
  link.inverseMass = inverseMass;
  link.along = spring(modes[0], inverseMass);
  link.across = spring(modes[1], 3.5 * inverseMass);
  link.rolling = spring(modes[2], turning);
  link.twisting = spring(modes[3], turning);
  return link;
}

/// Translations and rotations of all grains, in coordinates scaled by the roots of mass and inertia: (3 + 3) numbers a grain.
using Motion6 = Eigen::Matrix<double, 6, 1>;
using Motion = std::vector<Motion6>;

double dot(const Motion& a, const Motion& b) {
  double sum = 0;
  for (std::size_t g = 0; g < a.size(); ++g) sum += a[g].dot(b[g]);
  return sum;
}

/// A step of velocity Verlet as a linear map of positions, half-step velocities, last accelerations and springs across (I2, T5, T6).
class VerletMap {
 public:
  VerletMap(const ContactNetwork& network, double dt)
      : network_(network), dt_(dt), grains_(network.inverseMass.size()), springs_(network.links.size()) {
    Random random(2, 0);
    for (Grain6& g : grains_)
      for (int k = 0; k < 3; ++k) g.u[k] = random.uniform(-1, 1) * dt, g.w[k] = random.uniform(-1, 1) * dt;
  }

  /// By how much the motion grows from one half of so many steps to the other.
  double growth(int steps) {
    double before = 0, after = 0;
    for (int n = 0; n < steps; ++n) {
      take();
      (2 * n < steps ? before : after) = std::max(2 * n < steps ? before : after, size());
      if (!std::isfinite(after + before) || after > 1e100) return infinite;
    }
    return after / before;
  }

 private:
  struct Grain6 {
    Vec3 x = Vec3::Zero(), u = Vec3::Zero(), a = Vec3::Zero(), w = Vec3::Zero(), b = Vec3::Zero();  // place, velocities and accelerations
  };
  struct Springs {
    Vec3 across = Vec3::Zero(), slip = Vec3::Zero(), turned = Vec3::Zero(), spin = Vec3::Zero();  // stretch and last velocity
  };

  double size() const {
    double sum = 0;
    for (std::size_t g = 0; g < grains_.size(); ++g) {
      const double inertia = network_.inverseInertia[g] > 0 ? 1 / network_.inverseInertia[g] : 0;
      sum += grains_[g].u.squaredNorm() / network_.inverseMass[g] + inertia * grains_[g].w.squaredNorm();
    }
    return std::sqrt(sum);
  }

  void take() {
    std::vector<Grain6> next = grains_;
    for (Grain6& g : next) {
      g.u += dt_ * g.a, g.w += dt_ * g.b, g.x += dt_ * g.u;
    }
    // What contacts see: velocities carried on by half a step.
    std::vector<std::pair<Vec3, Vec3>> seen;
    for (const Grain6& g : next) seen.emplace_back(g.u + 0.5 * dt_ * g.a, g.w + 0.5 * dt_ * g.b);
    for (Grain6& g : next) g.a = g.b = Vec3::Zero();
    for (std::size_t l = 0; l < springs_.size(); ++l) pull(network_.links[l], springs_[l], seen, next);
    grains_.swap(next);
  }

  void pull(const Link& link, Springs& springs, const std::vector<std::pair<Vec3, Vec3>>& seen, std::vector<Grain6>& grains) const {
    const auto i = static_cast<std::size_t>(link.first), j = static_cast<std::size_t>(std::max(link.second, 0));
    const bool wall = link.second < 0;
    const Vec3 zero = Vec3::Zero(), &n = link.normal;
    const Vec3 velocity = seen[i].first - (wall ? zero : seen[j].first) -
                          (link.firstLever * seen[i].second + (wall ? zero : Vec3(link.secondLever * seen[j].second))).cross(n);
    const Vec3 spin = seen[i].second - (wall ? zero : seen[j].second);
    const double stretch = (grains[i].x - (wall ? zero : grains[j].x)).dot(n), along = velocity.dot(n);
    const Vec3 slip = velocity - along * n;
    if (link.bond) {  // by the way that the grains have gone
      const Vec3 gone = grains[i].u - (wall ? zero : grains[j].u) -
                        (link.firstLever * grains[i].w + (wall ? zero : Vec3(link.secondLever * grains[j].w))).cross(n);
      springs.across += dt_ * (gone - gone.dot(n) * n);
      springs.turned += dt_ * (grains[i].w - (wall ? zero : grains[j].w));
    } else {
      springs.across += 0.5 * dt_ * (slip + springs.slip);
      springs.turned += 0.5 * dt_ * (spin + springs.spin);
    }
    springs.slip = slip, springs.spin = spin;
    const double least = 3.5 * link.across.stiffness * link.inverseMass * dt_ * dt_ * dt_;  // T6
    const double dashpot = link.bond ? link.across.damping : std::max(link.across.damping, least * link.across.stiffness);
    const Vec3 force =
        -(link.along.stiffness * stretch + link.along.damping * along) * n - link.across.stiffness * springs.across - dashpot * slip;
    const auto resist = [&](const Link::Spring& spring, const Vec3& turned, const Vec3& rate) {
      return Vec3(-spring.stiffness * turned - spring.damping * rate);
    };
    const Vec3 twisted = springs.turned.dot(n) * n, twist = spin.dot(n) * n;
    const Vec3 moment = resist(link.rolling, springs.turned - twisted, spin - twist) + resist(link.twisting, twisted, twist);
    const Vec3 couple = n.cross(force);
    grains[i].a += network_.inverseMass[i] * force;
    grains[i].b += network_.inverseInertia[i] * (moment - link.firstLever * couple);
    if (wall) return;
    grains[j].a -= network_.inverseMass[j] * force;
    grains[j].b -= network_.inverseInertia[j] * (moment + link.secondLever * couple);
  }

  const ContactNetwork& network_;
  double dt_;
  std::vector<Grain6> grains_;
  std::vector<Springs> springs_;
};

// s: where the map begins to grow, to half a per cent. `around`: a step near it, for the start.
double endOfVerlet(const ContactNetwork& network, double around) {
  constexpr int steps = 400;
  const auto unstable = [&](double dt) { return VerletMap(network, dt).growth(steps) > 4; };
  double low = around, high = around;
  for (int n = 0; n < 30 && unstable(low); ++n) high = low, low *= 0.7;
  for (int n = 0; n < 30 && !unstable(high); ++n) low = high, high *= 1.2;
  while (high / low > 1.005) {
    const double middle = std::sqrt(low * high);
    (unstable(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// \brief S8. At the end of stability the stiffest mode changes its sign in every step, λ = −1, which turns the scheme into
///   λ_max(Δt² K + 2 s Δt C) = 4
/// with K and C scaled by the masses, s as in S2: exact for any damping, proportional to stiffness or not. In velocity Verlet springs
/// across are stretched by velocities that such a mode does not have, and their modes end with a pair of complex roots: there the map of a
/// whole step is iterated (VerletMap), between steps that are surely stable and surely not.
class SpectralLimit {
 public:
  SpectralLimit(const ContactNetwork& network, Integrator integrator)
      : network_(network), verlet_(integrator == Integrator::velocityVerlet), integrator_(integrator) {}

  double find() {
    if (network_.links.empty()) return infinite;
    stir(1);
    if (integrator_ == Integrator::explicitEuler || integrator_ == Integrator::rungeKutta)
      return stableStep(iterate(1, 0), integrator_, true);
    const double dt = byModes();
    const auto across = [](const Link& link) {
      return !link.bond && (link.across.stiffness > 0 || link.rolling.stiffness > 0 || link.twisting.stiffness > 0);
    };
    return verlet_ && std::any_of(network_.links.begin(), network_.links.end(), across) ? endOfVerlet(network_, dt) : dt;
  }

  /// S9, from the mode that was found last and to it.
  double findQuickly(StiffestMode& last) {
    if (network_.links.empty()) return infinite;
    most_ = 400, precise_ = 1e-4, carriedOn_ = verlet_ ? 2 : 1;
    mode_ = std::move(last.shape);
    stir(0.1);
    double dt;
    if (integrator_ == Integrator::explicitEuler || integrator_ == Integrator::rungeKutta) {
      const ContactMode mode = iterate(1, 0);
      dt = stableStep({mode.stiffness, mode.damping + network_.slowing}, integrator_, true);
    } else {
      dt = byModes();
    }
    last.shape = std::move(mode_);
    return dt;
  }

 private:
  // A start that has something of everything: a mode of one corner never finds a stiffer one that is not joined to it. Most of what is
  // added goes to the grain with the stiffest contacts.
  void stir(double share) {
    Random random(1, 0);
    const std::size_t known = std::min(mode_.size(), network_.inverseMass.size());
    mode_.resize(network_.inverseMass.size(), Motion6::Zero());
    for (std::size_t g = 0; g < mode_.size(); ++g)
      for (int k = 0; k < 6; ++k)
        mode_[g][k] += (g < known ? share : 1) * random.uniform(-1, 1) / std::sqrt(static_cast<double>(mode_.size()));
    std::vector<double> sum(mode_.size(), 0);
    for (const Link& link : network_.links)
      for (const std::int32_t end : {link.first, link.second})
        if (end >= 0)
          sum[static_cast<std::size_t>(end)] +=
              (link.along.stiffness + link.across.stiffness) * network_.inverseMass[static_cast<std::size_t>(end)];
    const auto stiffest = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
    for (int k = 0; k < 6; ++k) mode_[stiffest][k] += random.uniform(-1, 1);
  }

  // Undamped first; then Δt is the smallest that any mode allows, and the mode that has it the largest eigenvalue at that Δt.
  double byModes() {
    double dt = 2 / std::sqrt(iterate(1, 0).stiffness);
    for (int round = 0; round < 20; ++round) {
      const double next = stepOf(iterate(dt * dt, 2 * s() * dt));
      const bool settled = std::abs(next / dt - 1) < 0.1 * precise_ + 1e-5;
      dt = std::min(dt, next);
      if (settled) break;
    }
    return dt;
  }

  double s() const { return verlet_ ? 2 : 1; }

  double stepOf(const ContactMode& q) const {
    const double half = s() * (q.damping + network_.slowing);
    return 4 / (half + std::sqrt(half * half + 4 * q.stiffness));
  }

  // (stiffnessWeight K + dampingWeight C) x
  Motion apply(const Motion& x, double stiffnessWeight, double dampingWeight) const {
    Motion result(x.size(), Motion6::Zero());
    for (const Link& link : network_.links) {
      const auto i = static_cast<std::size_t>(link.first), j = static_cast<std::size_t>(std::max(link.second, 0));
      const bool wall = link.second < 0;
      const double mi = std::sqrt(network_.inverseMass[i]), ti = std::sqrt(network_.inverseInertia[i]);
      const double mj = wall ? 0 : std::sqrt(network_.inverseMass[j]), tj = wall ? 0 : std::sqrt(network_.inverseInertia[j]);
      const Vec3 &n = link.normal, ui = mi * x[i].head<3>(), wi = ti * x[i].tail<3>(), uj = mj * x[j].head<3>(), wj = tj * x[j].tail<3>();
      const Vec3 slip = ui - uj - (link.firstLever * wi + link.secondLever * wj).cross(n), spin = wi - wj;
      const double carried = stiffnessWeight * (link.bond ? 1 : carriedOn_);
      const auto weigh = [&](const Link::Spring& spring) { return carried * spring.stiffness + dampingWeight * spring.damping; };
      const double across = weigh(link.across), rolling = weigh(link.rolling);
      const Vec3 force =
          (stiffnessWeight * link.along.stiffness + dampingWeight * link.along.damping - across) * slip.dot(n) * n + across * slip;
      const Vec3 moment = (weigh(link.twisting) - rolling) * spin.dot(n) * n + rolling * spin;
      const Vec3 couple = n.cross(force);
      result[i].head<3>() += mi * force;
      result[i].tail<3>() += ti * (moment - link.firstLever * couple);
      if (wall) continue;
      result[j].head<3>() -= mj * force;
      result[j].tail<3>() -= tj * (moment + link.secondLever * couple);
    }
    return result;
  }

  // Power iteration from the mode that there is, until its quotient stands still: x·K x and x·C x of a mode of length 1.
  ContactMode iterate(double stiffnessWeight, double dampingWeight) {
    double before = 0;
    for (int n = 0; n < most_; ++n) {
      const double length = std::sqrt(dot(mode_, mode_));
      for (Motion6& m : mode_) m /= length;
      Motion next = apply(mode_, stiffnessWeight, dampingWeight);
      const double quotient = dot(mode_, next);
      if (!(quotient > 0)) break;
      mode_.swap(next);
      if (n % 20 != 19) continue;
      if (std::abs(quotient / before - 1) < precise_) break;
      before = quotient;
    }
    const double length = std::sqrt(dot(mode_, mode_));
    for (Motion6& m : mode_) m /= length;
    return {dot(mode_, apply(mode_, 1, 0)), dot(mode_, apply(mode_, 0, 1))};
  }

  const ContactNetwork& network_;
  bool verlet_;
  Integrator integrator_;
  int most_ = 3000;        // iterations
  double precise_ = 1e-6;  // by which the quotient still changes in 20 of them
  double carriedOn_ = 1;   // what springs across count for
  Motion mode_;
};

double rayleighStep(const Model& model, const Snapshot& snapshot) {
  double limit = infinite;
  for (std::size_t g = 0; g < snapshot.grains(); ++g) {
    const PropertyValues& values = model.materials[snapshot.material[g]].values;
    if (!values.has(Property::youngModulus) || !values.has(Property::poissonRatio)) continue;
    const double nu = values[Property::poissonRatio], shear = values[Property::youngModulus] / (2 * (1 + nu));
    limit = std::min(limit, std::numbers::pi * snapshot.radius[g] * std::sqrt(values[Property::density] / shear) / (0.1631 * nu + 0.8766));
  }
  return limit;
}

// The rules for one contact with the mass of a grain.
void meetSingle(double mass, double stiffness, double damping, double& note, double& duration, double& undamped) {
  const double swing = std::sqrt(mass / stiffness);
  note = std::min({note, 2 * swing, damping > 0 ? 2 * mass / damping : infinite});
  duration = std::min(duration, std::numbers::pi * swing);
  undamped = std::min(undamped, 2 * swing);
}

}  // namespace

ContactNetwork networkOf(const Model& model, std::size_t law, const PairConstants& constants, bool turns, const Instant& instant,
                         const std::vector<std::uint16_t>& material) {
  const std::size_t n = model.materials.size();
  ContactNetwork network;
  for (const SeenGrain& grain : instant.grains) {
    network.inverseMass.push_back(1 / grain.mass);
    network.inverseInertia.push_back(turns ? 1 / grain.inertia() : 0);
  }
  for (const ActingContact& contact : instant.contacts) {
    const auto i = static_cast<std::size_t>(contact.first), j = static_cast<std::size_t>(std::max(contact.second, 0));
    const SeenGrain &a = instant.grains[i], &b = instant.grains[j];
    const bool wall = contact.withWall();
    const double distance = contact.branch.norm(), overlap = a.radius + (wall ? 0 : b.radius) - distance;
    const double inverseMass = network.inverseMass[i] + (wall ? 0 : network.inverseMass[j]);
    const double effectiveRadius = wall ? a.radius : 1 / (1 / a.radius + 1 / b.radius);
    const std::size_t partner = wall ? model.walls[contact.wall()].material : material[j];
    Link link =
        linkOf(lawFunctions(law).modes(constants.of(material[i] * n + partner), std::max(overlap, 0.0), effectiveRadius, inverseMass),
               inverseMass, effectiveRadius);
    link.first = contact.first;
    link.second = wall ? -1 : contact.second;
    link.normal = contact.branch / distance;
    link.firstLever = wall ? distance : distance * a.radius / (a.radius + b.radius);
    link.secondLever = wall ? 0 : distance - link.firstLever;
    network.links.push_back(link);
  }
  return network;
}

StepLimit longestStep(const ContactNetwork& network, Integrator integrator, StiffestMode& mode) {
  const auto bonds = std::count_if(network.links.begin(), network.links.end(), [](const Link& link) { return link.bond; });
  const auto contacts = static_cast<std::ptrdiff_t>(network.links.size()) - bonds;
  std::string of;
  if (contacts > 0) of = fmt::format("{} contact{}", contacts, contacts == 1 ? "" : "s");
  if (bonds > 0) of += fmt::format("{}{} bond{}", of.empty() ? "" : " and ", bonds, bonds == 1 ? "" : "s");
  return {SpectralLimit(network, integrator).findQuickly(mode), fmt::format("the stiffest mode of {}", of)};
}

StabilityLimits limitsOf(const ContactNetwork& network, const Model& model, const Snapshot& snapshot) {
  StabilityLimits limits{infinite, infinite, infinite, infinite, infinite, infinite, infinite, rayleighStep(model, snapshot)};
  const std::size_t grains = network.inverseMass.size();
  std::vector<ContactMode> row(grains), all(grains);  // translation alone, and the stiffest way of each contact
  for (const Link& link : network.links) {
    double lightest = infinite;
    const auto i = static_cast<std::size_t>(link.first), j = static_cast<std::size_t>(std::max(link.second, 0));
    for (const std::int32_t end : {link.first, link.second})
      if (end >= 0) lightest = std::min(lightest, 1 / network.inverseMass[static_cast<std::size_t>(end)]);
    meetSingle(lightest, link.along.stiffness, link.along.damping, limits.note, limits.duration, limits.undamped);

    const double turning = link.firstLever * link.firstLever * network.inverseInertia[i] +
                           (link.second < 0 ? 0 : link.secondLever * link.secondLever * network.inverseInertia[j]);
    const double spinning = network.inverseInertia[i] + (link.second < 0 ? 0 : network.inverseInertia[j]);
    const auto mode = [](const Link::Spring& spring, double inverse) {
      return ContactMode{spring.stiffness * inverse, spring.damping * inverse};
    };
    const ContactMode ways[] = {mode(link.along, link.inverseMass), mode(link.across, link.inverseMass + turning),
                                mode(link.rolling, spinning), mode(link.twisting, spinning)};
    ContactMode stiffest;
    for (const ContactMode& way : ways) {
      const bool normal = &way == ways;
      if (way.stiffness > 0 || way.damping > 0) limits.single = std::min(limits.single, stableStep(way, model.integrator, normal));
      const double share = !normal && model.integrator == Integrator::velocityVerlet ? 2 : 1;
      stiffest = {std::max(stiffest.stiffness, share * way.stiffness), std::max(stiffest.damping, way.damping)};
    }
    for (const std::int32_t end : {link.first, link.second}) {
      if (end < 0) continue;
      const auto g = static_cast<std::size_t>(end);
      // At a wall the one grain has the whole of the row.
      const double rows = (link.second < 0 ? 1 : 2) * network.inverseMass[g];
      row[g].stiffness += rows * link.along.stiffness, row[g].damping += rows * link.along.damping;
      all[g].stiffness += stiffest.stiffness, all[g].damping += stiffest.damping;
    }
  }
  for (std::size_t g = 0; g < grains; ++g) {
    if (row[g].stiffness > 0) limits.gershgorin = std::min(limits.gershgorin, stableStep(row[g], model.integrator, true));
    if (all[g].stiffness > 0) limits.sum = std::min(limits.sum, stableStep(all[g], model.integrator, true));
  }
  limits.spectral = SpectralLimit(network, model.integrator).find();
  return limits;
}

SingleContactRules singleContactRules(const Model& model) {
  const std::size_t law = lawIndex(model.contact), n = model.materials.size();
  const PairConstants constants = preparePairs(model, law);
  const std::vector<char> meet = pairsThatMeet(model);
  std::vector<double> radius(n, infinite);
  for (const Grain& grain : model.grains) radius[grain.material] = std::min(radius[grain.material], grain.radius);
  for (const Stream& stream : model.streams) radius[stream.material] = std::min(radius[stream.material], stream.radii.smallest());
  SingleContactRules rules{infinite, infinite, infinite};
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!std::isfinite(radius[a]) || !meet[a * n + b]) continue;
      const bool grains = std::isfinite(radius[b]);
      const double mass = massOf(model.materials[a].values[Property::density], radius[a]);
      const double effective = grains ? 1 / (1 / radius[a] + 1 / radius[b]) : radius[a];
      const double overlap = expectedOverlap * std::min(radius[a], radius[b]);
      const ContactMode mode = lawFunctions(law).modes(constants.of(a * n + b), overlap, effective, 1 / mass)[0];
      meetSingle(mass, mode.stiffness * mass, mode.damping * mass, rules.note, rules.duration, rules.undamped);
    }
  }
  return rules;
}

}  // namespace tsubu::sim
