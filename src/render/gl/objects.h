#pragma once
// OpenGL objects with owners. All of them belong to the context they were made in and must go before it.

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "render/gl/functions.h"

namespace tsubu::render {

/// The name of an OpenGL object, deleted by `Delete` of its function table.
template <auto Delete>
class GlName {
 public:
  GlName() = default;
  GlName(const GlFunctions& gl, GLuint name) : gl_(&gl), name_(name) {}
  ~GlName() {
    if (gl_ && name_) (gl_->*Delete)(1, &name_);
  }
  GlName(GlName&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }

  const GlFunctions& gl() const { return *gl_; }
  GLuint name() const { return name_; }

 private:
  const GlFunctions* gl_ = nullptr;
  GLuint name_ = 0;
};

/// A two-dimensional texture with one level, nearest filtering and clamped edges.
class Texture : public GlName<&GlFunctions::DeleteTextures> {
 public:
  Texture() = default;
  Texture(const GlFunctions& gl, GLenum format, int width, int height);
};

/// A colour and a depth texture to draw into; either may be missing (null).
class Framebuffer : public GlName<&GlFunctions::DeleteFramebuffers> {
 public:
  Framebuffer() = default;
  Framebuffer(const GlFunctions& gl, const Texture* colour, const Texture* depth);
};

/// An array of four-vectors of floats that shaders read by index (samplerBuffer), refilled every frame.
class FloatArray {
 public:
  FloatArray() = default;
  explicit FloatArray(const GlFunctions& gl);

  /// Replaces the contents; the number of floats is a multiple of four.
  void fill(const std::vector<float>& values);
  GLuint texture() const { return texture_.name(); }

 private:
  GlName<&GlFunctions::DeleteBuffers> buffer_;
  GlName<&GlFunctions::DeleteTextures> texture_;
};

/// Draws without vertex attributes: vertex shaders look their data up by gl_VertexID.
class Geometry {
 public:
  Geometry() = default;
  explicit Geometry(const GlFunctions& gl);

  /// 3·count vertices, numbered as they come.
  void drawTriangles(std::size_t count) const;
  /// Four vertices a quad: 4k, 4k+1, 4k+2, 4k+3 are the corners (low, low), (high, low), (low, high), (high, high) of quad k.
  void drawQuads(std::size_t count);
  /// One triangle that covers the viewport.
  void drawScreen() const { drawTriangles(1); }

 private:
  GlName<&GlFunctions::DeleteVertexArrays> array_;
  GlName<&GlFunctions::DeleteBuffers> indices_;
  std::size_t quads_ = 0;
};

/// A vertex and a fragment shader, from the sources that the build embedded (see shader_source.h).
class Program {
 public:
  Program() = default;
  /// `defines` become "#define" lines. Throws Error(simulation) with the compiler's words.
  Program(const GlFunctions& gl, std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines = {});
  ~Program();
  Program(Program&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(name_, other.name_);
    return *this;
  }

  void use() const { gl_->UseProgram(name_); }
  void set(const char* name, int value) const { gl_->ProgramUniform1i(name_, at(name), value); }
  void set(const char* name, double value) const { gl_->ProgramUniform1f(name_, at(name), static_cast<float>(value)); }
  void set(const char* name, double x, double y) const;
  void set(const char* name, const Vec3& value) const;
  void set(const char* name, const Eigen::Vector4d& value) const;
  /// Binds a texture to the unit and the sampler to the unit.
  void bind(const char* sampler, int unit, GLuint texture) const;

 private:
  GLint at(const char* name) const { return gl_->GetUniformLocation(name_, name); }

  const GlFunctions* gl_ = nullptr;
  GLuint name_ = 0;
};

}  // namespace tsubu::render
