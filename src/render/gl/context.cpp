#include "render/gl/context.h"

#include <GL/osmesa.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>

#include "core/error.h"

namespace tsubu::render {

struct Context::State {
  OSMesaContext context = nullptr;
  std::uint32_t pixel = 0;  // the buffer that OSMesa insists on and nobody draws to
  GlFunctions gl;
  std::string description;

  ~State() {
    if (!context) return;
    if (OSMesaGetCurrentContext() == context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
    OSMesaDestroyContext(context);
  }
};

namespace {

std::string textOf(const GlFunctions& gl, GLenum name) {
  const auto* text = gl.GetString(name);
  return text ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

Context::Context() : state_(std::make_unique<State>()) {
  setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1", 0);
  const int attributes[] = {
      OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE, OSMESA_CONTEXT_MAJOR_VERSION, 4, OSMESA_CONTEXT_MINOR_VERSION, 5, 0};
  state_->context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!state_->context) {
    throw Error(ErrorKind::simulation, "OSMesa cannot make an OpenGL 4.5 core context, so no picture can be drawn.",
                "install libosmesa6 22.3 or newer (built with llvmpipe), or run with --no-frames");
  }
  makeCurrent();
  GlFunctions& gl = state_->gl;
  // OSMesa answers every name that begins with gl with some pointer, so a version is asked for and not the pointers.
  gl = loadGlFunctions([](const char* name) { return OSMesaGetProcAddress(name); });
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45) {
    throw Error(ErrorKind::simulation,
                fmt::format("OpenGL 4.5 is needed to draw, but {} offers {}.", textOf(gl, GL_RENDERER), textOf(gl, GL_VERSION)),
                "install libosmesa6 22.3 or newer (built with llvmpipe), or run with --no-frames");
  }
  state_->description = fmt::format("OSMesa, {}, OpenGL {}", textOf(gl, GL_RENDERER), textOf(gl, GL_VERSION));
}

Context::~Context() = default;
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;

void Context::makeCurrent() {
  if (!OSMesaMakeCurrent(state_->context, &state_->pixel, GL_UNSIGNED_BYTE, 1, 1)) {
    throw Error(ErrorKind::simulation, "The OpenGL context for drawing cannot be made current in this thread.");
  }
}

const GlFunctions& Context::gl() const { return state_->gl; }
const std::string& Context::description() const { return state_->description; }

}  // namespace tsubu::render
