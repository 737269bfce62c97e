#pragma once

#include <map>
#include <string>

#include "core/bone/data/volume_source.h"

namespace haptrial::bone {

/// Whether key/values name segments of 3D Slicer.
bool names_segments(const std::map<std::string, std::string>& keys);

/// Joins the layers of a segmentation of 3D Slicer (.seg.nrrd) to one label per voxel: values
/// become the segments' numbers from 1 on, in the file's order, and the keys say so. Layers overlap
/// where segments do; there plain bone gives way to all else, and of all else the last segment
/// stays. The format tells how many voxels that concerns. A volume with one value per voxel stays
/// as it is.
/// @throws InputError where a segment has no layer of the file, or there are more than 255.
void join_layers(const std::string& name, SourceVolume& source);

}  // namespace haptrial::bone
