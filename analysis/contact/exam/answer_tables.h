#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/exam/candidate.h"
#include "analysis/files/csv.h"

namespace haptrial::evaluation {

inline constexpr std::array kForces{"force_x_N", "force_y_N", "force_z_N"};
inline constexpr std::array kTorques{"torque_x_Nm", "torque_y_Nm", "torque_z_Nm"};

/// Three columns of a table as vectors.
std::vector<Eigen::Vector3d> vectors_of(const analysis::CsvTable& table,
                                        const std::array<const char*, 3>& names);

/// Forces, and torques of rigid tools, a row each. Forces to a millionth of a newton.
std::string answer_csv(const std::vector<Answer>& answers, bool rigid);
std::vector<Answer> answers_of(const analysis::CsvTable& table, bool rigid);

/// The shapes at some samples, a row for each vertex, to a nanometre.
std::string shape_csv(const std::vector<std::size_t>& samples, const std::vector<Answer>& answers);
/// @param answers  (n), get their shapes
/// @throws InputError for rows that are not those of the samples and vertices, in this order.
void read_shapes(const std::filesystem::path& file, const std::vector<std::size_t>& samples,
                 std::size_t vertices, std::vector<Answer>& answers);

}  // namespace haptrial::evaluation
