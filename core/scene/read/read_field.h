#pragma once

#include <string>
#include <vector>

#include "core/scene/field.h"
#include "core/scene/read/number_source.h"

namespace haptrial::scene {

/// Reads one table [fields.NAME]: `type`, the keys of its kind (core/scene/field has their laws),
/// and for every kind but reliefs the optional limit [N], fade_in and fade_out [s]. Keys in
/// brackets are optional. Problems are noted in the table; a field comes back all the same.
///
///     constant        force
///     ramp            to, rise, [from]
///     pulse           force, duration, [delay], [rise]
///     spring          to, stiffness, damping
///     wall            point, normal, stiffness, damping
///     box             centre, size, [turn], [felt_from], stiffness, damping
///     sphere          centre, radius, [felt_from], stiffness, damping
///     cylinder        centre, axis, radius, [length], [felt_from], stiffness, damping
///     channel         axes and through, or from and to; stiffness, damping
///     plane           through, normal, stiffness, damping
///     viscous         damping, [velocity_filter]
///     matrix_viscous  matrix, velocity_filter
///     inertia         mass, acceleration_filter
///     friction        static, dynamic, [on], [stiffness], [model]
///     grating         on, direction, amplitude, period, [phase], [profile]
///     texture         on, normal, roughness, lowest, highest, seed
///     vibration       direction, and amplitude, frequency, [phase] or rms, lowest, highest, seed
///     tap             amplitude, frequency, decay, and direction or on
///     detent          at, direction, spacing, peak, [count]
///     click           at, direction, peak, travel, drop, drop_travel
///     minimum_jerk    to, duration, stiffness, damping
///     path            points, [[x, y, z], …], or curve = { length_x, range_z, seed, [sinusoids],
///                     [max_spatial_frequency] }; duration, stiffness, damping
///
/// limit is 10 N if left out; the fades are 0.05 s, 0 for ramp, pulse, vibration, tap,
/// minimum_jerk.
/// @param rate  of the servo loop [Hz]: vibrations stay below half of it
Field read_field(Table& table, std::string name, double rate, const NumberSource& source = {});

/// Every table of [fields], and whether what lies `on` something lies on a wall, box, sphere or
/// cylinder of them, or on one of `objects`.
std::vector<Field> read_fields(Table& fields, double rate, const NumberSource& source = {},
                               const std::vector<Field>& objects = {});

}  // namespace haptrial::scene
