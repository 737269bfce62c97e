#include "core/render/bone/bone_scene.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/render/bone/bone_dust.h"
#include "core/render/bone/bone_layer.h"
#include "core/render/bone/bone_mesh.h"
#include "core/render/bone/bone_object.h"
#include "core/render/bone/bone_shaders.h"
#include "core/render/bone/depth_tiles.h"

namespace haptrial::render {
namespace {

void check(const BoneFrame& frame, int width, int height) {
  const Camera& camera = frame.camera;
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
  for (const std::vector<SceneMesh>* meshes : {&frame.meshes, &frame.scenery}) {
    for (const SceneMesh& mesh : *meshes) {
      if (mesh.mesh == nullptr || !mesh.pose.matrix().allFinite()) {
        throw std::invalid_argument("BoneScene: a tool without mesh or pose");
      }
    }
  }
}

/// Upside down, as the layer is.
EyeView turned(EyeView view) {
  view.projection.row(1) *= -1.0;
  return view;
}

bool is_same(const EyeView& a, const EyeView& b) {
  return a.view == b.view && a.projection == b.projection;
}

/// Adds the boxes of pixels in which the grains of all cells may be.
void add_pixels_of(std::span<const bone::DustQuad> dust, const Eigen::Matrix4d& to_clip,
                   const EyeArea& area, std::vector<PixelBox>& parts) {
  constexpr double kAround = 1.1;  // times a cell's size
  PixelTiles tiles(all_pixels(area.width, area.height));
  for (const bone::DustQuad& quad : dust) {
    const Eigen::Vector3d middle = quad.position.cast<double>();
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(kAround * quad.size);
    tiles.add(pixels_of({middle - around, middle + around}, to_clip, area.width, area.height));
  }
  for (const PixelTiles::Part& part : tiles.parts()) {
    parts.push_back(part.box);
  }
}

/// Shadow casters among a frame's tools, in W.
std::vector<Capsule> capsules_of(const BoneFrame& frame) {
  std::vector<Capsule> all;
  for (const SceneMesh& mesh : frame.meshes) {
    for (const Capsule& each : mesh.casts) {
      all.push_back({mesh.pose * each.from, mesh.pose * each.to, each.radius});
    }
  }
  return all;
}

/// A bone as it is in the kept picture.
struct DrawnBone {
  Eigen::Matrix4d pose;
  std::uint64_t array;  // BoneObject::array()
  std::array<bone::Dent, 2> dents;
  std::vector<PixelBox> covers;  // by eye
};

Eigen::AlignedBox3d bounds_of(const std::array<bone::Dent, 2>& dents) {
  return dents[0].bounds().merged(dents[1].bounds());
}

/// Locations of the shader's dents.
struct DentUniforms {
  std::array<int, 2> place, out;
  int label;

  DentUniforms(const Gl& gl, Gl::Name program)
      : place{gl.get_uniform_location(program, "dent_place[0]"),
              gl.get_uniform_location(program, "dent_place[1]")},
        out{gl.get_uniform_location(program, "dent_out[0]"),
            gl.get_uniform_location(program, "dent_out[1]")},
        label(gl.get_uniform_location(program, "dent_label")) {}

  void set(const Gl& gl, const std::array<bone::Dent, 2>& dents) const {
    const auto set_one = [&gl](int at, const Eigen::Vector3f& v, double w) {
      gl.uniform4f(at, v.x(), v.y(), v.z(), static_cast<float>(w));
    };
    for (std::size_t i = 0; i < dents.size(); ++i) {
      set_one(place[i], dents[i].place.cast<float>(), dents[i].width());
      set_one(out[i], dents[i].out.cast<float>(), dents[i].depth);
    }
    gl.uniform2f(label, dents[0].label, dents[1].label);
  }
};

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
        lens(gl.get_uniform_location(program, "lens")),
        dents(gl, program),
        dust(gl),
        blood(gl),
        layer(gl),
        shading(gl, look) {
    if (style.visible_array && style.background_visibility) {
      worker = std::make_unique<VisibilityWorker>();
    }
  }
  ~Impl() { gl.delete_program(program); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void follow(const BoneFrame& frame, const std::vector<EyeView>& views);
  void begin(const BoneFrame& frame, const std::vector<EyeView>& views);
  std::vector<PixelBox> changed_parts(const BoneFrame& frame, const std::vector<EyeView>& views,
                                      int width, int height);
  void keep(const BoneFrame& frame, const std::vector<EyeView>& views, bool there, int across,
            int height);
  void draw_bones(const BoneFrame& frame, const EyeView& view, const PixelBox& part, int width,
                  int height);
  DepthTiles& tiles(const EyeArea& area);
  std::vector<PixelBox> draw_over(const BoneFrame& frame, const EyeView& view, const EyeArea& area);
  void smooth(std::vector<std::vector<PixelBox>> drawn, int across, int height);
  void use(const EyeView& view) const;
  void draw_meshes(std::span<const SceneMesh> some, const EyeView& view, bool translucent);
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
  int lens;
  EyeArea eye_area;  // that is drawn on
  DentUniforms dents;
  DustDrawing dust;
  DustDrawing blood;
  BoneLayer layer;
  std::vector<std::unique_ptr<DepthTiles>> depth_tiles;  // by eye
  BoneShading shading;
  std::vector<EyeView> seen_from;  // as the kept picture is
  Quality quality{Quality::kFull};
  bool is_smooth{false};                     // so was the last frame
  bool is_shaded{false};                     // it is darker where it is closed in
  std::vector<PixelBox> changed;             // of it in this frame, by eye
  std::vector<std::vector<PixelBox>> over;   // where it was drawn over in the last frame, by eye
  std::map<std::uint32_t, DrawnBone> shown;  // in the kept picture
  std::vector<std::shared_ptr<const geometry::Mesh>> scenery;  // likewise
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
  std::set<const geometry::Mesh*> wanted;
  for (const std::vector<SceneMesh>* some : {&frame.meshes, &frame.scenery}) {
    for (const SceneMesh& mesh : *some) {
      wanted.insert(mesh.mesh.get());
      std::unique_ptr<BoneMesh>& known = meshes[mesh.mesh.get()];
      if (known == nullptr) {
        known = std::make_unique<BoneMesh>(gl, mesh.mesh);
      }
    }
  }
  std::erase_if(meshes, [&](const auto& known) { return !wanted.contains(known.first); });
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
      object = std::make_unique<BoneObject>(gl, bone.id, depths, bone.surface);
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

void BoneScene::Impl::draw_meshes(std::span<const SceneMesh> some, const EyeView& view,
                                  bool translucent) {
  for (const SceneMesh& mesh : some) {
    if ((mesh.colour.alpha < 1.0) == translucent) {
      use(view, mesh.pose);
      gl.vertex_attrib4f(
          2, static_cast<float>(mesh.colour.red), static_cast<float>(mesh.colour.green),
          static_cast<float>(mesh.colour.blue), static_cast<float>(mesh.colour.alpha));
      meshes.at(mesh.mesh.get())->draw();
    }
  }
}

/// Parts of each eye's picture that differ from the kept one.
std::vector<PixelBox> BoneScene::Impl::changed_parts(const BoneFrame& frame,
                                                     const std::vector<EyeView>& views, int width,
                                                     int height) {
  std::vector<PixelBox> parts(views.size());
  std::map<std::uint32_t, DrawnBone> before = std::exchange(shown, {});
  for (const SceneBone& bone : frame.bones) {
    const BoneObject& object = *bones.at(bone.id);
    DrawnBone now{bone.pose.matrix(), style.visible_array ? object.array() : 0, bone.dents, {}};
    const auto known = before.find(bone.id);
    const bool same =
        known != before.end() && known->second.pose == now.pose && known->second.array == now.array;
    const Eigen::AlignedBox3d bounds = object.blocks().bounds();
    for (std::size_t eye = 0; eye < views.size(); ++eye) {
      const Eigen::Matrix4d clip = views[eye].projection * views[eye].view * now.pose;
      now.covers.push_back(pixels_of(bounds, clip, width, height));
      parts[eye].extend(same ? pixels_of(object.blocks().changed(), clip, width, height)
                             : now.covers[eye]);
      if (same && known->second.dents != bone.dents) {
        const auto bent = bounds_of(known->second.dents).merged(bounds_of(bone.dents));
        parts[eye].extend(pixels_of(bent, clip, width, height));
      }
    }
    if (same) {
      before.erase(known);
    }
    shown.emplace(bone.id, std::move(now));
  }
  for (const auto& [id, gone] : before) {  // from here, or away
    for (std::size_t eye = 0; eye < std::min(views.size(), gone.covers.size()); ++eye) {
      parts[eye].extend(gone.covers[eye]);
    }
  }
  return parts;
}

void BoneScene::Impl::use(const EyeView& view) const {
  const Eigen::Matrix4f clip = view.projection.cast<float>();
  gl.use_program(program);
  gl.uniform_matrix4fv(to_clip, 1, GL_FALSE, clip.data());
  const double half = 0.5 * std::hypot(eye_area.width, eye_area.height);
  gl.uniform4f(lens, static_cast<float>(eye_area.left + 0.5 * eye_area.width),
               static_cast<float>(0.5 * eye_area.height), static_cast<float>(half),
               static_cast<float>(style.vignette));
  gl.uniform4f(light, static_cast<float>(style.ambient), static_cast<float>(style.diffuse),
               static_cast<float>(style.specular), static_cast<float>(style.shininess));
}

void BoneScene::Impl::draw_bones(const BoneFrame& frame, const EyeView& view, const PixelBox& part,
                                 int width, int height) {
  use(view);
  const auto count = [](const Eigen::Vector2i& size) {
    return static_cast<std::size_t>(size.x() + 1) * static_cast<std::size_t>(size.y() + 1);
  };
  const std::size_t pixels = count(part.sizes());
  figures.pixels += pixels;
  // A scene with much to draw is drawn whole: finding out the parts would take longer than it
  // saves.
  const bool all = 2 * pixels > count(all_pixels(width, height).sizes());
  for (const SceneBone& bone : frame.bones) {
    use(view, bone.pose);
    dents.set(gl, bone.dents);
    BoneObject& object = *bones.at(bone.id);
    const Eigen::Matrix4d clip = view.projection * view.view * bone.pose.matrix();
    figures.drawn += all ? object.draw(style.visible_array)
                         : object.draw(style.visible_array, part, clip, width, height,
                                       !bounds_of(bone.dents).isEmpty());
  }
  dents.set(gl, {});
  draw_meshes(frame.scenery, view, false);
}

DepthTiles& BoneScene::Impl::tiles(const EyeArea& area) {
  const auto eye = static_cast<std::size_t>(area.left / area.width);
  while (depth_tiles.size() <= eye) {
    depth_tiles.push_back(std::make_unique<DepthTiles>(gl, BoneLayer::kDepth));
  }
  return *depth_tiles[eye];
}

/// @returns the pixels that may have changed by that, from the eye's lower left
std::vector<PixelBox> BoneScene::Impl::draw_over(const BoneFrame& frame, const EyeView& view,
                                                 const EyeArea& area) {
  const std::vector<Capsule> capsules = capsules_of(frame);
  eye_area = area;
  std::vector<PixelBox> parts;
  layer.begin_over();
  if (quality != Quality::kPlain && !capsules.empty()) {
    const std::vector<BoneColumn>& columns = tiles(area).columns(view.projection, area);
    layer.begin_over();
    gl.viewport(area.left, 0, area.width, area.height);
    parts = shading.draw_shadows(view, area, capsules, columns);
  }
  const Eigen::Matrix4d clip = view.projection * view.view;
  for (const SceneMesh& mesh : frame.meshes) {
    for (const Eigen::AlignedBox3d& slab : meshes.at(mesh.mesh.get())->slabs()) {
      parts.push_back(pixels_of(slab, clip * mesh.pose.matrix(), area.width, area.height));
    }
  }
  add_pixels_of(frame.dust, clip, area, parts);
  add_pixels_of(frame.blood, clip, area, parts);
  use(view);
  gl.disable(GL_BLEND);
  gl.depth_mask(GL_TRUE);
  draw_meshes(frame.meshes, view, false);
  gl.enable(GL_BLEND);
  gl.blend_equation(GL_FUNC_ADD);
  gl.blend_func_separate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl.depth_mask(GL_FALSE);
  draw_meshes(frame.meshes, view, true);
  // Alpha tells the smoothing what is dust.
  gl.blend_func_separate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
  dust.draw(frame.dust, view, style.dust, is_shaded, quality == Quality::kPlain);
  blood.draw(frame.blood, view, style.blood, is_shaded, false);
  gl.depth_mask(GL_TRUE);
  return parts;
}

/// Smooths the edges of changed parts and of their neighbourhood anew.
void BoneScene::Impl::smooth(std::vector<std::vector<PixelBox>> drawn, int across, int height) {
  const bool was_smooth = is_smooth;
  is_smooth = style.smooth_edges && is_shaded && quality == Quality::kFull;
  over.resize(drawn.size());
  for (std::size_t eye = 0; is_smooth && eye < drawn.size(); ++eye) {
    std::vector<PixelBox> parts = drawn[eye];
    parts.insert(parts.end(), over[eye].begin(), over[eye].end());
    parts.push_back(was_smooth ? changed[eye] : all_pixels(across, height));
    layer.smooth(static_cast<int>(eye) * across, across, parts);
  }
  over = std::move(drawn);
}

/// Draws the parts of the bones that differ from the kept picture. While the camera moves they are
/// not darkened where they are closed in: all of the picture would have to be, in every frame.
void BoneScene::Impl::keep(const BoneFrame& frame, const std::vector<EyeView>& views, bool there,
                           int across, int height) {
  std::vector<PixelBox> parts = changed_parts(frame, views, across, height);
  const bool rests =
      std::equal(views.begin(), views.end(), seen_from.begin(), seen_from.end(), is_same);
  const bool shaded =
      quality != Quality::kPlain && (rests || seen_from.empty() || style.shades_moving);
  const bool same_scenery =
      std::equal(frame.scenery.begin(), frame.scenery.end(), scenery.begin(), scenery.end(),
                 [](const SceneMesh& a, const std::shared_ptr<const geometry::Mesh>& b) {
                   return a.mesh == b;
                 });
  if (!same_scenery) {
    scenery.clear();
    for (const SceneMesh& mesh : frame.scenery) {
      scenery.push_back(mesh.mesh);
    }
  }
  there = there && style.kept_layer && rests && same_scenery;
  seen_from = views;
  gl.disable(GL_BLEND);
  gl.disable(GL_SCISSOR_TEST);
  if (!there) {
    gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }
  for (std::size_t eye = 0; eye < views.size(); ++eye) {
    const int left = static_cast<int>(eye) * across;
    PixelBox& part = parts[eye];
    if (!there) {
      part = all_pixels(across, height);
    }
    if (part.isEmpty()) {
      continue;
    }
    tiles({left, across, height}).change(part);
    eye_area = {left, across, height};
    gl.viewport(left, 0, across, height);
    if (there) {
      gl.enable(GL_SCISSOR_TEST);
      gl.scissor(left + part.min().x(), part.min().y(), part.sizes().x() + 1, part.sizes().y() + 1);
      gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }
    draw_bones(frame, views[eye], part, across, height);
  }
  const bool all = std::exchange(is_shaded, shaded) != shaded;
  if (!shaded) {
    layer.shade_plainly();
  }
  changed.assign(views.size(), all_pixels(across, height));
  for (std::size_t eye = 0; shaded && eye < views.size(); ++eye) {
    const EyeArea area{static_cast<int>(eye) * across, across, height};
    gl.viewport(area.left, 0, across, height);
    shading.draw(layer, views[eye], area, all ? all_pixels(across, height) : parts[eye]);
    if (!all) {
      changed[eye] = BoneShading::reached_by(parts[eye], across, height);
    }
  }
}

/// Sets the state that other drawing expects.
void BoneScene::Impl::end() const {
  gl.disable(GL_DEPTH_TEST);
  gl.disable(GL_CULL_FACE);
  gl.cull_face(GL_BACK);
  gl.disable(GL_BLEND);
  gl.use_program(0);
  layer.show(is_smooth);
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
  std::transform(views.begin(), views.end(), views.begin(), turned);
  const bool there = scene.layer.begin(width, height);
  const Colour& ground = scene.style.background;
  gl.enable(GL_DEPTH_TEST);
  gl.depth_func(GL_LESS);
  gl.depth_mask(GL_TRUE);
  gl.enable(GL_CULL_FACE);
  gl.cull_face(GL_FRONT);  // of a picture upside down
  gl.clear_color(static_cast<float>(ground.red), static_cast<float>(ground.green),
                 static_cast<float>(ground.blue), 1.0F);
  scene.keep(frame, views, there, across, height);
  scene.layer.copy();
  std::vector<std::vector<PixelBox>> drawn;
  for (std::size_t eye = 0; eye < views.size(); ++eye) {
    const EyeArea area{static_cast<int>(eye) * across, across, height};
    gl.viewport(area.left, 0, across, height);
    drawn.push_back(scene.draw_over(frame, views[eye], area));
  }
  scene.smooth(std::move(drawn), across, height);
  scene.end();
  gl.viewport(0, 0, width, height);
}

void BoneScene::set_quality(Quality quality) noexcept { impl_->quality = quality; }

const BoneFrameFigures& BoneScene::figures() const noexcept { return impl_->figures; }

}  // namespace haptrial::render
