#pragma once

namespace haptrial::render {

/// One instance is one shape; its four corners come from the vertex number.
inline constexpr const char* kVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec4 place;   // centre [px], direction of the first axis
layout(location = 1) in vec4 form;    // half sizes of the straight part, radius, outline width [px]
layout(location = 2) in vec4 colour;
uniform vec2 screen;                  // [px]
out vec2 local;
flat out vec4 shape;
flat out vec4 paint;

void main() {
  vec2 corner = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  const float kEdge = 1.0;            // room for the pixels that the shape covers in part [px]
  local = corner * (form.xy + form.z + 0.5 * form.w + kEdge);
  vec2 pixel = place.xy + local.x * place.zw + local.y * vec2(-place.w, place.z);
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
  shape = form;
  paint = colour;
}
)glsl";

/// Coverage is that of a pixel cut by a straight edge at the signed distance, and never more than
/// the thickness of the shape, so that what is thinner than a pixel fades instead of growing.
inline constexpr const char* kFragmentShader = R"glsl(#version 330 core
in vec2 local;
flat in vec4 shape;
flat in vec4 paint;
uniform bool masked;
uniform sampler2D mask;
out vec4 result;

void main() {
  vec2 outside = abs(local) - shape.xy;
  float distance = length(max(outside, 0.0)) + min(max(outside.x, outside.y), 0.0) - shape.z;
  float thickness = 2.0 * (min(shape.x, shape.y) + shape.z);
  if (shape.w > 0.0) {
    distance = abs(distance) - 0.5 * shape.w;
    thickness = shape.w;
  }
  float coverage = clamp(min(0.5 - distance, thickness), 0.0, 1.0);
  if (shape.z == 0.0 && shape.w == 0.0) {  // sharp corners: the overlap of two boxes is a product
    vec2 sides = clamp(min(0.5 - outside, 2.0 * shape.xy), 0.0, 1.0);
    coverage = sides.x * sides.y;
  }
  if (masked) {
    coverage *= texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r;
  }
  result = vec4(paint.rgb, 1.0) * (paint.a * coverage);  // premultiplied
}
)glsl";

}  // namespace haptrial::render
