#include "render/gl/objects.h"

#include <fmt/format.h>

#include <cstdint>

#include "core/error.h"
#include "render/gl/shader_source.h"

namespace tsubu::render {

namespace {

template <class Create, class... Arguments>
GLuint created(Create create, Arguments... arguments) {
  GLuint name = 0;
  create(arguments..., 1, &name);
  return name;
}

GLuint compiled(const GlFunctions& gl, GLenum stage, std::string_view file, const std::vector<std::string>& defines) {
  const std::string source = shaderSource(file, defines);
  const char* text = source.c_str();
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  char log[2048] = "";
  gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
  gl.DeleteShader(shader);
  throw Error(ErrorKind::simulation, fmt::format("The driver does not compile the shader {}: {}", file, log));
}

}  // namespace

Texture::Texture(const GlFunctions& gl, GLenum format, int width, int height) : GlName(gl, created(gl.CreateTextures, GL_TEXTURE_2D)) {
  gl.TextureStorage2D(name(), 1, format, width, height);
  gl.TextureParameteri(name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TextureParameteri(name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Framebuffer::Framebuffer(const GlFunctions& gl, const Texture* colour, const Texture* depth) : GlName(gl, created(gl.CreateFramebuffers)) {
  if (colour) gl.NamedFramebufferTexture(name(), GL_COLOR_ATTACHMENT0, colour->name(), 0);
  if (depth) gl.NamedFramebufferTexture(name(), GL_DEPTH_ATTACHMENT, depth->name(), 0);
  gl.NamedFramebufferDrawBuffer(name(), colour ? GL_COLOR_ATTACHMENT0 : GL_NONE);
  const GLenum status = gl.CheckNamedFramebufferStatus(name(), GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw Error(ErrorKind::simulation, fmt::format("The driver refuses a framebuffer that the renderer needs (status {:#x}).", status));
  }
}

FloatArray::FloatArray(const GlFunctions& gl)
    : buffer_(gl, created(gl.CreateBuffers)), texture_(gl, created(gl.CreateTextures, GL_TEXTURE_BUFFER)) {}

void FloatArray::fill(const std::vector<float>& values) {
  const GlFunctions& gl = buffer_.gl();
  const float nothing[4] = {};  // an empty buffer cannot be attached
  const bool empty = values.empty();
  gl.NamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(empty ? sizeof nothing : values.size() * sizeof(float)),
                     empty ? nothing : values.data(), GL_STREAM_DRAW);
  gl.TextureBuffer(texture_.name(), GL_RGBA32F, buffer_.name());
}

Geometry::Geometry(const GlFunctions& gl) : array_(gl, created(gl.CreateVertexArrays)), indices_(gl, created(gl.CreateBuffers)) {}

void Geometry::drawTriangles(std::size_t count) const {
  if (count == 0) return;
  const GlFunctions& gl = array_.gl();
  gl.BindVertexArray(array_.name());
  gl.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * count));
}

void Geometry::drawQuads(std::size_t count) {
  if (count == 0) return;
  const GlFunctions& gl = array_.gl();
  if (count > quads_) {
    quads_ = count + count / 2;
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * quads_);
    for (std::uint32_t first = 0; first < 4 * quads_; first += 4) {
      for (const std::uint32_t corner : {0u, 1u, 2u, 2u, 1u, 3u}) indices.push_back(first + corner);
    }
    gl.NamedBufferData(indices_.name(), static_cast<GLsizeiptr>(indices.size() * sizeof indices[0]), indices.data(), GL_STATIC_DRAW);
    gl.VertexArrayElementBuffer(array_.name(), indices_.name());
  }
  gl.BindVertexArray(array_.name());
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * count), GL_UNSIGNED_INT, nullptr);
}

Program::Program(const GlFunctions& gl, std::string_view vertex, std::string_view fragment, const std::vector<std::string>& defines)
    : gl_(&gl), name_(gl.CreateProgram()) {
  const GLuint stages[] = {compiled(gl, GL_VERTEX_SHADER, vertex, defines), compiled(gl, GL_FRAGMENT_SHADER, fragment, defines)};
  for (const GLuint stage : stages) gl.AttachShader(name_, stage);
  gl.LinkProgram(name_);
  for (const GLuint stage : stages) gl.DeleteShader(stage);
  GLint good = 0;
  gl.GetProgramiv(name_, GL_LINK_STATUS, &good);
  if (good) return;
  char log[2048] = "";
  gl.GetProgramInfoLog(name_, sizeof log, nullptr, log);
  throw Error(ErrorKind::simulation, fmt::format("The driver does not link the shaders {} and {}: {}", vertex, fragment, log));
}

Program::~Program() {
  if (gl_ && name_) gl_->DeleteProgram(name_);
}

void Program::set(const char* name, double x, double y) const {
  gl_->ProgramUniform2f(name_, at(name), static_cast<float>(x), static_cast<float>(y));
}

void Program::set(const char* name, const Vec3& value) const {
  const Eigen::Vector3f v = value.cast<float>();
  gl_->ProgramUniform3f(name_, at(name), v.x(), v.y(), v.z());
}

void Program::set(const char* name, const Eigen::Vector4d& value) const {
  const Eigen::Vector4f v = value.cast<float>();
  gl_->ProgramUniform4f(name_, at(name), v.x(), v.y(), v.z(), v.w());
}

void Program::bind(const char* sampler, int unit, GLuint texture) const {
  gl_->BindTextureUnit(static_cast<GLuint>(unit), texture);
  set(sampler, unit);
}

}  // namespace tsubu::render
