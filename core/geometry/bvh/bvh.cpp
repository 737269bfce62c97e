#include "core/geometry/bvh/bvh.h"

#include "core/base/parallel.h"
#include "core/geometry/bvh/bvh_data.h"
#include "core/geometry/bvh/bvh_kernel.h"

namespace haptrial::geometry {

Bvh::Bvh(const Mesh& mesh, const BvhOptions& options) {
  auto data = std::make_unique<BvhData>();
  data->kernels = &kernel::kernels_for(options.instruction_set);
  build_hierarchy(mesh, threads_or_all(options.threads), *data);
  data_ = std::move(data);
}
Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

std::size_t Bvh::triangles() const noexcept { return data_->slots.size(); }

ClosestPoint Bvh::closest(const Eigen::Vector3d& point) const noexcept {
  return closest(point, -1);
}

ClosestPoint Bvh::closest(const Eigen::Vector3d& point, std::int32_t hint) const noexcept {
  if (data_->nodes.empty() || !point.allFinite()) {
    return {};
  }
  const bool hinted = static_cast<std::size_t>(hint) < data_->slots.size();  // -1 is too large
  const std::int32_t slot = hinted ? data_->slots[hint] : -1;
  if (!kernel::is_near(data_->frame.to_frame(point))) {
    return kernel::closest_in_double(*data_, point, slot);
  }
  return data_->kernels->one(*data_, point, slot);
}

}  // namespace haptrial::geometry
