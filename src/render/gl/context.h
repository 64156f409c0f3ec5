#pragma once
// Where OpenGL comes from. This is the only class that knows OSMesa; an EGL sibling (surfaceless platform) would offer the same three
// members. Everything is drawn into framebuffer objects, so the context's own buffer is one pixel.

#include <memory>
#include <string>

#include "render/gl/functions.h"

namespace tsubu::render {

class Context {
 public:
  /// Makes an OpenGL 4.5 core context and makes it current in this thread. Sets GALLIUM_OVERRIDE_CPU_CAPS=sse4.1 when the environment
  /// does not: without fused multiply-add and wide vectors llvmpipe gives the same bytes on every x86-64 processor.
  /// Throws Error(simulation) with what the driver offered instead.
  Context();
  ~Context();
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;

  /// Makes the context current in the calling thread.
  void makeCurrent();
  const GlFunctions& gl() const;
  /// Renderer and versions: pictures with the same description can be expected to have the same bytes.
  const std::string& description() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tsubu::render
