#include "render/painter.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "render/colour_map.h"

namespace tsubu::render {

namespace {

/// A sharp shadow of a grain needs a few texels across it; more than this costs more than it shows.
int shadowTexels(const Picture& picture) {
  const int wanted = picture.quality == Quality::draft ? 1024 : 2048;
  return picture.height <= 240 ? std::min(wanted, 1024) : wanted;
}

constexpr int coarseSize = 256;        // texels along the side of the map that finds penumbras
constexpr double widestPenumbra = 20;  // texels of the fine map: `widest` of shadow.glsl

Program resolver(const GlFunctions& gl, int side, int shows) {
  return Program(gl, "screen.vert", "resolve.frag", {fmt::format("SIDE {}", side), fmt::format("SHOWS {}", shows)});
}

Vec3 encodedColour(Colour c) { return Vec3(c.red, c.green, c.blue) / 255.0; }

}  // namespace

Painter::Painter(const Style& style, const std::vector<WallLook>& looks, int side)
    : style_(style),
      side_(side),
      width_(style.picture.width * side),
      height_(style.picture.height * side),
      shadowSize_(shadowTexels(style.picture)),
      gl_(context_.gl()),
      geometry_(gl_),
      grainProgram_(gl_, "grain.vert", "grain.frag"),
      wallProgram_(gl_, "wall.vert", "wall.frag"),
      occlusionProgram_(gl_, "occlusion.vert", "occlusion.frag", {fmt::format("SIDE {}", side)}),
      sheetProgram_(gl_, "sheet.vert", "sheet.frag"),
      shadowDiscProgram_(gl_, "shadow_disc.vert", "shadow_disc.frag"),
      shadowWallProgram_(gl_, "shadow_wall.vert", "shadow_wall.frag"),
      classifyProgram_(gl_, "screen.vert", "classify.frag", {fmt::format("SIDE {}", side)}),
      resolvePrograms_{resolver(gl_, side, 0), resolver(gl_, side, 1), resolver(gl_, side, 2)},
      grains_(gl_),
      neighbours_(gl_),
      surroundings_(gl_),
      walls_(gl_),
      sheets_(gl_),
      sunDiscs_(gl_),
      sunWalls_(gl_),
      looks_(gl_),
      names_(gl_, GL_R32UI, width_, height_),
      depths_(gl_, GL_DEPTH_COMPONENT32F, width_, height_),
      wallShares_(gl_, GL_R8, style.picture.width, style.picture.height),
      sheetColours_(gl_, GL_RGBA8, width_, height_),
      shadowMap_(gl_, GL_DEPTH_COMPONENT32F, shadowSize_, shadowSize_),
      coarseMap_(gl_, GL_DEPTH_COMPONENT32F, coarseSize, coarseSize),
      classes_(gl_, GL_DEPTH_COMPONENT32F, style.picture.width, style.picture.height),
      colours_(gl_, GL_RGBA8, style.picture.width, style.picture.height),
      namesTarget_(gl_, &names_, &depths_),
      wallSharesTarget_(gl_, &wallShares_, nullptr),
      sheetsTarget_(gl_, &sheetColours_, &depths_),
      shadowTarget_(gl_, nullptr, &shadowMap_),
      coarseTarget_(gl_, nullptr, &coarseMap_),
      coloursTarget_(gl_, &colours_, &classes_) {
  std::vector<float> texels;
  for (const WallLook& look : looks) {
    const Vec3 light = toLinear(look.colour);
    append(texels, light.x(), light.y(), light.z(), look.ground ? 1 : 0);
  }
  looks_.fill(texels);
  // Window rows from top to bottom, as Image has them; depths from 0 to 1, for a depth that is exact far away.
  gl_.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl_.Enable(GL_DEPTH_CLAMP);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
}

Painter::~Painter() {
  // The members delete their OpenGL objects, which must not be those of another context that happens to be current.
  try {
    context_.makeCurrent();
  } catch (...) {
    // Then there is nothing to delete them in.
  }
}

Image Painter::paint(const Frame& frame, const Vec3& up) {
  context_.makeCurrent();
  upload(frame);
  if (style_.light.shadows) drawShadowMap(frame);
  drawNames(frame);
  drawWallShares(frame);
  if (frame.sheetTriangles > 0) drawSheets(frame);
  resolve(frame, up);
  return read();
}

void Painter::upload(const Frame& frame) {
  grains_.fill(frame.grains);
  neighbours_.fill(frame.neighbours);
  surroundings_.fill(frame.surroundings);
  walls_.fill(frame.walls);
  sheets_.fill(frame.sheets);
  sunDiscs_.fill(frame.sunDiscs);
  sunWalls_.fill(frame.sunWalls);
}

void Painter::setView(const Program& program, const Frame& frame) const {
  const View& view = frame.view;
  program.set("rays", Eigen::Vector4d(2 * view.tanX / width_, -2 * view.tanY / height_, -view.tanX, view.tanY));
  program.set("nearPlane", frame.nearPlane);
}

void Painter::drawShadowMap(const Frame& frame) {
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_LESS);
  drawShadows(frame, shadowTarget_, shadowSize_, {{0, 0}}, 0);
  if (side_ == 1) return;  // drafts have hard shadows
  // What may touch a penumbra: everything, widened by the widest of them and by a texel.
  const double margin = 2 * widestPenumbra / shadowSize_ + 2.0 / coarseSize;
  drawShadows(frame, coarseTarget_, coarseSize, {{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}, margin);
}

void Painter::drawShadows(const Frame& frame, const Framebuffer& target, int size, const std::vector<Eigen::Vector2d>& shifts,
                          double margin) {
  const float farthest = 1;
  gl_.ClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &farthest);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  gl_.Viewport(0, 0, size, size);
  shadowDiscProgram_.use();
  shadowDiscProgram_.bind("discs", 0, sunDiscs_.texture());
  shadowDiscProgram_.set("margin", margin, margin);
  geometry_.drawQuads(frame.sunDiscCount);
  // A wall must not shade itself: it is drawn a little farther from the sun, the more the steeper.
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(2, 4);
  shadowWallProgram_.use();
  shadowWallProgram_.bind("walls", 0, sunWalls_.texture());
  for (const Eigen::Vector2d& shift : shifts) {
    shadowWallProgram_.set("shift", shift.x() * margin, shift.y() * margin);
    geometry_.drawTriangles(frame.sunWallTriangles);
  }
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void Painter::drawNames(const Frame& frame) {
  const GLuint nothing[4] = {};
  const float infinity = 0;
  gl_.ClearNamedFramebufferuiv(namesTarget_.name(), GL_COLOR, 0, nothing);
  gl_.ClearNamedFramebufferfv(namesTarget_.name(), GL_DEPTH, 0, &infinity);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, namesTarget_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_GREATER);
  wallProgram_.use();
  wallProgram_.bind("walls", 0, walls_.texture());
  wallProgram_.set("openings", frame.view.tanX, frame.view.tanY);
  wallProgram_.set("nearPlane", frame.nearPlane);
  geometry_.drawTriangles(frame.wallTriangles);
  grainProgram_.use();
  setView(grainProgram_, frame);
  grainProgram_.bind("grains", 0, grains_.texture());
  geometry_.drawQuads(frame.grainCount);
}

void Painter::drawWallShares(const Frame& frame) {
  const float all[4] = {1, 1, 1, 1};
  gl_.ClearNamedFramebufferfv(wallSharesTarget_.name(), GL_COLOR, 0, all);
  if (frame.surroundingCount == 0) return;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, wallSharesTarget_.name());
  gl_.Viewport(0, 0, style_.picture.width, style_.picture.height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_ZERO, GL_SRC_COLOR);
  occlusionProgram_.use();
  setView(occlusionProgram_, frame);
  occlusionProgram_.bind("surroundings", 0, surroundings_.texture());
  occlusionProgram_.bind("names", 1, names_.name());
  occlusionProgram_.bind("depths", 2, depths_.name());
  geometry_.drawQuads(frame.surroundingCount);
}

void Painter::drawSheets(const Frame& frame) {
  const float clear[4] = {};
  gl_.ClearNamedFramebufferfv(sheetsTarget_.name(), GL_COLOR, 0, clear);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, sheetsTarget_.name());
  gl_.Viewport(0, 0, width_, height_);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_FALSE);
  gl_.DepthFunc(GL_GREATER);
  gl_.Enable(GL_BLEND);
  gl_.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  sheetProgram_.use();
  setView(sheetProgram_, frame);
  sheetProgram_.set("sun", Vec3(frame.view.rotation * style_.light.from.normalized()));
  sheetProgram_.bind("sheets", 0, sheets_.texture());
  geometry_.drawTriangles(frame.sheetTriangles);
  gl_.DepthMask(GL_TRUE);
}

void Painter::resolve(const Frame& frame, const Vec3& up) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, coloursTarget_.name());
  gl_.Viewport(0, 0, style_.picture.width, style_.picture.height);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.DepthFunc(GL_ALWAYS);
  classifyProgram_.use();
  classifyProgram_.set("depth", 0.0);
  classifyProgram_.bind("names", 0, names_.name());
  geometry_.drawScreen();
  gl_.DepthMask(GL_FALSE);
  gl_.DepthFunc(GL_EQUAL);
  for (std::size_t shows = 0; shows < resolvePrograms_.size(); ++shows) {
    const Program& program = resolvePrograms_[shows];
    program.use();
    program.set("depth", 0.25 * static_cast<double>(shows + 1));  // as in classify.frag
    setScene(program, frame, up);
    geometry_.drawScreen();
  }
  gl_.DepthMask(GL_TRUE);
}

void Painter::setScene(const Program& p, const Frame& frame, const Vec3& up) const {
  setView(p, frame);
  p.bind("grains", 0, grains_.texture());
  p.bind("neighbours", 1, neighbours_.texture());
  p.bind("looks", 2, looks_.texture());
  p.bind("names", 3, names_.name());
  p.bind("depths", 4, depths_.name());
  p.bind("wallShares", 5, wallShares_.name());
  p.bind("sheets", 6, sheetColours_.name());
  p.bind("shadowMap", 7, shadowMap_.name());
  p.bind("coarseMap", 8, coarseMap_.name());
  p.set("hasSheets", frame.sheetTriangles > 0 ? 1 : 0);
  p.set("pictureSize", style_.picture.width, style_.picture.height);
  p.set("skyTop", encodedColour(style_.background.top));
  p.set("skyBottom", encodedColour(style_.background.bottom));
  p.set("up", Vec3(frame.view.rotation * up));
  p.set("sun", Vec3(frame.view.rotation * style_.light.from.normalized()));
  p.set("sunStrength", style_.light.sun);
  p.set("skyStrength", style_.light.sky);
  p.set("shadowStrength", style_.light.shadows ? style_.light.shadowStrength : 0.0);
  p.set("occlusionStrength", style_.light.ambientOcclusion ? style_.light.occlusionStrength : 0.0);
  p.set("focus", frame.view.distance);
  // From the frame of the eye to the shadow map: x and y to texture coordinates (rows from the top), z to depth.
  const SunView& sun = frame.sun;
  p.set("shadowOffset", 3 * std::max(sun.half.x(), sun.half.y()) / shadowSize_);
  const Vec3 texel = 2 * sun.half / shadowSize_;
  p.set("penumbra", style_.light.softness * 2 * sun.half.z() / texel.x(), style_.light.softness * 2 * sun.half.z() / texel.y());
  const Mat3 turn = sun.rotation * frame.view.rotation.transpose();
  const Vec3 origin = sun.rotation * frame.view.eye - sun.centre;
  const Vec3 scale(0.5 / sun.half.x(), -0.5 / sun.half.y(), -0.5 / sun.half.z());
  const char* const rows[] = {"sunX", "sunY", "sunZ"};
  for (int k = 0; k < 3; ++k) {
    const Vec3 row = scale[k] * turn.row(k).transpose();
    p.set(rows[k], Eigen::Vector4d(row.x(), row.y(), row.z(), 0.5 + scale[k] * origin[k]));
  }
}

Image Painter::read() const {
  Image image(style_.picture.width, style_.picture.height);
  std::vector<std::uint8_t> rgba(image.rgb.size() / 3 * 4);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, coloursTarget_.name());
  gl_.ReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  if (const GLenum error = gl_.GetError(); error != GL_NO_ERROR) {
    throw Error(ErrorKind::simulation, fmt::format("The driver failed to draw a picture (OpenGL error {:#x}).", error),
                error == GL_OUT_OF_MEMORY ? "there is not enough memory for pictures of this size and quality" : "");
  }
  for (std::size_t from = 0, to = 0; from < rgba.size(); from += 4, to += 3) {
    std::copy_n(&rgba[from], 3, &image.rgb[to]);
  }
  return image;
}

}  // namespace tsubu::render
