#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "analysis/contact/demo_study/ridge.h"
#include "core/contact/felt_body.h"
#include "core/contact/renderer.h"

namespace haptrial::evaluation {

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
