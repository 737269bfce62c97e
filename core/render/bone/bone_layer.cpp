#include "core/render/bone/bone_layer.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

constexpr double kRoom = 1.5;  // for rounding of vertices and pixels [px]

}  // namespace

PixelBox pixels_of(const Eigen::AlignedBox3d& box, const Eigen::Matrix4d& to_clip, int width,
                   int height) {
  PixelBox pixels;
  if (box.isEmpty()) {
    return pixels;
  }
  const PixelBox all = all_pixels(width, height);
  Eigen::AlignedBox2d covered;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
    const Eigen::Vector4d clip = to_clip * corner.homogeneous();
    if (!(clip.z() > -clip.w()) || !(clip.w() > 0.0)) {
      return all;
    }
    covered.extend(Eigen::Vector2d(clip.head<2>() / clip.w()));
  }
  const Eigen::Vector2d half(0.5 * width, 0.5 * height);
  const auto whole = [&](const Eigen::Vector2d& at, double room) {
    const Eigen::Vector2d pixel =
        (at + Eigen::Vector2d::Ones()).cwiseProduct(half) + Eigen::Vector2d::Constant(room);
    return Eigen::Vector2i(
        static_cast<int>(std::clamp(std::floor(pixel.x()), -1.0, static_cast<double>(width))),
        static_cast<int>(std::clamp(std::floor(pixel.y()), -1.0, static_cast<double>(height))));
  };
  pixels = PixelBox(whole(covered.min(), -kRoom), whole(covered.max(), kRoom)).intersection(all);
  return pixels.isEmpty() ? PixelBox() : pixels;
}

BoneLayer::BoneLayer(const Gl& gl) : gl_(gl), antialias_(gl) {
  gl_.gen_textures(static_cast<int>(textures_.size()), textures_.data());
  for (Gl::Name* framebuffer : {&kept_, &openness_, &shaded_, &over_, &smooth_}) {
    gl_.gen_framebuffers(1, framebuffer);
  }
  gl_.gen_renderbuffers(1, &over_depth_);
  gl_.gen_renderbuffers(1, &smooth_depth_);
}

BoneLayer::~BoneLayer() {
  gl_.delete_textures(static_cast<int>(textures_.size()), textures_.data());
  for (const Gl::Name* framebuffer : {&kept_, &openness_, &shaded_, &over_, &smooth_}) {
    gl_.delete_framebuffers(1, framebuffer);
  }
  gl_.delete_renderbuffers(1, &over_depth_);
  gl_.delete_renderbuffers(1, &smooth_depth_);
}

void BoneLayer::make_texture(int which, int format, Gl::Enum channels, Gl::Enum type, int filter) {
  gl_.active_texture(GL_TEXTURE0 + static_cast<Gl::Enum>(which));
  gl_.bind_texture(GL_TEXTURE_2D, textures_[static_cast<std::size_t>(which)]);
  gl_.tex_image_2d(GL_TEXTURE_2D, 0, format, width_, height_, 0, channels, type, nullptr);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
}

void BoneLayer::attach(Gl::Name framebuffer, Gl::Enum attachment, Gl::Name texture) const {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, framebuffer);
  gl_.framebuffer_texture_2d(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void BoneLayer::check_complete() {
  if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    const int width = std::exchange(width_, 0);
    gl_.bind_framebuffer(GL_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
    throw RunError(
        fmt::format("OpenGL gives no framebuffer of {} x {} pixels for the bone", width, height_));
  }
}

void BoneLayer::make_room() {
  for (const int which : {kColour, kNormal, kShaded, kSmooth}) {
    make_texture(which, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST);
  }
  make_texture(kOver, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_LINEAR);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  make_texture(kOpenness, GL_R8, GL_RED, GL_UNSIGNED_BYTE, GL_NEAREST);
  make_texture(kDepth, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_NEAREST);
  gl_.active_texture(GL_TEXTURE0);
  for (const Gl::Name depth : {over_depth_, smooth_depth_}) {
    gl_.bind_renderbuffer(GL_RENDERBUFFER, depth);
    gl_.renderbuffer_storage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_, height_);
  }
  gl_.bind_renderbuffer(GL_RENDERBUFFER, 0);

  attach(openness_, GL_COLOR_ATTACHMENT0, textures_[kOpenness]);
  check_complete();
  attach(shaded_, GL_COLOR_ATTACHMENT0, textures_[kShaded]);
  check_complete();
  attach(over_, GL_COLOR_ATTACHMENT0, textures_[kOver]);
  gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, over_depth_);
  check_complete();
  attach(smooth_, GL_COLOR_ATTACHMENT0, textures_[kSmooth]);
  gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, smooth_depth_);
  check_complete();
  attach(kept_, GL_COLOR_ATTACHMENT0, textures_[kColour]);
  attach(kept_, GL_COLOR_ATTACHMENT1, textures_[kNormal]);
  attach(kept_, GL_DEPTH_ATTACHMENT, textures_[kDepth]);
  constexpr std::array<Gl::Enum, 2> kBoth{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl_.draw_buffers(static_cast<int>(kBoth.size()), kBoth.data());
  check_complete();
}

bool BoneLayer::begin(int width, int height) {
  gl_.get_integerv(GL_DRAW_FRAMEBUFFER_BINDING, &shown_in_);
  const bool there = width == width_ && height == height_;
  if (!there) {
    width_ = width;
    height_ = height;
    make_room();
  }
  gl_.bind_framebuffer(GL_FRAMEBUFFER, kept_);
  return there;
}

void BoneLayer::bind_textures() const {
  for (const int which : {kColour, kNormal, kDepth, kOpenness}) {
    gl_.active_texture(GL_TEXTURE0 + static_cast<Gl::Enum>(which));
    gl_.bind_texture(GL_TEXTURE_2D, textures_[static_cast<std::size_t>(which)]);
  }
  gl_.active_texture(GL_TEXTURE0);
}

void BoneLayer::begin_openness() const {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, openness_);
  bind_textures();
}

void BoneLayer::begin_shaded() const {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, shaded_);
  bind_textures();
}

void BoneLayer::shade_plainly() const {
  gl_.disable(GL_SCISSOR_TEST);
  gl_.bind_framebuffer(GL_DRAW_FRAMEBUFFER, shaded_);
  gl_.bind_framebuffer(GL_READ_FRAMEBUFFER, kept_);
  gl_.blit_framebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
}

void BoneLayer::copy() const {
  gl_.disable(GL_SCISSOR_TEST);  // it would cut the copy
  const auto copy_of = [&](Gl::Name from, unsigned what) {
    gl_.bind_framebuffer(GL_READ_FRAMEBUFFER, from);
    gl_.blit_framebuffer(0, 0, width_, height_, 0, 0, width_, height_, what, GL_NEAREST);
  };
  gl_.bind_framebuffer(GL_DRAW_FRAMEBUFFER, over_);
  copy_of(shaded_, GL_COLOR_BUFFER_BIT);
  copy_of(kept_, GL_DEPTH_BUFFER_BIT);
}

void BoneLayer::begin_over() const {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, over_);
  bind_textures();
}

void BoneLayer::smooth(int left, int width, std::span<const PixelBox> parts) const {
  const Eigen::Vector2i corner(left, 0);
  const Eigen::Vector2i around = Eigen::Vector2i::Constant(Antialias::kReach);
  PixelBox area = all_pixels(width, height_);
  area.translate(corner);
  PixelTiles tiles(area);
  for (const PixelBox& part : parts) {
    if (!part.isEmpty()) {
      tiles.add({part.min() + corner - around, part.max() + corner + around});
    }
  }
  std::vector<PixelBox> boxes;
  for (const PixelTiles::Part& part : tiles.parts()) {
    boxes.push_back(part.box);
  }
  gl_.bind_framebuffer(GL_FRAMEBUFFER, smooth_);
  antialias_.draw(textures_[kOver], area, boxes);
}

void BoneLayer::show(bool smooth) const {
  gl_.disable(GL_SCISSOR_TEST);
  for (const int which : {kOpenness, kDepth, kNormal, kColour}) {
    gl_.active_texture(GL_TEXTURE0 + static_cast<Gl::Enum>(which));
    gl_.bind_texture(GL_TEXTURE_2D, 0);
  }
  gl_.bind_framebuffer(GL_DRAW_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
  gl_.bind_framebuffer(GL_READ_FRAMEBUFFER, smooth ? smooth_ : over_);
  gl_.blit_framebuffer(0, height_, width_, 0, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
}

}  // namespace haptrial::render
