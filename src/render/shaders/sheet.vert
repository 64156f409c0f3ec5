// Translucent faces and fine lines, one stream from back to front.
// Three texels a vertex: clip position; normal and 0, or distance across, half width, 0 and 1; colour and opacity.
uniform samplerBuffer sheets;

out vec4 shape;
out vec4 paint;

void main() {
  gl_Position = texelFetch(sheets, 3 * gl_VertexID);
  shape = texelFetch(sheets, 3 * gl_VertexID + 1);
  paint = texelFetch(sheets, 3 * gl_VertexID + 2);
}
