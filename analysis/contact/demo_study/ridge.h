#pragma once

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

}  // namespace haptrial::evaluation
