#pragma once
// Snapshots to pictures, off screen.

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/mesh.h"
#include "core/snapshot.h"
#include "render/style.h"

namespace tsubu::render {

/// A wall that may be seen: its mesh in its own frame, and its look. Where it is comes with each snapshot.
struct VisibleWall {
  TriangleMesh mesh;
  WallLook look;
};

/// Draws snapshots. A picture depends on the style, the walls, the bounds and the snapshot, never on the pictures drawn before, on the
/// number of threads or on the vector units of the processor. One renderer serves one thread at a time.
class Renderer {
 public:
  /// `walls` in the order of `Snapshot::walls` (a wall without a pose there stands at the origin). `bounds` is the part of the world
  /// that matters: automatic cameras frame it and shadows are computed in it; when empty, it is taken from the grains of each snapshot.
  /// Throws Error(scene) when the style is out of range and Error(simulation) when no drawing context can be made.
  Renderer(Style style, std::vector<VisibleWall> walls, Box bounds = Box());
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// A picture of `style().picture` size. Grains whose position or radius is not a finite number are left out.
  Image draw(const Snapshot& snapshot);

  const Style& style() const;

  /// What draws, for instance "OSMesa, llvmpipe (LLVM 15.0.6, 128 bits), OpenGL 4.5 (Core Profile) Mesa 22.3.6". Pictures with equal
  /// descriptions can be compared byte by byte.
  std::string description() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Lets so many threads help those that draw, in the whole program; to be called before there is a Renderer. llvmpipe would take as many as
/// there are cores, and a simulation waits for whichever of its threads they push aside. The environment's LP_NUM_THREADS has precedence.
void setDrawingHelpers(int threads);

}  // namespace tsubu::render
