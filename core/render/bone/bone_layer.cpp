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

PixelBox all_pixels(int width, int height) {
  return {Eigen::Vector2i(0, 0), Eigen::Vector2i(width - 1, height - 1)};
}

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

BoneLayer::BoneLayer(const Gl& gl) : gl_(gl) {
  for (Target* target : {&kept_, &over_}) {
    gl_.gen_framebuffers(1, &target->framebuffer);
    gl_.gen_renderbuffers(1, &target->colour);
    gl_.gen_renderbuffers(1, &target->depth);
  }
}

BoneLayer::~BoneLayer() {
  for (const Target* target : {&kept_, &over_}) {
    gl_.delete_framebuffers(1, &target->framebuffer);
    gl_.delete_renderbuffers(1, &target->colour);
    gl_.delete_renderbuffers(1, &target->depth);
  }
}

void BoneLayer::make_room(const Target& target) {
  gl_.bind_framebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.bind_renderbuffer(GL_RENDERBUFFER, target.colour);
  gl_.renderbuffer_storage(GL_RENDERBUFFER, GL_RGBA8, width_, height_);
  gl_.bind_renderbuffer(GL_RENDERBUFFER, target.depth);
  gl_.renderbuffer_storage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_, height_);
  gl_.bind_renderbuffer(GL_RENDERBUFFER, 0);
  gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                               target.colour);
  gl_.framebuffer_renderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth);
  if (gl_.check_framebuffer_status(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    const int width = std::exchange(width_, 0);
    gl_.bind_framebuffer(GL_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
    throw RunError(
        fmt::format("OpenGL gives no framebuffer of {} x {} pixels for the bone", width, height_));
  }
}

bool BoneLayer::begin(int width, int height) {
  gl_.get_integerv(GL_DRAW_FRAMEBUFFER_BINDING, &shown_in_);
  const bool there = width == width_ && height == height_;
  if (!there) {
    width_ = width;
    height_ = height;
    make_room(over_);
    make_room(kept_);
  }
  gl_.bind_framebuffer(GL_FRAMEBUFFER, kept_.framebuffer);
  return there;
}

void BoneLayer::copy() const {
  gl_.disable(GL_SCISSOR_TEST);  // it would cut the copy
  gl_.bind_framebuffer(GL_DRAW_FRAMEBUFFER, over_.framebuffer);
  gl_.blit_framebuffer(0, 0, width_, height_, 0, 0, width_, height_,
                       GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, over_.framebuffer);
}

void BoneLayer::show() const {
  gl_.disable(GL_SCISSOR_TEST);
  gl_.bind_framebuffer(GL_DRAW_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
  gl_.blit_framebuffer(0, height_, width_, 0, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                       GL_NEAREST);
  gl_.bind_framebuffer(GL_FRAMEBUFFER, static_cast<Gl::Name>(shown_in_));
}

}  // namespace haptrial::render
