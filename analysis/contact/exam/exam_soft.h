#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "analysis/contact/exam/soft_body.h"
#include "core/deformable/body/block_matrix.h"

namespace haptrial::evaluation {

/// A soft block of the exam and what happens to it while `s` goes from 0 to 1.
/// Source: Morris 2006, §7.5, for bodies of §5.3.
struct ExamSoft {
  std::string name;                   // "beam bent"
  SoftBody (*body)(int fine);         // cells of 1 / fine of the exam's
  Eigen::Vector3d (*tool)(double s);  // its displacement, none at 0 [m]
  double (*load)(double s);           // share of the body's forces, none at 0
};

/// A beam bent by a tool and by forces, a block pressed and sheared, two layers pressed, a thin
/// plate pressed.
const std::vector<ExamSoft>& exam_softs();

/// A block that nothing holds: forces push it off its centre for a while.
SoftBody free_block();
/// The share of its forces at a time [s]: none from 0.1 s on.
double free_load(double time);

/// A body at rest.
struct SoftRest {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the hand [N]
  deformable::Vectors shape;                       // displacements of the exam's vertices [m]
};

/// States at rest for each s, which is what a body's path comes back to: neo-Hookean elements at
/// seven places of s with a polynomial between them (Chebyshev), on cells of a half of the exam's
/// and on the exam's, continued to cells of no size as errors that fall with the square of the
/// cells do. docs/algorithms/exam.md says how exact that is.
/// @param fine  cells of 1 / (2 fine) and 1 / fine of the exam's
std::vector<SoftRest> true_softs(const ExamSoft& one, const std::vector<double>& s, int fine = 1);

/// Elements alone on cells of 1 / fine of the exam's, at one s.
SoftRest soft_rest(const ExamSoft& one, double s, int fine);

}  // namespace haptrial::evaluation
