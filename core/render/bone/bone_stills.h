#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/render/flat/flat_quads.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

/// The side of a picture at whose upper corner a still stands.
enum class StillSide { kRight, kLeft };

/// Stills beside a picture that moves: one at a time in an upper corner, with a frame.
/// One thread, with the context current, also for the destructor. Source: Morris 2006, §3.3.
class BoneStills {
 public:
  static constexpr double kShare = 0.36;      // of the picture's width
  static constexpr double kLeftHeight = 0.8;  // of its height; below stand words

  /// @throws RunError when the shaders cannot be made.
  BoneStills(const Gl& gl, std::shared_ptr<const std::vector<Image>> stills,
             StillSide side = StillSide::kRight);
  ~BoneStills();
  BoneStills(const BoneStills&) = delete;
  BoneStills& operator=(const BoneStills&) = delete;

  /// Other pictures in the place of all.
  void replace(std::shared_ptr<const std::vector<Image>> stills);
  std::size_t count() const noexcept { return stills_->size(); }
  /// Place of a still in a picture: left, top, width, height [px].
  static Eigen::Vector4d place_of(const Image& still, int width, int height,
                                  StillSide side = StillSide::kRight);
  /// Place of the first still, likewise.
  Eigen::Vector4d place(int width, int height) const {
    return place_of(stills_->front(), width, height, side_);
  }
  /// Draws one over what is there. @param number  from 0, below count()
  /// @param left  of the part of the framebuffer that holds the picture [px]
  /// @param width, height  of that part
  void draw(std::size_t number, int left, int width, int height);

 private:
  void upload(std::size_t number);

  Gl gl_;
  std::shared_ptr<const std::vector<Image>> stills_;
  StillSide side_;
  FlatQuads quads_;
  Gl::Name program_{0};
  Gl::Name texture_{0};
  std::size_t uploaded_{static_cast<std::size_t>(-1)};
};

}  // namespace haptrial::render
