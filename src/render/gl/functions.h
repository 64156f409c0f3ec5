#pragma once
// The OpenGL functions that tsubu calls, loaded from the context that draws: nothing links libGL.

#include <GL/glcorearb.h>

// X(the name in the type PFNGL…PROC, the name without gl)
#define TSUBU_GL_FUNCTIONS(X) \
  X(ATTACHSHADER, AttachShader) \
  X(BINDFRAMEBUFFER, BindFramebuffer) \
  X(BINDTEXTUREUNIT, BindTextureUnit) \
  X(BINDVERTEXARRAY, BindVertexArray) \
  X(BLENDFUNC, BlendFunc) \
  X(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus) \
  X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv) \
  X(CLEARNAMEDFRAMEBUFFERUIV, ClearNamedFramebufferuiv) \
  X(CLIPCONTROL, ClipControl) \
  X(COMPILESHADER, CompileShader) \
  X(CREATEBUFFERS, CreateBuffers) \
  X(CREATEFRAMEBUFFERS, CreateFramebuffers) \
  X(CREATEPROGRAM, CreateProgram) \
  X(CREATESHADER, CreateShader) \
  X(CREATETEXTURES, CreateTextures) \
  X(CREATEVERTEXARRAYS, CreateVertexArrays) \
  X(DELETEBUFFERS, DeleteBuffers) \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers) \
  X(DELETEPROGRAM, DeleteProgram) \
  X(DELETESHADER, DeleteShader) \
  X(DELETETEXTURES, DeleteTextures) \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays) \
  X(DEPTHFUNC, DepthFunc) \
  X(DEPTHMASK, DepthMask) \
  X(DISABLE, Disable) \
  X(DRAWARRAYS, DrawArrays) \
  X(DRAWELEMENTS, DrawElements) \
  X(ENABLE, Enable) \
  X(GETERROR, GetError) \
  X(GETINTEGERV, GetIntegerv) \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog) \
  X(GETPROGRAMIV, GetProgramiv) \
  X(GETSHADERINFOLOG, GetShaderInfoLog) \
  X(GETSHADERIV, GetShaderiv) \
  X(GETSTRING, GetString) \
  X(GETUNIFORMLOCATION, GetUniformLocation) \
  X(LINKPROGRAM, LinkProgram) \
  X(NAMEDBUFFERDATA, NamedBufferData) \
  X(NAMEDFRAMEBUFFERDRAWBUFFER, NamedFramebufferDrawBuffer) \
  X(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture) \
  X(PIXELSTOREI, PixelStorei) \
  X(POLYGONOFFSET, PolygonOffset) \
  X(PROGRAMUNIFORM1F, ProgramUniform1f) \
  X(PROGRAMUNIFORM1I, ProgramUniform1i) \
  X(PROGRAMUNIFORM2F, ProgramUniform2f) \
  X(PROGRAMUNIFORM3F, ProgramUniform3f) \
  X(PROGRAMUNIFORM4F, ProgramUniform4f) \
  X(READPIXELS, ReadPixels) \
  X(SHADERSOURCE, ShaderSource) \
  X(TEXTUREBUFFER, TextureBuffer) \
  X(TEXTUREPARAMETERI, TextureParameteri) \
  X(TEXTURESTORAGE2D, TextureStorage2D) \
  X(USEPROGRAM, UseProgram) \
  X(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer) \
  X(VIEWPORT, Viewport)

namespace tsubu::render {

/// One pointer per function: `gl.DrawArrays(…)` is glDrawArrays of the context it was loaded from.
struct GlFunctions {
#define TSUBU_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name = nullptr;
  TSUBU_GL_FUNCTIONS(TSUBU_GL_MEMBER)
#undef TSUBU_GL_MEMBER
};

/// Fills the table; `address` gives the address of a function by its full name.
template <class Address>
GlFunctions loadGlFunctions(Address address) {
  GlFunctions gl;
#define TSUBU_GL_LOAD(TYPE, name) gl.name = reinterpret_cast<PFNGL##TYPE##PROC>(address("gl" #name));
  TSUBU_GL_FUNCTIONS(TSUBU_GL_LOAD)
#undef TSUBU_GL_LOAD
  return gl;
}

}  // namespace tsubu::render
