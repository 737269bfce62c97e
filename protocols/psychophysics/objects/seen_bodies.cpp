#include "protocols/psychophysics/objects/seen_bodies.h"

#include <algorithm>

namespace haptrial::protocols {
namespace {

float size_of(const SeenForces::Force& f) noexcept {
  const auto& [x, y, z] = f.newtons;
  return x * x + y * y + z * z;
}

}  // namespace

std::span<const SeenForces::Force> SeenForces::on(std::size_t i) const noexcept {
  std::size_t first = 0;
  for (std::size_t before = 0; before < i; ++before) {
    first += counts[before];
  }
  return std::span(forces).subspan(first, counts[i]);
}

void SeenForces::add(std::size_t i, std::span<const deformable::VertexForce> more) noexcept {
  std::size_t first = 0;
  for (std::size_t before = 0; before < i; ++before) {
    first += counts[before];
  }
  for (const deformable::VertexForce& each : more) {
    const Force force{each.vertex, {each.force.x(), each.force.y(), each.force.z()}};
    const auto begin = forces.begin() + static_cast<std::ptrdiff_t>(first);
    if (first + counts[i] < kMost) {
      *(begin + counts[i]++) = force;
      continue;
    }
    const auto weakest =
        std::min_element(begin, begin + counts[i],
                         [](const Force& a, const Force& b) { return size_of(a) < size_of(b); });
    if (counts[i] > 0 && size_of(*weakest) < size_of(force)) {
      *weakest = force;
    }
  }
}

std::int32_t SeenBodies::number_of(const SeenBody& body) {
  const std::lock_guard lock(mutex_);
  auto at = std::ranges::find_if(bodies_, [&](const auto& each) { return each.lock() == body; });
  if (at == bodies_.end()) {
    bodies_.push_back({body.resting, body.moving, body.shape});
    at = bodies_.end() - 1;
  }
  return static_cast<std::int32_t>(at - bodies_.begin());
}

SeenBody SeenBodies::body(std::int32_t number) const {
  const std::lock_guard lock(mutex_);
  const auto at = static_cast<std::size_t>(number);
  return number >= 0 && at < bodies_.size() ? bodies_[at].lock() : SeenBody{};
}

}  // namespace haptrial::protocols
