#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/contact/evaluation/render_contact.h"

namespace haptrial::evaluation {

/// A recording that is ready to be rendered, and the body that it is rendered with.
struct FeltContact {
  const PreparedContact* contact;
  const contact::FeltBody* body;
};

/// Friction that was fitted on one recording, tested on the others.
struct CrossFit {
  std::vector<FrictionFit> own;            // (n) fitted on each recording
  std::vector<std::vector<double>> error;  // (n x n) root mean square of the force error on the
                                           // column's recording with the row's friction [N]

  /// The part of what the own friction gains over none that a foreign one keeps: 1 all of it, 0
  /// none, below 0 worse than no friction; nothing where the own one gains less than a thousandth.
  std::optional<double> kept(std::size_t fitted, std::size_t tested) const;
};

/// @param kind  proxy or ruspini  @throws std::invalid_argument as make_renderer().
CrossFit cross_fit(std::span<const FeltContact> contacts, contact::RendererKind kind,
                   const contact::RendererOptions& options);

}  // namespace haptrial::evaluation
