#pragma once

#include <cstddef>
#include <vector>

#include "core/scene/field.h"

namespace haptrial::scene {

/// Bound on the field at `which` in a scene; reliefs steepen the surface that they lie on and are
/// counted there. For a field that is not passive K and B hold for its forces from place and
/// velocity; the energy that it gives over time is its purpose.
StiffnessBound stiffness_bound(const std::vector<Field>& fields, std::size_t which);

/// The sum of the bounds of the reliefs that lie on a surface; zero of any other field.
ReliefBound reliefs_on(const std::vector<Field>& fields, const Field& surface);

/// The damping of device and hand with which a sampled field that is passive, or drives motions by
/// D alone, never gives out energy, whatever the hand does between two ticks (Colgate and Schenkel
/// 1997):
///
///     b > K T / 2 + B + max(D, 0),   T = 1 / rate                         [N·s/m]
///
/// Proof for every law of this folder: over a closed way held forces give at most
/// Σ K |Δx|² / 2 + (B + D) |Δx_k-1| |Δx_k| / T, and Σ |Δx|² / T is at most the integral of |v|².
/// Velocities may be any mean of past differences (a slope over readings, a low-pass).
/// @param rate  > 0 [Hz]
double needed_damping(const StiffnessBound& field, double rate) noexcept;

/// The same for hands that do not move faster than `frequency` [Hz], 0 to rate / 2: there the
/// field's own damper helps against its spring,
///
///     b > K T / 2 - B cos(2 pi frequency T),
///
/// with the velocity as the last difference and B in every direction in which K acts. At 0 Hz this
/// is the bound of the virtual coupling, K T / 2 < b + B: what `validate` warns about. A field that
/// drives motions, D > 0, needs D in place of what its damper helps. Negative: nothing is needed.
double needed_damping_below(double frequency, const StiffnessBound& field, double rate) noexcept;

}  // namespace haptrial::scene
