#include "core/render/gl/antialias.h"

#include <GL/glcorearb.h>

#include <string>

namespace haptrial::render {
namespace {

constexpr const char* kPicture = R"(#version 330 core
uniform sampler2D picture;
uniform vec4 area;  // its first and last pixels
out vec4 result;
float brightness(vec3 colour) { return dot(colour, vec3(0.299, 0.587, 0.114)); }
float at_pixel(ivec2 at) {
  return brightness(texelFetch(picture, clamp(at, ivec2(area.xy), ivec2(area.zw)), 0).rgb);
}
vec4 beside(ivec2 at) {  // of the pixels below, above, at its left and at its right
  return vec4(at_pixel(at + ivec2(0, -1)), at_pixel(at + ivec2(0, 1)), at_pixel(at + ivec2(-1, 0)),
              at_pixel(at + ivec2(1, 0)));
}
)";

/// A pixel that is at no edge is as it was, and takes the depth of the pass; edges are left out.
/// What is more than half transparent is taken for dust, which is soft already: full of edges that
/// are none.
constexpr const char* kFlatShader = R"(
const float kLeast = 0.04;   // of a difference that is an edge
const float kShare = 0.125;  // and of the brightest
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  result = texelFetch(picture, at, 0);
  float m = brightness(result.rgb);
  vec4 near = beside(at);
  float brightest = max(m, max(max(near.x, near.y), max(near.z, near.w)));
  float darkest = min(m, min(min(near.x, near.y), min(near.z, near.w)));
  if (result.a > 0.5 && brightest - darkest >= max(kLeast, kShare * brightest)) {
    discard;
  }
  result.a = 1.0;
})";

/// The brightness of the eight neighbours tells whether the edge runs across or up, and on which
/// side of the pixel it lies. Its ends are looked for both ways; between them a
/// straight edge would come half a pixel nearer, by how far the nearer end is. Only a pixel on the
/// side to which the edge bends there takes a share of its neighbour.
constexpr const char* kEdgeShader = R"(
const int kFarthest = 16;  // an end is looked for [px]: with a pixel at either side, kReach
vec3 colour_at(vec2 at) {
  return texture(picture, clamp(at, area.xy + 0.5, area.zw + 0.5) / vec2(textureSize(picture, 0)))
      .rgb;
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  result = texelFetch(picture, at, 0);
  float m = brightness(result.rgb);
  vec4 near = beside(at);
  float n = near.x;
  float s = near.y;
  float w = near.z;
  float e = near.w;
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
      off = brightness(colour_at(start + sign_of_way * way * along)) - mean;
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
  result.rgb = colour_at(vec2(at) + 0.5 + share * aside);
})";

}  // namespace

Antialias::Antialias(const Gl& gl)
    : gl_(gl),
      flat_(make_pass("what is no edge", kFlatShader)),
      edges_(make_pass("the smoothed edges", kEdgeShader)) {
  gl_.gen_vertex_arrays(1, &nothing_);
}

Antialias::~Antialias() {
  gl_.delete_vertex_arrays(1, &nothing_);
  gl_.delete_program(flat_.program);
  gl_.delete_program(edges_.program);
}

Antialias::Pass Antialias::make_pass(const char* whose, const char* fragment) const {
  const std::string text = std::string(kPicture) + fragment;
  Pass pass;
  pass.program = build_program(gl_, whose, kScreenVertexShader, text.c_str());
  pass.area = gl_.get_uniform_location(pass.program, "area");
  gl_.use_program(pass.program);
  gl_.uniform1i(gl_.get_uniform_location(pass.program, "picture"), 0);
  return pass;
}

void Antialias::fill(const Pass& pass, const PixelBox& area) const {
  const auto real = [](int number) { return static_cast<float>(number); };
  gl_.use_program(pass.program);
  gl_.uniform4f(pass.area, real(area.min().x()), real(area.min().y()), real(area.max().x()),
                real(area.max().y()));
  gl_.draw_arrays_instanced(GL_TRIANGLES, 0, 3, 1);
}

void Antialias::draw(Gl::Name picture, const PixelBox& area,
                     std::span<const PixelBox> parts) const {
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, picture);
  gl_.enable(GL_DEPTH_TEST);
  gl_.depth_func(GL_LESS);
  gl_.depth_mask(GL_TRUE);
  gl_.disable(GL_CULL_FACE);
  gl_.disable(GL_BLEND);
  gl_.enable(GL_SCISSOR_TEST);
  gl_.viewport(area.min().x(), area.min().y(), area.sizes().x() + 1, area.sizes().y() + 1);
  gl_.bind_vertex_array(nothing_);
  for (const PixelBox& part : parts) {
    gl_.scissor(part.min().x(), part.min().y(), part.sizes().x() + 1, part.sizes().y() + 1);
    gl_.clear(GL_DEPTH_BUFFER_BIT);
    fill(flat_, area);
    fill(edges_, area);
  }
  gl_.bind_vertex_array(0);
  gl_.disable(GL_SCISSOR_TEST);
  gl_.bind_texture(GL_TEXTURE_2D, 0);
}

}  // namespace haptrial::render
