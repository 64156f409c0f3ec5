#pragma once
// The passes that make a picture of a frame, in their order. All of OpenGL is below this line.

#include <array>
#include <string>
#include <vector>

#include "core/image.h"
#include "render/frame.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/style.h"

namespace tsubu::render {

class Painter {
 public:
  static constexpr std::size_t mostLooks = 2048;  ///< as names.glsl has bits for

  /// `side`: samples along the side of a pixel.
  Painter(const Style& style, const std::vector<WallLook>& looks, int side);
  ~Painter();

  /// `up`: the unit vector, in the world, where the sky is brightest.
  Image paint(const Frame& frame, const Vec3& up);

  int side() const { return side_; }
  int shadowSize() const { return shadowSize_; }
  const std::string& description() const { return context_.description(); }

 private:
  void upload(const Frame& frame);
  void setView(const Program& program, const Frame& frame) const;
  void drawShadowMap(const Frame& frame);
  void drawShadows(const Frame& frame, const Framebuffer& target, int size, const std::vector<Eigen::Vector2d>& shifts, double margin);
  void drawNames(const Frame& frame);
  void drawWallShares(const Frame& frame);
  void drawSheets(const Frame& frame);
  void resolve(const Frame& frame, const Vec3& up);
  void setScene(const Program& program, const Frame& frame, const Vec3& up) const;
  Image read() const;

  Style style_;
  int side_, width_, height_, shadowSize_;

  Context context_;
  const GlFunctions& gl_;
  Geometry geometry_;
  Program grainProgram_, wallProgram_, occlusionProgram_, sheetProgram_, shadowDiscProgram_, shadowWallProgram_, classifyProgram_;
  std::array<Program, 3> resolvePrograms_;  ///< for pixels that show nothing, walls, grains
  FloatArray grains_, neighbours_, surroundings_, walls_, sheets_, sunDiscs_, sunWalls_, looks_;
  Texture names_, depths_, wallShares_, sheetColours_, shadowMap_, coarseMap_, classes_, colours_;
  Framebuffer namesTarget_, wallSharesTarget_, sheetsTarget_, shadowTarget_, coarseTarget_, coloursTarget_;
};

}  // namespace tsubu::render
