#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/definition/table.h"

namespace haptrial {

/// A required array of three numbers, x, y and z, each within the bounds. In a table with numbers()
/// a text may stand for it, or for one of its numbers.
/// @returns `otherwise` after a problem, which is noted
Eigen::Vector3d read_vector(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit,
                            const Eigen::Vector3d& otherwise = Eigen::Vector3d::Zero());

/// The same for a direction: numbers from -1 to 1, not all zero. @returns it with length 1; y after
/// a problem
Eigen::Vector3d read_direction(Table& table, std::string_view key);

/// A required direction of any length above 0, which it keeps.
Eigen::Vector3d read_any_direction(Table& table, std::string_view key);

/// A list of places: [[x, y, z], …], or texts that stand for one each.
std::vector<Eigen::Vector3d> read_vectors(Table& table, std::string_view key, const Bounds& bounds,
                                          std::string_view unit);

/// Three rows of three numbers, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]].
Eigen::Matrix3d read_matrix(Table& table, std::string_view key, const Bounds& bounds,
                            std::string_view unit);

/// A required whole number from 0 to 2^53.
std::uint64_t read_seed(Table& table, std::string_view key);

/// Bits of an array of whole numbers from 0 to 30, such as those of buttons. Other numbers are a
/// problem, which is noted.
std::uint32_t read_bits(Table& table, std::string_view key);

}  // namespace haptrial
