#pragma once

#include <Eigen/Core>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Mauchly's test that all contrasts between conditions vary alike and independently.
/// Source: Mauchly 1940, Annals of Mathematical Statistics 11; p after Anderson 1958, two terms of
/// the expansion in chi squared.
struct Mauchly {
  double w{1.0};  // det S / (tr S / c)^c of the contrasts' covariance S; 0 .. 1
  double p{1.0};
};

/// How far the differences between conditions are from varying alike, and the factors of the
/// degrees of freedom that correct a repeated-measures F for it.
struct Sphericity {
  Defined<Mauchly> mauchly{Undefined{"nothing was measured"}};
  double greenhouse_geisser{1.0};  // 1 / c .. 1
  /// Epsilon that is not cut off: above 1 it corrects nothing. With groups, after Lecoutre 1991.
  Defined<double> huynh_feldt{Undefined{"nothing was measured"}};
};

/// @param products  (c x c) sums of squares and products of orthonormal contrasts, deviations from
///                  the means of the participants' group; not all zero.
/// @param df        participants less groups; at least 1.
/// Mauchly's test is not defined with one contrast, with fewer df than contrasts, or where a
/// contrast does not vary or follows from the others; Huynh and Feldt's factor where df is not
/// above the number of directions in which the contrasts vary.
/// Source: Greenhouse and Geisser 1959, Psychometrika 24; Huynh and Feldt 1976, Journal of
/// Educational Statistics 1; Lecoutre 1991, the same 16.
Sphericity sphericity(const Eigen::MatrixXd& products, double df);

/// An effect within participants, held against its variation between participants.
struct WithinEffect {
  double f{0.0};
  double df{0.0};
  double df_error{0.0};
  double squares{0.0};
  double squares_error{0.0};
  double p{0.0};  // right if the data are spherical
  double partial_eta_squared{0.0};
  Sphericity sphericity{};
  double p_greenhouse_geisser{0.0};  // both degrees of freedom times the factor
  Defined<double> p_huynh_feldt{Undefined{"nothing was measured"}};  // the factor at most 1
};

/// Steps that the repeated-measures and mixed analyses share: a participant's row of cell values
/// becomes scores in orthonormal contrasts c of the cells; constant offsets of a participant drop
/// out.
///
///     y_i = C' x_i      effect: N |mean y|²      error: S = sum (y_i - mean y)(y_i - mean y)'
namespace within {

using Table = std::vector<std::vector<double>>;  // (participants x cells)

/// (levels x levels - 1), columns orthonormal and orthogonal to the constant.
Eigen::MatrixXd contrasts(std::size_t levels);
/// (levels x 1), the normalized constant.
Eigen::MatrixXd constant(std::size_t levels);
/// The contrasts of cells (a, b), b running fastest: the Kronecker product.
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// (participants x contrasts); each participant's first value is subtracted before.
Eigen::MatrixXd scores(const Table& table, const Eigen::MatrixXd& contrasts);
/// (contrasts x contrasts) sums of squares and products of the deviations from the column means.
Eigen::MatrixXd products(const Eigen::MatrixXd& scores);

/// The F test of an effect.
/// @param df        of the effect.
/// @param products  of its error, (c x c).
/// @param df_rows   participants less groups.
/// @param rounding  sums of squares of the error up to this are what rounding made.
Defined<WithinEffect> tested(double squares, double df, const Eigen::MatrixXd& products,
                             double df_rows, double rounding);

/// The squares that rounding alone can make of a table.
double rounding_squares(const Table& table);
/// Why a table cannot be analysed; empty when it can.
std::string problem(const Table& table);

}  // namespace within
}  // namespace haptrial::analysis
