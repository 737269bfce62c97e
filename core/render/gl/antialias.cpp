#include "core/render/gl/antialias.h"

#include <GL/glcorearb.h>

#include "core/render/gl/gl_program.h"

namespace haptrial::render {
namespace {

constexpr const char* kVertexShader = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";

/// Of the eight neighbours' brightness follows whether there is an edge, whether it runs across or
/// up, and on which side of the pixel it lies. Its ends are looked for both ways; between them a
/// straight edge would come half a pixel nearer, by how far the nearer end is. Only a pixel on the
/// side to which the edge bends there takes a share of its neighbour.
constexpr const char* kFragmentShader = R"(#version 330 core
uniform sampler2D picture;
uniform vec4 size;  // of the picture [px], and of a pixel
out vec4 result;
const float kLeast = 0.04;   // of a difference that is an edge
const float kShare = 0.125;  // and of the brightest
const int kFarthest = 16;    // an end is looked for [px]
float brightness(vec3 colour) { return dot(colour, vec3(0.299, 0.587, 0.114)); }
float at_pixel(ivec2 at) {
  return brightness(texelFetch(picture, clamp(at, ivec2(0), ivec2(size.xy) - 1), 0).rgb);
}
float between(vec2 at) { return brightness(texture(picture, at * size.zw).rgb); }
void main() {
  ivec2 at = ivec2(gl_FragCoord.x, size.y - gl_FragCoord.y);
  result = texelFetch(picture, at, 0);
  float m = brightness(result.rgb);
  float n = at_pixel(at + ivec2(0, -1));
  float s = at_pixel(at + ivec2(0, 1));
  float w = at_pixel(at + ivec2(-1, 0));
  float e = at_pixel(at + ivec2(1, 0));
  float brightest = max(m, max(max(n, s), max(w, e)));
  float darkest = min(m, min(min(n, s), min(w, e)));
  if (brightest - darkest < max(kLeast, kShare * brightest)) {
    return;
  }
  float nw = at_pixel(at + ivec2(-1, -1));
  float ne = at_pixel(at + ivec2(1, -1));
  float sw = at_pixel(at + ivec2(-1, 1));
  float se = at_pixel(at + ivec2(1, 1));
  float across = 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e) + abs(nw + sw - 2.0 * w);
  float up = 2.0 * abs(w + e - 2.0 * m) + abs(nw + ne - 2.0 * n) + abs(sw + se - 2.0 * s);
  bool runs_across = across >= up;
  float before = runs_across ? n : w;
  float behind = runs_across ? s : e;
  bool is_before = abs(before - m) >= abs(behind - m);
  float other = is_before ? before : behind;
  vec2 along = runs_across ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
  vec2 aside = along.yx * (is_before ? -1.0 : 1.0);
  float mean = 0.5 * (m + other);
  float enough = 0.25 * abs(m - other);
  vec2 start = vec2(at) + 0.5 + 0.5 * aside;
  vec2 ways = vec2(0.0);
  vec2 ends = vec2(0.0);
  for (int side = 0; side < 2; ++side) {
    float sign_of_way = side == 0 ? -1.0 : 1.0;
    float way = 0.0;
    float off = 0.0;
    for (int i = 1; i <= kFarthest && abs(off) < enough; ++i) {
      way = float(i);
      off = between(start + sign_of_way * way * along) - mean;
    }
    ways[side] = way;
    ends[side] = off;
  }
  bool first = ways.x < ways.y;
  float end = first ? ends.x : ends.y;
  if (abs(end) < enough || (m < mean) == (end < 0.0)) {
    return;
  }
  float share = 0.5 - min(ways.x, ways.y) / (ways.x + ways.y);
  result.rgb = texture(picture, (vec2(at) + 0.5 + share * aside) * size.zw).rgb;
})";

}  // namespace

Antialias::Antialias(const Gl& gl)
    : gl_(gl),
      program_(build_program(gl, "the smoothed edges", kVertexShader, kFragmentShader)),
      size_(gl.get_uniform_location(program_, "size")) {
  gl_.gen_vertex_arrays(1, &nothing_);
  gl_.use_program(program_);
  gl_.uniform1i(gl_.get_uniform_location(program_, "picture"), 0);
}

Antialias::~Antialias() {
  gl_.delete_vertex_arrays(1, &nothing_);
  gl_.delete_program(program_);
}

void Antialias::draw(Gl::Name picture, int width, int height) const {
  gl_.use_program(program_);
  gl_.uniform4f(size_, static_cast<float>(width), static_cast<float>(height),
                1.0F / static_cast<float>(width), 1.0F / static_cast<float>(height));
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, picture);
  gl_.disable(GL_DEPTH_TEST);
  gl_.disable(GL_CULL_FACE);
  gl_.disable(GL_BLEND);
  gl_.viewport(0, 0, width, height);
  gl_.bind_vertex_array(nothing_);
  gl_.draw_arrays_instanced(GL_TRIANGLES, 0, 3, 1);
  gl_.bind_vertex_array(0);
  gl_.bind_texture(GL_TEXTURE_2D, 0);
}

}  // namespace haptrial::render
