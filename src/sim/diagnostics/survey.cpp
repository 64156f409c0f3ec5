#include "sim/diagnostics/survey.h"

#include <algorithm>
#include <cmath>

#include "sim/diagnostics/sphere_box.h"

namespace tsubu::sim {

namespace {

/// The share of the way from `from` along −`branch` that lies in the box (clipped by three pairs of planes).
double shareWithin(const Box& box, const Vec3& from, const Vec3& branch) {
  double enters = 0, leaves = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = -branch[axis], low = box.min()[axis] - from[axis], high = box.max()[axis] - from[axis];
    if (step == 0) {
      // A way within a boundary plane belongs to the cell above it.
      if (!(low <= 0 && 0 < high)) return 0;
      continue;
    }
    enters = std::max(enters, std::min(low / step, high / step));
    leaves = std::min(leaves, std::max(low / step, high / step));
  }
  return std::max(0.0, leaves - enters);
}

/// Calls visit(shift) for all images of a thing of this size at x that may reach into the domain, itself included.
template <class Visit>
void forImages(const Periods& periods, const Vec3& x, double size, Visit&& visit) {
  visit(Vec3(Vec3::Zero()));
  if (periods.any()) periods.forImages(x, size, [&](int number) { visit(periods.shift(number)); });
}

/// Two passes over the grains of one region or cell: means, then what deviates from them.
class MotionSums {
 public:
  void addToMean(const SeenGrain& grain) {
    ++result_.grains;
    result_.mass += grain.mass;
    result_.bulkVelocity += grain.mass * grain.velocity;
  }
  void closeMean() {
    if (result_.mass > 0) result_.bulkVelocity /= result_.mass;
  }
  void addDeviation(const SeenGrain& grain) {
    const Vec3 own = grain.velocity - result_.bulkVelocity;
    flux_ += grain.mass * own * own.transpose();
    rotation_ += grain.inertia() * grain.angularVelocity.squaredNorm();
  }
  MotionSurvey motion() const {
    MotionSurvey result = result_;
    if (result.mass > 0) {
      result.temperature = flux_.trace() / (3 * result.mass);
      result.rotationTemperature = rotation_ / (3 * result.mass);
    }
    return result;
  }
  /// Σ m (v − V) ⊗ (v − V), J
  const Mat3& flux() const { return flux_; }

 private:
  MotionSurvey result_;
  Mat3 flux_ = Mat3::Zero();
  double rotation_ = 0;
};

struct ForceSums {
  std::vector<double> normal;

  void fill(ContactSurvey& result) const {
    if (normal.empty()) return;
    double sum = 0;
    for (const double force : normal) {
      sum += force;
      result.largestForce = std::max(result.largestForce, force);
    }
    const auto count = static_cast<double>(normal.size());
    result.meanForce = sum / count;
    std::size_t above = 0;
    double carried = 0;
    for (const double force : normal) {
      if (!(force > result.meanForce)) continue;
      ++above;
      carried += force;
    }
    result.shareAboveMean = static_cast<double>(above) / count;
    result.loadAboveMean = sum > 0 ? carried / sum : 0;
  }
};

ContactSurvey surveyContacts(const Instant& instant, const Box& region) {
  ContactSurvey result;
  std::vector<std::size_t> contactsOf(instant.grains.size(), 0);
  ForceSums forces;
  for (const ActingContact& contact : instant.contacts) {
    ++contactsOf[static_cast<std::size_t>(contact.first)];
    if (!contact.withWall()) ++contactsOf[static_cast<std::size_t>(contact.second)];
    if (!region.contains(instant.periods.wrapped(instant.contactPoint(contact)))) continue;
    ++(contact.withWall() ? result.withWalls : result.betweenGrains);
    forces.normal.push_back(contact.normalForce());
  }
  std::size_t grains = 0, ends = 0, endsOfHeld = 0;
  for (std::size_t g = 0; g < instant.grains.size(); ++g) {
    if (!region.contains(instant.grains[g].position)) continue;
    const std::size_t contacts = contactsOf[g];
    ++grains;
    ends += contacts;
    ++result.histogram[std::min(contacts, ContactSurvey::most)];
    if (contacts < 2)
      ++result.rattlers;
    else
      endsOfHeld += contacts;
  }
  if (grains > 0) result.coordination = static_cast<double>(ends) / static_cast<double>(grains);
  if (grains > result.rattlers) result.withoutRattlers = static_cast<double>(endsOfHeld) / static_cast<double>(grains - result.rattlers);
  forces.fill(result);
  return result;
}

/// The cells that an interval meets along one axis: [first, last].
std::array<int, 2> cellsAlong(const Grid& grid, int axis, double low, double high) {
  const double size = grid.size()[axis], start = grid.box.min()[axis];
  const int last = grid.cells[static_cast<std::size_t>(axis)] - 1;
  const auto place = [&](double x) { return static_cast<int>(std::clamp(std::floor((x - start) / size), -1.0, last + 1.0)); };
  // A neighbour more on both sides: whoever is added decides what lies in a cell, to the last bit of its borders.
  return {std::max(0, place(low) - 1), std::min(last, place(high) + 1)};
}

template <class Visit>
void forCells(const Grid& grid, const Box& bounds, Visit&& visit) {
  std::array<std::array<int, 2>, 3> range;
  for (int axis = 0; axis < 3; ++axis)
    range[static_cast<std::size_t>(axis)] = cellsAlong(grid, axis, bounds.min()[axis], bounds.max()[axis]);
  for (int i = range[0][0]; i <= range[0][1]; ++i)
    for (int j = range[1][0]; j <= range[1][1]; ++j)
      for (int k = range[2][0]; k <= range[2][1]; ++k) visit(grid.index(i, j, k), grid.cell(i, j, k));
}

Box boundsOf(const SeenGrain& grain) {
  const Vec3 r = Vec3::Constant(grain.radius);
  return {grain.position - r, grain.position + r};
}

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// The cell of a point: its lower borders belong to it.
std::size_t cellOf(const Grid& grid, const Vec3& x) {
  std::array<int, 3> place{};
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor((x[axis] - grid.box.min()[axis]) / grid.size()[axis]);
    if (!(cell >= 0 && cell < grid.cells[static_cast<std::size_t>(axis)])) return nowhere;
    place[static_cast<std::size_t>(axis)] = static_cast<int>(cell);
  }
  return grid.index(place[0], place[1], place[2]);
}

}  // namespace

Box boxAround(const Instant& instant) {
  Box box;
  for (const SeenGrain& grain : instant.grains) box.extend(boundsOf(grain));
  for (int axis = 0; axis < 3; ++axis) {
    if (box.isEmpty() || !instant.periods.along(axis)) continue;
    box.min()[axis] = instant.periods.low(axis);
    box.max()[axis] = instant.periods.low(axis) + instant.periods.length(axis);
  }
  return box;
}

Survey survey(const Instant& instant, const Box& region) {
  Survey result;
  if (region.isEmpty()) return result;
  result.contacts = surveyContacts(instant, region);
  result.stress.volume = region.volume();

  MotionSums motion;
  double solid = 0;
  for (const SeenGrain& grain : instant.grains) {
    if (region.contains(grain.position)) motion.addToMean(grain);
    forImages(instant.periods, grain.position, grain.radius,
              [&](const Vec3& shift) { solid += volumeWithin(region, grain.position + shift, grain.radius); });
  }
  motion.closeMean();
  for (const SeenGrain& grain : instant.grains)
    if (region.contains(grain.position)) motion.addDeviation(grain);
  for (const ActingContact& contact : instant.contacts) {
    const Vec3& from = instant.grains[static_cast<std::size_t>(contact.first)].position;
    double share = 0;
    forImages(instant.periods, from, contact.branch.norm(),
              [&](const Vec3& shift) { share += shareWithin(region, from + shift, contact.branch); });
    result.stress.contact += share * contact.force * contact.branch.transpose();
  }
  result.motion = motion.motion();
  if (!(result.stress.volume > 0)) return result;
  result.stress.contact /= result.stress.volume;
  result.stress.kinetic = motion.flux() / result.stress.volume;
  result.solidFraction = solid / result.stress.volume;
  return result;
}

std::vector<WallSurvey> surveyWalls(const Instant& instant, std::size_t walls) {
  std::vector<WallSurvey> result(walls);
  for (const ActingContact& contact : instant.contacts) {
    if (!contact.withWall()) continue;
    WallSurvey& wall = result[contact.wall()];
    ++wall.contacts;
    wall.force -= contact.force;
    wall.torque -= instant.contactPoint(contact).cross(contact.force) + contact.moment;
  }
  return result;
}

Box Grid::cell(int i, int j, int k) const {
  // Both borders from whole numbers of cells, so that neighbours have the same and the last is that of the box.
  const auto border = [&](int axis, int place) {
    const int all = cells[static_cast<std::size_t>(axis)];
    return place == all ? box.max()[axis] : box.min()[axis] + box.sizes()[axis] * place / all;
  };
  return {Vec3(border(0, i), border(1, j), border(2, k)), Vec3(border(0, i + 1), border(1, j + 1), border(2, k + 1))};
}

std::vector<CellSurvey> survey(const Instant& instant, const Grid& grid) {
  std::vector<CellSurvey> result(grid.count());
  std::vector<MotionSums> motion(grid.count());
  const double volume = grid.box.volume() / static_cast<double>(grid.count());

  for (const SeenGrain& grain : instant.grains) {
    forImages(instant.periods, grain.position, grain.radius, [&](const Vec3& shift) {
      forCells(grid, boundsOf(grain).translated(shift), [&](std::size_t c, const Box& cell) {
        result[c].solidFraction += volumeWithin(cell, grain.position + shift, grain.radius) / volume;
      });
    });
    if (const std::size_t c = cellOf(grid, grain.position); c != nowhere) motion[c].addToMean(grain);
  }
  for (MotionSums& sums : motion) sums.closeMean();
  for (const SeenGrain& grain : instant.grains)
    if (const std::size_t c = cellOf(grid, grain.position); c != nowhere) motion[c].addDeviation(grain);
  for (const ActingContact& contact : instant.contacts) {
    const Vec3& from = instant.grains[static_cast<std::size_t>(contact.first)].position;
    forImages(instant.periods, from, contact.branch.norm(), [&](const Vec3& shift) {
      Box way(Vec3(from + shift));
      way.extend(Vec3(from + shift - contact.branch));
      forCells(grid, way, [&](std::size_t c, const Box& cell) {
        result[c].stress.contact += shareWithin(cell, from + shift, contact.branch) / volume * contact.force * contact.branch.transpose();
      });
    });
  }
  for (std::size_t c = 0; c < result.size(); ++c) {
    result[c].motion = motion[c].motion();
    result[c].stress.volume = volume;
    result[c].stress.kinetic = motion[c].flux() / volume;
  }
  return result;
}

}  // namespace tsubu::sim
