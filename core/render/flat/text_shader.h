#pragma once

namespace haptrial::render {

/// One instance is one letter; its four corners come from the vertex number.
inline constexpr const char* kTextVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec4 place;   // left, top, width, height on the screen [px]
layout(location = 1) in vec4 source;  // left, top in the atlas [px]; 1: the letter runs upwards
layout(location = 2) in vec4 colour;
uniform vec2 screen;                  // [px]
out vec2 local;
flat out vec4 box;
flat out vec4 letter;
flat out vec4 paint;

void main() {
  local = vec2(gl_VertexID & 1, gl_VertexID >> 1) * place.zw;
  vec2 pixel = place.xy + local;
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
  box = place;
  letter = source;
  paint = colour;
}
)glsl";

/// A pixel of the screen is a pixel of the atlas: nothing is interpolated.
inline constexpr const char* kTextFragmentShader = R"glsl(#version 330 core
in vec2 local;
flat in vec4 box;
flat in vec4 letter;
flat in vec4 paint;
uniform sampler2D atlas;
out vec4 result;

void main() {
  ivec2 at = ivec2(floor(local));
  if (letter.z > 0.5) {
    at = ivec2(int(box.w) - 1 - at.y, at.x);
  }
  float coverage = texelFetch(atlas, ivec2(letter.xy) + at, 0).r;
  result = vec4(paint.rgb, 1.0) * (paint.a * coverage);  // premultiplied
}
)glsl";

}  // namespace haptrial::render
