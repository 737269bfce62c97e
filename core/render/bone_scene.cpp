#include "core/render/bone_scene.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "core/render/bone_dust.h"
#include "core/render/bone_mesh.h"
#include "core/render/bone_object.h"
#include "core/render/bone_palette.h"
#include "core/render/bone_shaders.h"
#include "core/render/gl_program.h"

namespace haptrial::render {
namespace {

void check(const BoneFrame& frame, int width, int height) {
  const BoneCamera& camera = frame.camera;
  if (!camera.pose().matrix().allFinite() || !(camera.distance() > 0.0) ||
      !(camera.field_of_view > 0.0 && camera.field_of_view < 3.14) || width < 2 || height < 1) {
    throw std::invalid_argument("BoneScene: the camera or the picture's size is none");
  }
  std::set<std::uint32_t> ids;
  for (const SceneBone& bone : frame.bones) {
    if (bone.volume == nullptr || !bone.pose.matrix().allFinite() || !ids.insert(bone.id).second) {
      throw std::invalid_argument("BoneScene: a bone without volume or pose, or an id twice");
    }
  }
  for (const SceneMesh& mesh : frame.meshes) {
    if (mesh.mesh == nullptr || !mesh.pose.matrix().allFinite()) {
      throw std::invalid_argument("BoneScene: a tool without mesh or pose");
    }
  }
}

}  // namespace

struct BoneScene::Impl {
  Impl(const Gl& table, const BoneStyle& look, std::span<const bone::Structure> structures,
       std::shared_ptr<const bone::StructureDepths> near)
      : gl(table),
        style(look),
        palette(look, structures),
        depths(std::move(near)),
        program(build_program(gl, "the bone", kLitVertexShader, kLitFragmentShader)),
        to_eye(gl.get_uniform_location(program, "to_eye")),
        to_clip(gl.get_uniform_location(program, "to_clip")),
        light(gl.get_uniform_location(program, "light")),
        dust(gl) {
    if (style.visible_array && style.background_visibility) {
      worker = std::make_unique<VisibilityWorker>();
    }
  }
  ~Impl() { gl.delete_program(program); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void follow(const BoneFrame& frame, const std::vector<EyeView>& views);
  void begin(const BoneFrame& frame, const std::vector<EyeView>& views);
  void draw(const BoneFrame& frame, const EyeView& view);
  void draw_meshes(const BoneFrame& frame, const EyeView& view, bool translucent);
  void use(const EyeView& view, const Eigen::Isometry3d& pose) const;
  void end() const;

  Gl gl;
  BoneStyle style;
  BonePalette palette;
  std::shared_ptr<const bone::StructureDepths> depths;
  Gl::Name program;
  int to_eye;
  int to_clip;
  int light;
  DustDrawing dust;
  std::map<std::uint32_t, std::unique_ptr<BoneObject>> bones;
  std::map<const geometry::Mesh*, std::unique_ptr<BoneMesh>> meshes;
  std::unique_ptr<VisibilityWorker> worker;
  BoneFrameFigures figures;
};

/// Bones and meshes as the frame has them: new ones made, others let go.
void BoneScene::Impl::begin(const BoneFrame& frame, const std::vector<EyeView>& views) {
  std::erase_if(bones, [&](const auto& known) {
    return std::none_of(frame.bones.begin(), frame.bones.end(),
                        [&](const SceneBone& bone) { return bone.id == known.first; });
  });
  std::erase_if(meshes, [&](const auto& known) {
    return std::none_of(frame.meshes.begin(), frame.meshes.end(),
                        [&](const SceneMesh& mesh) { return mesh.mesh.get() == known.first; });
  });
  for (const SceneMesh& mesh : frame.meshes) {
    std::unique_ptr<BoneMesh>& known = meshes[mesh.mesh.get()];
    if (known == nullptr) {
      known = std::make_unique<BoneMesh>(gl, mesh.mesh);
    }
  }
  if (worker != nullptr) {
    for (const VisibilityResult& result : worker->take()) {
      if (const auto found = bones.find(result.id); found != bones.end()) {
        found->second->take(result);
      }
    }
  }
  follow(frame, views);
}

void BoneScene::Impl::follow(const BoneFrame& frame, const std::vector<EyeView>& views) {
  figures = {};
  figures.visible_only = style.visible_array;
  for (const SceneBone& bone : frame.bones) {
    std::unique_ptr<BoneObject>& object = bones[bone.id];
    if (object == nullptr) {
      object = std::make_unique<BoneObject>(gl, bone.id, depths);
    }
    std::vector<Eigen::Vector3d> eyes;
    for (const EyeView& view : views) {
      eyes.emplace_back(bone.pose.inverse() * view.eye);
    }
    figures.uploaded += object->follow(*bone.volume, palette, eyes, worker.get());
    figures.triangles += object->triangle_count();
    figures.visible_only = figures.visible_only && object->has_visible_array();
  }
}

void BoneScene::Impl::use(const EyeView& view, const Eigen::Isometry3d& pose) const {
  const Eigen::Matrix4f eye = (view.view * pose.matrix()).cast<float>();
  gl.uniform_matrix4fv(to_eye, 1, GL_FALSE, eye.data());
}

void BoneScene::Impl::draw_meshes(const BoneFrame& frame, const EyeView& view, bool translucent) {
  for (const SceneMesh& mesh : frame.meshes) {
    if ((mesh.colour.alpha < 1.0) == translucent) {
      use(view, mesh.pose);
      gl.vertex_attrib4f(
          2, static_cast<float>(mesh.colour.red), static_cast<float>(mesh.colour.green),
          static_cast<float>(mesh.colour.blue), static_cast<float>(mesh.colour.alpha));
      meshes.at(mesh.mesh.get())->draw();
    }
  }
}

void BoneScene::Impl::draw(const BoneFrame& frame, const EyeView& view) {
  const Eigen::Matrix4f clip = view.projection.cast<float>();
  gl.use_program(program);
  gl.uniform_matrix4fv(to_clip, 1, GL_FALSE, clip.data());
  gl.uniform4f(light, static_cast<float>(style.ambient), static_cast<float>(style.diffuse),
               static_cast<float>(style.specular), static_cast<float>(style.shininess));
  gl.disable(GL_BLEND);
  gl.depth_mask(GL_TRUE);
  draw_meshes(frame, view, false);  // they hide much of the bone
  figures.drawn = 0;
  for (const SceneBone& bone : frame.bones) {
    use(view, bone.pose);
    figures.drawn += bones.at(bone.id)->draw(style.visible_array);
  }
  gl.enable(GL_BLEND);
  gl.blend_equation(GL_FUNC_ADD);
  gl.blend_func_separate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl.depth_mask(GL_FALSE);
  draw_meshes(frame, view, true);
  dust.draw(frame.dust, view, style.dust);
  gl.depth_mask(GL_TRUE);
}

/// As other drawing expects it.
void BoneScene::Impl::end() const {
  gl.disable(GL_DEPTH_TEST);
  gl.disable(GL_CULL_FACE);
  gl.disable(GL_BLEND);
  gl.use_program(0);
}

BoneScene::BoneScene(const Gl& gl, const BoneStyle& style,
                     std::span<const bone::Structure> structures,
                     std::shared_ptr<const bone::StructureDepths> depths)
    : impl_(std::make_unique<Impl>(gl, style, structures, std::move(depths))) {}

BoneScene::~BoneScene() = default;

void BoneScene::draw(const BoneFrame& frame, int width, int height) {
  check(frame, width, height);
  Impl& scene = *impl_;
  const Gl& gl = scene.gl;
  const int across = frame.stereo ? width / 2 : width;
  const double aspect = static_cast<double>(across) / height;
  std::vector<EyeView> views;
  if (frame.stereo) {
    views = {stereo_view_of(frame.camera, *frame.stereo, -1, aspect),
             stereo_view_of(frame.camera, *frame.stereo, 1, aspect)};
  } else {
    views = {view_of(frame.camera, aspect)};
  }
  scene.begin(frame, views);
  const Colour& ground = scene.style.background;
  gl.disable(GL_SCISSOR_TEST);
  gl.enable(GL_DEPTH_TEST);
  gl.depth_func(GL_LESS);
  gl.depth_mask(GL_TRUE);
  gl.enable(GL_CULL_FACE);
  gl.cull_face(GL_BACK);
  gl.clear_color(static_cast<float>(ground.red), static_cast<float>(ground.green),
                 static_cast<float>(ground.blue), 1.0F);
  gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  for (std::size_t eye = 0; eye < views.size(); ++eye) {
    gl.viewport(static_cast<int>(eye) * across, 0, across, height);
    scene.draw(frame, views[eye]);
  }
  scene.end();
  gl.viewport(0, 0, width, height);
}

const BoneFrameFigures& BoneScene::figures() const noexcept { return impl_->figures; }

}  // namespace haptrial::render
