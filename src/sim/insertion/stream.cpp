#include "sim/insertion/stream.h"

#include <algorithm>
#include <numbers>

namespace tsubu::sim {

namespace {

constexpr std::uint64_t streamWord = 0x73747265616dULL;  // "stream": keeps these numbers apart from all others of the seed
// Places tried for a grain before it waits for the next step. In a region that is half full about one in ten succeeds.
constexpr int attemptsPerStep = 50;

// Is one more grain due after `done` (grains or kg), when `promised` is the rate times the time? The margin absorbs the rounding
// of rate × time, so that 200 grains/s for 2 s are 400 and not 401.
bool isDue(double done, double promised) { return done < promised * (1 - 1e-12); }

bool apartFrom(const std::vector<Grain>& grains, std::size_t first, const Vec3& centre, double radius) {
  return std::none_of(grains.begin() + static_cast<std::ptrdiff_t>(first), grains.end(), [&](const Grain& g) {
    const double reach = g.radius + radius;
    return (g.position - centre).squaredNorm() < reach * reach;
  });
}

}  // namespace

void Stream::emit(std::uint64_t seed, std::size_t index, double density, double time, const IsFree& isFree, StreamProgress& progress,
                  std::vector<Grain>& grains) const {
  const double elapsed = std::min(time, end) - start;
  if (!(elapsed > 0)) return;
  const std::size_t first = grains.size();
  const std::uint64_t key = mix64(streamWord + index);
  while (progress.emitted < count && (kilogramsPerSecond > 0 ? isDue(progress.emittedMass, kilogramsPerSecond * elapsed)
                                                             : isDue(static_cast<double>(progress.emitted), grainsPerSecond * elapsed))) {
    Random ofGrain(seed, key, progress.emitted);
    Grain grain;
    grain.radius = radii.draw(ofGrain);
    grain.velocity = spreadAround(velocity, velocitySpread, ofGrain);
    grain.angularVelocity = angularVelocity;
    grain.orientation = randomRotation(ofGrain);
    grain.material = material;
    grain.temperature = temperature;

    bool placed = false;
    for (int i = 0; i < attemptsPerStep && !placed; ++i) {
      Random ofPlace(seed, mix64(key + progress.emitted), progress.attempts++);
      grain.position = region.randomPlace(grain.radius, ofPlace);
      placed = apartFrom(grains, first, grain.position, grain.radius) && isFree(grain.position, grain.radius);
    }
    if (!placed) return;
    ++progress.emitted;
    progress.emittedMass += density * (4.0 / 3.0 * std::numbers::pi) * grain.radius * grain.radius * grain.radius;
    progress.attempts = 0;
    grains.push_back(grain);
  }
}

}  // namespace tsubu::sim
