#pragma once

#include <filesystem>

#include "analysis/contact/recording/streams.h"

namespace haptrial::analysis {
class CsvTable;
}

namespace haptrial::evaluation {

/// Poses from a table with named columns, the unit at the end of the name:
///
///     time_s (or time_ms, time_us)   x_m, y_m, z_m (or _mm)   qw, qx, qy, qz
///
/// Other columns are passed over. Orientations may be scaled by up to one percent; without q
/// columns they are the identity. Rows with equal times: the last one counts.
/// @throws InputError with one sentence: the file, the line and column, what was found, what is
/// allowed.
PoseStream read_poses(const analysis::CsvTable& table);

/// Forces from a table: time as above, force_x_N, force_y_N, force_z_N (or _mN) and, if there,
/// torque_x_Nm, torque_y_Nm, torque_z_Nm (or _Nmm).
ForceStream read_forces(const analysis::CsvTable& table);

/// Reads both streams, from two files or from one that has all columns. Samples that repeat the one
/// before are left out (see changes()).
/// @throws InputError also when the streams have no second in common.
ContactRecording read_recording(const std::filesystem::path& poses,
                                const std::filesystem::path& forces);

}  // namespace haptrial::evaluation
