#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::protocols {

/// The path that the tool took in a recorded pass, to guide others along.
///
/// @param from    "FILE.h5:TRIAL": the run of the trial's last completed pass
/// @param folder  to which a relative FILE refers
/// @returns // (N x 3) [m], a point for every quarter of a millimetre of the way, so that an
///   encoder's steps and a resting hand's tremor do not lengthen it. y is 0: it belongs to the
///   force.
/// @throws InputError when there is no such pass or it did not go anywhere.
std::vector<Eigen::Vector3d> recorded_path(const std::string& from,
                                           const std::filesystem::path& folder);

}  // namespace haptrial::protocols
