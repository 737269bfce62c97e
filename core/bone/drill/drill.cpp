#include "core/bone/drill/drill.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::bone {
namespace {

constexpr double kWidest = 5000.0;  // radius of a burr in voxels

/// @returns false where the burr cannot touch the grid, or its pose is none.
bool place(const geometry::VoxelGrid& grid, const Eigen::Vector3d& tip, double radius,
           const Eigen::Matrix3d& turn, kernel::Placement& at) noexcept {
  const double wide = radius / grid.spacing;  // in voxels
  // In units of voxels, with voxel i from i to i + 1.
  const Eigen::Array3d centre = ((tip - grid.origin) / grid.spacing).array() + 0.5;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = grid.size[static_cast<std::size_t>(axis)];
    if (!(centre[axis] + wide > -1.0 && centre[axis] - wide < size + 1.0)) {
      return false;
    }
  }
  if (!(wide < kWidest && turn.allFinite())) {
    return false;
  }
  // As many bits below the point as leave 30 for the burr and a voxel beside it.
  at.shift = 29 - std::ilogb(wide + 2.0);
  const double one = std::ldexp(1.0, at.shift);
  for (int axis = 0; axis < 3; ++axis) {
    const double base = std::floor(centre[axis]);
    at.base[axis] = static_cast<std::int32_t>(base);
    at.offset[axis] = static_cast<std::int32_t>(std::lround((centre[axis] - base) * one));
    for (int of = 0; of < 3; ++of) {
      at.turn[axis][of] =
          static_cast<std::int32_t>(std::lround(turn(axis, of) * wide / Burr::kRadius * one));
    }
  }
  return true;
}

}  // namespace

Contact in_world(const Contact& contact_B, const Eigen::Isometry3d& X_WB) noexcept {
  Contact contact = contact_B;
  contact.push = X_WB.linear() * contact_B.push;
  contact.turn = X_WB.linear() * contact_B.turn;
  if (contact) {
    contact.centroid = X_WB * contact_B.centroid;
  }
  return contact;
}

Contact together(const Contact& a, const Contact& b) noexcept {
  Contact sum;
  sum.samples = a.samples + b.samples;
  sum.volume = a.volume + b.volume;
  sum.push = a.push + b.push;
  sum.turn = a.turn + b.turn;
  if (sum) {
    sum.centroid = (a.volume * a.centroid + b.volume * b.centroid) / sum.volume;
  }
  return sum;
}

Drill::Drill(const BurrParameters& burr, std::span<const Structure> structures, InstructionSet set,
             const std::array<bool, 256>& soft)
    : burr_(burr),
      touch_(choose(set, kernel::touch_burr_baseline, HAPTRIAL_X86(kernel::touch_burr_avx2),
                    HAPTRIAL_X86(kernel::touch_burr_avx512))),
      soft_(soft),
      any_soft_(std::find(soft.begin(), soft.end(), true) != soft.end()),
      // One more: the kernel writes the next place before it knows whether it is kept.
      hits_(static_cast<std::size_t>(burr_.samples()) * kBonesAtOnce + 1),
      emptied_(static_cast<std::size_t>(burr_.samples()) * kBonesAtOnce) {
  softness_.fill(1.0F);
  for (std::size_t label = 0; label < structures.size() && label < softness_.size(); ++label) {
    const double hardness = structures[label].hardness;
    if (!(hardness > 0.0) || !std::isfinite(hardness)) {
      throw std::invalid_argument(
          fmt::format("Drill: the hardness of '{}' is {}; allowed: a number above 0",
                      structures[label].name, hardness));
    }
    softness_[label] = static_cast<float>(1.0 / hardness);
  }
}

Contact Drill::touch(const BoneVolume& volume, const Eigen::Vector3d& tip_B,
                     const Eigen::Quaterniond& orientation_B) noexcept {
  Contact contact;
  contact.first = kept_;
  const Eigen::Matrix3d turn = orientation_B.normalized().toRotationMatrix();
  kernel::Placement at{};
  const double length = orientation_B.squaredNorm();
  if (!(length > 0.0 && std::isfinite(length)) ||
      !place(volume.grid(), tip_B, burr_.radius(), turn, at)) {
    return contact;
  }
  const BoneVolume::View view = volume.view();
  const kernel::Bricks bricks{{view.size[0], view.size[1], view.size[2]},
                              {view.table_size[0], view.table_size[1]},
                              view.table,
                              view.densities};
  const Burr::Arrays burr = burr_.arrays();
  const kernel::Cloud cloud{burr.x, burr.y, burr.z, burr.dx, burr.dy, burr.dz, burr.count};
  const auto room = static_cast<std::int32_t>(hits_.size()) - 1 - kept_;
  kernel::Sums sums;
  contact.kept = touch_(cloud, at, bricks, hits_.data() + kept_, room, sums);
  if (any_soft_) {
    leave_soft(volume, contact, sums);
  }
  kept_ += contact.kept;
  if (sums.count == 0) {
    return contact;
  }
  const auto vector = [](const std::int64_t(&v)[3]) {
    return Eigen::Vector3d(static_cast<double>(v[0]), static_cast<double>(v[1]),
                           static_cast<double>(v[2]));
  };
  const Eigen::Vector3d position_T = burr_.radius() / Burr::kRadius * vector(sums.position);
  const double each = burr_.sample_volume();
  contact.samples = static_cast<std::int32_t>(sums.count);
  contact.volume = each * static_cast<double>(sums.count);
  contact.push = turn * (each / Burr::kUnit * vector(sums.direction));
  // (p - sc) x d with d along z: the sum needs no more than the sum of positions.
  contact.turn = turn * (each * Eigen::Vector3d(position_T.y(), -position_T.x(), 0.0));
  contact.centroid = tip_B + turn * (position_T / static_cast<double>(sums.count));
  return contact;
}

/// Takes hits in soft structures out of list and sums; the sums are whole numbers, so that nothing
/// of them stays.
void Drill::leave_soft(const BoneVolume& volume, Contact& contact, kernel::Sums& sums) noexcept {
  const Burr::Arrays burr = burr_.arrays();
  kernel::Hit* hits = hits_.data() + contact.first;
  std::int32_t kept = 0;
  for (std::int32_t n = 0; n < contact.kept; ++n) {
    if (!soft_[volume.label(hits[n].address)]) {
      hits[kept++] = hits[n];
      continue;
    }
    const std::int32_t i = hits[n].sample;
    --sums.count;
    sums.direction[0] -= burr.dx[i];
    sums.direction[1] -= burr.dy[i];
    sums.direction[2] -= burr.dz[i];
    sums.position[0] -= burr.x[i];
    sums.position[1] -= burr.y[i];
    sums.position[2] -= burr.z[i];
  }
  contact.kept = kept;
}

Removal Drill::remove(BoneVolume& volume, const Contact& contact, double force, double power,
                      double dt) noexcept {
  Removal removal;
  const double spacing = volume.grid().spacing;
  const double voxel = spacing * spacing * spacing;
  const double rate = force * power * dt * burr_.sample_volume() / voxel;
  if (!(force > 0.0 && power > 0.0 && dt > 0.0) || !std::isfinite(rate) ||
      contact.first + contact.kept > kept_) {  // of a tick that was forgotten
    return removal;
  }
  const auto rate_f = static_cast<float>(rate);
  const float* powers = burr_.arrays().power;
  const float* softness = softness_.data();
  const kernel::Hit* hits = hits_.data() + contact.first;
  EmptiedVoxel* emptied = emptied_.data();
  double amount = 0.0;
  for (std::int32_t n = 0; n < contact.kept; ++n) {
    const std::int32_t at = hits[n].address;
    const std::uint8_t label = volume.label(at);
    const float wanted = rate_f * powers[hits[n].sample] * softness[label];
    // Adding 1 rounds to a multiple of 2^-23.
    const float taken = volume.take(at, wanted < 1.0F ? (wanted + 1.0F) - 1.0F : 1.0F);
    amount += static_cast<double>(taken);
    if (taken > 0.0F && !(volume.density(at) > 0.0F)) {
      *emptied++ = {at, label};
    }
  }
  removal.amount = amount;
  removal.volume = amount * voxel;
  removal.emptied = {emptied_.data(), emptied};
  return removal;
}

}  // namespace haptrial::bone
