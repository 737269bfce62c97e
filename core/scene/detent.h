#pragma once

#include <Eigen/Core>
#include <numbers>

#include "core/scene/field_state.h"
#include "core/scene/low_pass.h"

namespace haptrial::scene {

class Detent;
class Click;

struct DetentParameters {
  using Law = Detent;
  Eigen::Vector3d at{Eigen::Vector3d::Zero()};          // of the first rest position [m]
  Eigen::Vector3d direction{Eigen::Vector3d::UnitX()};  // u, any length above 0
  double spacing{0.01};                                 // of rest positions > 0 [m]
  double peak{1.0};                                     // force between them, 0 to the limit [N]
  int count{0};                                         // of rest positions; 0: endless

  StiffnessBound bound() const { return {true, 2.0 * std::numbers::pi * peak / spacing, 0.0}; }
  FieldTraits traits() const { return {}; }
};

/// Rest positions along a direction: f = -peak sin(2 pi s / spacing) u with s = u · (p - at), for s
/// from -spacing/2 to (count - 1/2) spacing, 0 beyond. Conservative.
class Detent {
 public:
  Detent(const DetentParameters& parameters, const Setting& setting);
  void start(const PointState& hand) noexcept { way_.start(hand.velocity); }
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Detent& before) noexcept;
  double energy(const Eigen::Vector3d& p) const noexcept;  // [J]

 private:
  double within(const Eigen::Vector3d& p) const noexcept;

  DetentParameters parameters_;
  Eigen::Vector3d direction_;
  double wave_;  // 2 pi / spacing [1/m]
  OwnWay way_;
  PassingWatch passing_;
  double period_;  // of a tick [s]
};

struct ClickParameters {
  using Law = Click;
  Eigen::Vector3d at{Eigen::Vector3d::Zero()};           // on the key's top [m]
  Eigen::Vector3d direction{-Eigen::Vector3d::UnitY()};  // of the press u, any length above 0
  double peak{2.0};            // force that breaks through, 0 to limit [N]
  double travel{0.003};        // from the top to the peak > 0 [m]
  double drop{1.2};            // force lost at the click, 0 to peak [N]
  double drop_travel{0.0005};  // over which it is lost > 0 [m]

  StiffnessBound bound() const { return {true, peak / travel, 0.0}; }
  FieldTraits traits() const { return {}; }
};

/// A key: with d = u · (p - at) the force -F(d) u rises to peak over travel, falls by drop along
/// half a cosine over drop_travel, and stays. Endless across u. Conservative, as the way back is
/// the same.
class Click {
 public:
  Click(const ClickParameters& parameters, const Setting& setting);
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  double energy(const Eigen::Vector3d& p) const noexcept;  // [J]

 private:
  ClickParameters parameters_;
  Eigen::Vector3d direction_;
};

}  // namespace haptrial::scene
