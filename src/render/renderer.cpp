#include "render/renderer.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include "core/error.h"
#include "render/check.h"
#include "render/colour_map.h"
#include "render/frame_bars.h"
#include "render/overlay.h"
#include "render/painter.h"

namespace tsubu::render {

namespace {

/// The snapshot with grains as they are drawn.
Snapshot shownOf(const Snapshot& snapshot, const Grains& style) {
  Snapshot shown = snapshot;
  for (double& radius : shown.radius) radius *= style.shown ? style.scale : 0;  // what has no radius is not drawn
  return shown;
}

}  // namespace

class Renderer::Impl {
 public:
  Impl(Style style, std::vector<VisibleWall> walls, const Box& bounds) : style_(std::move(style)), bounds_(bounds) {
    checkStyle(style_);
    std::map<std::tuple<Colour, bool>, int> numbers;
    for (const VisibleWall& wall : walls) {
      const auto [at, isNew] = numbers.try_emplace({wall.look.colour, wall.look.ground}, static_cast<int>(numbers.size()));
      if (isNew) looks_.push_back(wall.look);
      walls_.push_back({WallModel(wall.mesh), wall.look, at->second});
    }
    if (style_.bonds.shown) first_.bonds = addLooks(looksOfBonds(style_.bonds));
    if (style_.forces.which != ShownForces::none) first_.forces = addLooks(looksOfBars(style_.forces.map));
    if (looks_.size() > Painter::mostLooks) {
      throw Error(ErrorKind::scene, "The walls have more different colours than the renderer can tell apart (2048).");
    }
    painter_ = std::make_unique<Painter>(style_, looks_, samplesAlongSide(style_.picture.quality));
  }

  Image draw(const Snapshot& snapshot) {
    const bool asIs = style_.grains.shown && style_.grains.scale == 1;
    const Frame frame = makeFrame(asIs ? snapshot : shownOf(snapshot, style_.grains), style_, walls_, bounds_, painter_->side(),
                                  painter_->shadowSize(), first_);
    Image image = painter_->paint(frame, upOf(style_.camera, snapshot.time));
    drawOverlay(image, style_, snapshot.time, frame.legend);
    return image;
  }

  const Style& style() const { return style_; }
  const std::string& description() const { return painter_->description(); }

 private:
  int addLooks(const std::vector<WallLook>& more) {
    const auto first = static_cast<int>(looks_.size());
    looks_.insert(looks_.end(), more.begin(), more.end());
    return first;
  }

  Style style_;
  Box bounds_;
  std::vector<Wall> walls_;
  std::vector<WallLook> looks_;
  FirstLooks first_;
  std::unique_ptr<Painter> painter_;
};

Renderer::Renderer(Style style, std::vector<VisibleWall> walls, Box bounds)
    : impl_(std::make_unique<Impl>(std::move(style), std::move(walls), bounds)) {}
void setDrawingHelpers(int threads) { setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0); }

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::draw(const Snapshot& snapshot) { return impl_->draw(snapshot); }
const Style& Renderer::style() const { return impl_->style(); }
std::string Renderer::description() const { return impl_->description(); }

}  // namespace tsubu::render
