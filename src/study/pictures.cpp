#include "study/pictures.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "render/renderer.h"
#include "scene/build.h"

namespace tsubu::study {

namespace {

// s: of the whole program, since a drawing has threads of its own.
double cpuTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k) sum += std::pow((a.rgb[k] - b.rgb[k]) / 255.0, 2);
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

std::optional<std::vector<Snapshot>> instantsOf(sim::Model model, std::uint64_t steps, const Stop& stop) {
  constexpr std::uint64_t instants = 3, portion = 100;
  sim::Simulation simulation(std::move(model), 1);
  std::vector<Snapshot> seen;
  for (std::uint64_t k = 0; k < instants; ++k) {
    const std::uint64_t until = steps * k / (instants - 1);
    while (simulation.steps() < until) {
      if (stop && stop()) return std::nullopt;
      simulation.advance(std::min(until - simulation.steps(), portion));
    }
    simulation.fill(seen.emplace_back());
  }
  return seen;
}

}  // namespace

std::optional<std::vector<PictureQuality>> comparePictures(const Trial& trial, const Stop& stop) {
  scene::Overrides overrides = trial.overrides;
  overrides.emplace_back("simulation.limit=packing");  // pictures are of three steps of one length
  const scene::Scene scene = scene::read(trial.scene, overrides);
  scene::Built built = scene::build(scene);
  const auto seen = instantsOf(std::move(built.model), built.plan.steps, stop);
  if (!seen) return std::nullopt;
  std::vector<PictureQuality> qualities;
  std::vector<Image> finest;
  for (auto word = render::qualityWords.rbegin(); word != render::qualityWords.rend(); ++word) {
    render::Style style = built.style;
    style.picture.quality = word->value;
    render::Renderer renderer(style, built.walls, built.bounds);
    renderer.draw(seen->front());  // what is made once belongs to no frame
    PictureQuality made{std::string(word->text), 0, 0};
    for (std::size_t k = 0; k < seen->size(); ++k) {
      const double start = cpuTime();
      Image image = renderer.draw((*seen)[k]);
      made.cost += (cpuTime() - start) / static_cast<double>(seen->size());
      if (word == render::qualityWords.rbegin())
        finest.push_back(std::move(image));
      else
        made.error = std::max(made.error, difference(image, finest[k]));
    }
    qualities.push_back(made);
  }
  return qualities;
}

}  // namespace tsubu::study
