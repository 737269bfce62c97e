#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/contact/evaluation/prepare_contact.h"
#include "analysis/contact/evaluation/rendering_error.h"
#include "core/contact/renderer.h"

namespace haptrial::evaluation {

/// A renderer's forces for an in-trajectory, and their cost.
struct RenderedContact {
  std::vector<Eigen::Vector3d> force;  // (n) on the tool [N]
  std::vector<Eigen::Vector3d> place;  // (n) of the contact; of the tool if nothing is felt [m]
  std::vector<double> tick_seconds;    // (n) a reading of the clock included, about 25 ns [s]
  double preparation{0.0};             // of the renderer from the mesh and its hierarchy [s]
  double memory{0.0};                  // that it holds beside them [bytes]
  std::size_t lost{0};                 // samples of a contact where nothing is felt
  std::size_t unsettled{0};            // ticks that ended before the proxy was at rest
  contact::Operations operations;      // of all ticks
  contact::Operations most;            // of each kind, in one tick
};

/// @param body     the mesh that is felt; it may be another one than the contact was prepared with
/// @param options  its stiffness is replaced by that of the in-trajectory. A tool with a radius is
///                 led that far outside of the in-trajectory, along the normals.
/// @throws std::invalid_argument as make_renderer().
RenderedContact render_contact(const PreparedContact& contact, const contact::FeltBody& body,
                               contact::RendererKind kind, const contact::RendererOptions& options);

struct FrictionFit {
  double friction{0.0};  // coefficient, static and dynamic alike, 0 to 1.5
  double without{0.0};   // root mean square of the force error without friction [N]
  double with{0.0};      // with it [N]
};

/// The friction that makes the root mean square of the force error least, by rendering again and
/// again: 16 values, then a golden section between the neighbours of the best, to 1e-4.
/// @param kind  proxy or ruspini. Source: Morris 2006, §7.4.2.
FrictionFit fit_friction(const PreparedContact& contact, const contact::FeltBody& body,
                         contact::RendererKind kind, contact::RendererOptions options);

}  // namespace haptrial::evaluation
