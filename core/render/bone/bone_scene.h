#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/bone/dust/dust.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/model/dent.h"
#include "core/bone/surface/surface.h"
#include "core/bone/surface/surface_depths.h"
#include "core/geometry/mesh/mesh.h"
#include "core/render/bone/bone_camera.h"
#include "core/render/bone/bone_palette.h"
#include "core/render/bone/bone_shading.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/quality_steps.h"

namespace haptrial::render {

/// A bone or a piece of one. A new id brings a new surface; an id that is left out of a frame lets
/// its surface go; the volume of an id stays the same.
struct SceneBone {
  std::uint32_t id{0};
  const bone::BoneVolume* volume{nullptr};                // alive during draw()
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  // from B to W
  /// The volume's surface, built already and from now on the scene's; read for a new id. Null: the
  /// scene builds one, which takes seconds for a large bone.
  std::shared_ptr<bone::Surface> surface{};
  std::array<bone::Dent, 2> dents{};  // in its soft structures
};

/// A tool, a plate or anything else with a mesh; kept by the mesh's address while it is drawn.
struct SceneMesh {
  std::shared_ptr<const geometry::Mesh> mesh;             // in its own frame [m]
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  // from that frame to W
  Colour colour{0.75, 0.77, 0.80};                        // alpha below 1: translucent
  std::vector<Capsule> casts{};                           // a shadow on bone, in its own frame
};

/// All that a picture shows.
struct BoneFrame {
  Camera camera;
  std::optional<StereoPair> stereo;
  std::vector<SceneBone> bones;
  std::vector<SceneMesh> meshes;
  std::vector<SceneMesh> scenery;     // what stays as it is and is kept with the bones
  std::vector<bone::DustQuad> dust;   // in any order
  std::vector<bone::DustQuad> blood;  // likewise
};

/// Figures of the last draw().
struct BoneFrameFigures {
  std::size_t triangles{0};  // of the bones, alive
  std::size_t drawn{0};      // of them sent to OpenGL, for all eyes
  std::size_t pixels{0};     // of the bones' picture drawn anew
  std::size_t uploaded{0};   // bytes of bone that changed
  bool visible_only{false};  // the visible arrays were drawn
};

/// Draws bones while they are drilled, tools and dust in OpenGL 3.3 core, off screen or in a
/// window. One thread calls everything, with the context current, also for the destructor; the
/// volumes may change meanwhile. Source: Morris 2006, §3.2.7.
///
/// While the camera moves all triangles are drawn; after it has come to rest those with a vertex
/// whose normal is less than 90 degrees away from the eye's direction, once these are found. Under
/// a camera at rest the bones' picture is kept, and drawn anew only where a surface or a pose
/// changed: what a frame costs then does not follow the size of the bones.
class BoneScene {
 public:
  /// @param structures  by label, for their colours
  /// @param depths      for what shows through; may be null
  /// @throws RunError when OpenGL does not give what is needed.
  BoneScene(const Gl& gl, const BoneStyle& style, std::span<const bone::Structure> structures,
            std::shared_ptr<const bone::StructureDepths> depths);
  ~BoneScene();
  BoneScene(const BoneScene&) = delete;
  BoneScene& operator=(const BoneScene&) = delete;

  /// Brings the surfaces up to date and draws all of the lower left width x height pixels of the
  /// bound framebuffer, its colours only. @throws std::invalid_argument for a frame that cannot be
  /// drawn: a camera or pose that is not finite, a bone without a volume, an id twice.
  void draw(const BoneFrame& frame, int width, int height);
  /// How much of what the style asks for is drawn from now on; at first all.
  void set_quality(Quality quality) noexcept;
  const BoneFrameFigures& figures() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::render
