#include "core/render/bone/bone_object.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cstring>

namespace haptrial::render {
namespace {

template <class Number>
std::vector<std::uint32_t> unsigned_of(std::span<const Number> numbers) {
  return {numbers.begin(), numbers.end()};
}

std::vector<std::uint32_t> triangles_of(std::span<const std::int32_t> quads) {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(2 * quads.size());
  for (const std::int32_t quad : quads) {
    triangles.push_back(2 * static_cast<std::uint32_t>(quad));
    triangles.push_back(2 * static_cast<std::uint32_t>(quad) + 1);
  }
  return triangles;
}

auto copier(std::span<const bone::SurfaceTriangle> triangles) {
  return [triangles](ItemRange range, std::byte* to) {
    std::memcpy(to, triangles.data() + range.first, range.count * sizeof(bone::SurfaceTriangle));
  };
}

constexpr double kPixelRoom = 1.5;  // for rounding of vertices and pixels [px]

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

/// A part of a picture as bounds of x / w and y / w in clip space.
class BoneObject::PartOfPicture {
 public:
  PartOfPicture(const PixelBox& part, const Eigen::Matrix4d& to_clip, int width, int height)
      : to_clip_(to_clip) {
    const Eigen::Array2d half(0.5 * width, 0.5 * height);
    low_ = (part.min().cast<double>().array() - kPixelRoom) / half - 1.0;
    high_ = (part.max().cast<double>().array() + 1.0 + kPixelRoom) / half - 1.0;
  }
  /// The sides of the part beyond which a place of the bone lies, a bit each; none at the eye.
  unsigned outside_of(const std::array<float, 3>& place) const {
    const Eigen::Vector4d at = to_clip_ * Eigen::Vector4d(place[0], place[1], place[2], 1.0);
    if (!(at.w() > 0.0)) {
      return 0;
    }
    return static_cast<unsigned>(at.x() < low_.x() * at.w()) |
           static_cast<unsigned>(at.x() > high_.x() * at.w()) << 1 |
           static_cast<unsigned>(at.y() < low_.y() * at.w()) << 2 |
           static_cast<unsigned>(at.y() > high_.y() * at.w()) << 3;
  }

 private:
  Eigen::Matrix4d to_clip_;
  Eigen::Array2d low_;
  Eigen::Array2d high_;
};

BoneObject::BoneObject(const Gl& gl, std::uint32_t id,
                       std::shared_ptr<const bone::StructureDepths> depths,
                       std::shared_ptr<bone::Surface> surface)
    : gl_(gl),
      id_(id),
      surface_(surface ? std::move(surface) : std::make_shared<bone::Surface>(std::move(depths))),
      vertices_(gl, sizeof(GpuVertex)),
      complete_(gl, sizeof(bone::SurfaceTriangle)),
      chosen_(gl, sizeof(bone::SurfaceTriangle)),
      part_(gl, sizeof(bone::SurfaceTriangle)) {
  gl_.gen_vertex_arrays(1, &array_);
  gl_.bind_vertex_array(array_);
  vertices_.bind(GL_ARRAY_BUFFER);
  for (unsigned index = 0; index < 3; ++index) {
    gl_.enable_vertex_attrib_array(index);
  }
  gl_.vertex_attrib_pointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(GpuVertex), offset(0));
  gl_.vertex_attrib_pointer(1, 4, GL_SHORT, GL_TRUE, sizeof(GpuVertex),
                            offset(offsetof(GpuVertex, normal)));
  gl_.vertex_attrib_pointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(GpuVertex),
                            offset(offsetof(GpuVertex, colour)));
  gl_.bind_vertex_array(0);
}

BoneObject::~BoneObject() { gl_.delete_vertex_arrays(1, &array_); }

std::size_t BoneObject::follow(const bone::BoneVolume& volume, const BonePalette& palette,
                               const std::vector<Eigen::Vector3d>& eyes, VisibilityWorker* worker) {
  surface_->update(volume);
  blocks_.follow(*surface_, volume.grid());
  if (surface_->rebuilt()) {
    valid_ = false;
    waiting_ = false;
  }
  if (waiting_) {
    since_.insert(since_.end(), surface_->changed_quads().begin(), surface_->changed_quads().end());
  } else if (valid_) {
    for (const std::int32_t quad : surface_->changed_quads()) {
      visible_.refresh(*surface_, quad, eyes_);
    }
  }
  look(eyes, worker);
  return send(palette);
}

/// The visible array is begun anew when the eyes have come to rest.
void BoneObject::look(const std::vector<Eigen::Vector3d>& eyes, VisibilityWorker* worker) {
  rested_ = eyes == eyes_;
  if (!rested_) {
    eyes_ = eyes;
    valid_ = false;
    waiting_ = false;
    return;
  }
  if (valid_ || waiting_) {
    return;
  }
  ++generation_;
  waiting_ = true;
  since_.clear();
  if (worker == nullptr) {
    take({id_, generation_, visible_triangles(surface_->vertices(), surface_->triangles(), eyes_)});
    return;
  }
  worker->submit({id_,
                  generation_,
                  facing(surface_->vertices(), eyes_),
                  {surface_->triangles().begin(), surface_->triangles().end()}});
}

void BoneObject::take(const VisibilityResult& result) {
  if (!waiting_ || result.generation != generation_) {
    return;
  }
  visible_.set(*surface_, result.triangles);
  for (const std::int32_t quad : since_) {
    visible_.refresh(*surface_, quad, eyes_);
  }
  waiting_ = false;
  valid_ = true;
}

std::size_t BoneObject::send(const BonePalette& palette) {
  const auto write_vertices = [&](ItemRange range, std::byte* to) {
    for (std::size_t i = 0; i < range.count; ++i) {
      const bone::SurfaceVertex& v = surface_->vertices()[range.first + i];
      const GpuVertex vertex{
          v.place, {v.normal[0], v.normal[1], v.normal[2], v.label}, palette.of(v)};
      std::memcpy(to + i * sizeof(GpuVertex), &vertex, sizeof(GpuVertex));
    }
  };
  std::size_t sent = vertices_.update(surface_->vertices().size(),
                                      unsigned_of(surface_->changed_vertices()), write_vertices);
  sent += complete_.update(surface_->triangles().size(), triangles_of(surface_->changed_quads()),
                           copier(surface_->triangles()));
  if (valid_) {
    sent += chosen_.update(visible_.size(), visible_.take_changed(),
                           [&](ItemRange range, std::byte* to) {
                             for (std::size_t i = 0; i < range.count; ++i) {
                               copy_triangle(true, range.first + i, to, i);
                             }
                           });
  }
  return sent;
}

std::size_t BoneObject::draw(bool visible) const {
  const bool chosen = visible && valid_;
  const std::size_t count = chosen ? visible_.size() : surface_->triangles().size();
  draw_triangles(chosen ? chosen_ : complete_, count);
  return count;
}

std::size_t BoneObject::draw(bool visible, const PixelBox& part, const Eigen::Matrix4d& to_clip,
                             int width, int height, bool bent) {
  const bool chosen = visible && valid_;
  const PartOfPicture seen(part, to_clip, width, height);
  places_.clear();
  for (const BoneBlocks::Block& block : blocks_.blocks()) {
    if (!block.quads.empty()) {
      const PixelBox covers = pixels_of(block.box, to_clip, width, height);
      if (part.intersects(covers)) {
        gather(chosen, block.quads, bent || part.contains(covers) ? nullptr : &seen);
      }
    }
  }
  std::sort(places_.begin(), places_.end());
  part_.fill(places_.size(), [&](ItemRange range, std::byte* to) {
    for (std::size_t i = 0; i < range.count; ++i) {
      copy_triangle(chosen, places_[range.first + i], to, i);
    }
  });
  draw_triangles(part_, places_.size());
  return places_.size();
}

/// The triangle at a place of the visible array or of the complete one, as item i.
void BoneObject::copy_triangle(bool chosen, std::size_t place, std::byte* to, std::size_t i) const {
  const bone::SurfaceTriangle triangle =
      chosen ? visible_.triangle(*surface_, place) : surface_->triangles()[place];
  std::memcpy(to + i * sizeof(triangle), &triangle, sizeof(triangle));
}

/// @param seen  what does not fall into this part is left out; null: all is taken
void BoneObject::gather(bool chosen, std::span<const std::int32_t> quads,
                        const PartOfPicture* seen) {
  const auto may_show = [&](std::size_t slot) {
    const bone::SurfaceTriangle& triangle = surface_->triangles()[slot];
    unsigned outside = ~0U;
    for (const std::uint32_t corner : triangle) {
      outside &= seen->outside_of(surface_->vertices()[corner].place);
    }
    return outside == 0;
  };
  for (const std::int32_t quad : quads) {
    const auto slot = 2 * static_cast<std::size_t>(quad);
    for (std::size_t half = slot; half < slot + 2; ++half) {
      const std::int32_t place = chosen ? visible_.place_of(half) : static_cast<std::int32_t>(half);
      if (place >= 0 && (seen == nullptr || may_show(half))) {
        places_.push_back(static_cast<std::uint32_t>(place));
      }
    }
  }
}

void BoneObject::draw_triangles(const GlBuffer& from, std::size_t count) const {
  if (count > 0) {
    gl_.bind_vertex_array(array_);
    from.bind(GL_ELEMENT_ARRAY_BUFFER);
    gl_.draw_elements(GL_TRIANGLES, static_cast<int>(3 * count), GL_UNSIGNED_INT, nullptr);
    gl_.bind_vertex_array(0);
  }
}

}  // namespace haptrial::render
