#pragma once

namespace haptrial::render {

inline constexpr const char* kSurfaceVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec3 place;  // right, down, towards the eye [px]
uniform vec2 screen;                 // [px]
out vec3 at;

void main() {
  at = place;
  gl_Position = vec4(2.0 * place.x / screen.x - 1.0, 1.0 - 2.0 * place.y / screen.y,
                     -place.z / 16384.0, 1.0);
}
)glsl";

inline constexpr const char* kSurfaceFragmentShader = R"glsl(#version 330 core
in vec3 at;
uniform vec4 colour;
out vec4 result;

void main() {
  vec3 across = cross(dFdx(at), dFdy(at));
  float size = length(across);  // seen edge-on it is what it may be
  vec3 normal = size > 0.0 && size < 1e6 ? across / size : vec3(0.0, 0.0, 1.0);
  normal *= normal.z < 0.0 ? -1.0 : 1.0;
  float light = max(0.0, dot(normal, normalize(vec3(-0.5, -0.6, 0.8))));
  result = vec4(colour.rgb * (0.55 + 0.5 * light), 1.0);
}
)glsl";

}  // namespace haptrial::render
