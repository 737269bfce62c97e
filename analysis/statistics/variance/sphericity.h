#pragma once

#include <Eigen/Core>

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

}  // namespace haptrial::analysis
