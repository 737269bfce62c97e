#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/contact/felt_body.h"
#include "core/contact/renderer.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::evaluation {

/// A plate with a ridge across it, between flanks that rise at an angle: the geometry of the
/// source's Figure 65. The plate's upper face lies in y = 0; the ridge runs along z, its middle at
/// x = 0.
struct Ridge {
  double height{0.002};      // > 0 [m]
  double flank{0.8};         // angle of the flanks to the plate, 0 to pi / 2, both left out [rad]
  double top{0.002};         // of its flat top along x > 0 [m]
  double half_length{0.06};  // of the plate along x; beyond the ridge's feet [m]
  double thickness{0.03};    // of the plate > 0 [m]
  double half_width{0.01};   // along z > 0 [m]

  double foot() const;  // of the rising flank: its x [m]
};

/// Closed, faces outwards. @throws std::invalid_argument naming what breaks its bound
geometry::Mesh ridge_mesh(const Ridge& ridge);

/// A tool that is pulled straight over a ridge, at an even depth behind the plate.
struct RidgeDrag {
  double depth{0.002};   // of the tool behind the plate: force over stiffness > 0 [m]
  double friction{0.0};  // static and dynamic alike >= 0; of proxies alone
  double radius{0.0};    // of the tool >= 0 [m]
  double reach{0.045};   // where the tool stops: its x [m]
  double step{5e-5};     // of a tick along x > 0 [m]
};

enum class RidgeOutcome : std::uint8_t {
  kRight,   // the contact climbs the ridge where the law says, or stays where friction holds it
  kSticks,  // it stays at the foot though nothing holds it there
  kPassesUnder,  // it comes out behind the ridge without having been on top
  kPopsThrough,  // no force while the tool is inside
  kChatters      // it turns to and fro
};
inline constexpr std::array kRidgeOutcomes{RidgeOutcome::kRight, RidgeOutcome::kSticks,
                                           RidgeOutcome::kPassesUnder, RidgeOutcome::kPopsThrough,
                                           RidgeOutcome::kChatters};
const char* name_of(RidgeOutcome outcome);

/// Places of the tool [m, its x] when the contact leaves the foot, and when it comes to the top: by
/// Coulomb's law with mu = tan phi, from the foot at x_f (for a tool of radius r shifted by -r
/// tan(alpha / 2)), with the tool d behind the plate and flanks of angle alpha and height h,
///
///     x - x_f > d tan(alpha + phi)
///     x - x_f > (h / sin alpha + d (sin alpha + mu cos alpha)) / (cos alpha - mu sin alpha)
///
/// Nothing where alpha + phi is a right angle or more: friction holds it.
struct RidgeLaw {
  std::optional<double> leaves_foot, on_top;

  /// Place of the tool when the contact is 5 % of the way up, as RidgeResult::left_foot [m].
  std::optional<double> seen() const {
    return leaves_foot ? std::optional(*leaves_foot + 0.05 * (*on_top - *leaves_foot))
                       : std::nullopt;
  }
};
RidgeLaw ridge_law(const Ridge& ridge, const RidgeDrag& drag);

struct RidgeResult {
  RidgeOutcome outcome{RidgeOutcome::kRight};
  std::optional<double> left_foot;  // the tool's x when the contact was 5 % of the way up [m]
  double highest{0.0};              // of the contact over the plate, at ticks [m]
};

/// @param renderer  of ridge_mesh(ridge), with the drag's friction and radius
RidgeResult drag_over(const Ridge& ridge, const RidgeDrag& drag, contact::Renderer& renderer);

}  // namespace haptrial::evaluation
