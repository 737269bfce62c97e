#pragma once

#include <filesystem>

#include "core/bone/data/volume_source.h"

/// The readers, one for each library. They run in a process of their own: see read_volume().
namespace haptrial::bone {

/// End of the format's name for a file that names no unit of length.
inline constexpr const char* kNoUnit = ", without a unit of length, so in mm";

/// The note of a file that does not say how its axes lie in the patient.
std::string assumed_orientation(const std::string& name, const char* assumed);

SourceVolume read_nrrd(const std::filesystem::path& file, const Room& room);
SourceVolume read_nifti(const std::filesystem::path& file, const Room& room);
/// A folder with one series, or one file with many frames.
SourceVolume read_dicom(const std::filesystem::path& path, const Room& room);

/// The reader for a path. @throws InputError where there is none.
SourceVolume read_here(const std::filesystem::path& path, const Room& room);

/// @throws InputError unless sizes are from 1 to 32767 and few enough for room, and the steps are
/// finite and span a volume.
void check_head(const std::string& name, const VolumeHead& head, const Room& room);

}  // namespace haptrial::bone
