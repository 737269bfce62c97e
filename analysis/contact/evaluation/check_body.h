#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/contact/felt_body.h"

namespace haptrial::evaluation {

/// Whether a mesh can be evaluated: inside and outside must be where its faces say.
/// @throws std::invalid_argument, a sentence that begins after the mesh's name: closed faces that
/// look inwards.
void check_body(const contact::FeltBody& body);

/// Sentences about what a mesh is not good for: an open one.
std::vector<std::string> body_remarks(const contact::FeltBody& body);

/// The diagonal of the box around points; 0 for none [m].
double path_size(std::span<const Eigen::Vector3d> points);

/// @param contacts  at least one [m]
/// @throws std::invalid_argument if they cannot lie on a body of that size, or are a speck beside
/// it: most often a mesh in another unit.
void check_size(const contact::FeltBody& body, std::span<const Eigen::Vector3d> contacts);

}  // namespace haptrial::evaluation
