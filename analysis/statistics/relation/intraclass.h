#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// One form of the intraclass correlation, with its interval and the test against 0.
struct IntraclassForm {
  double value{0.0};
  double low{0.0};
  double high{0.0};
  double f{0.0};
  double df_targets{0.0};
  double df_error{0.0};
  double p{0.0};  // one-sided: larger than 0
};

/// How well raters agree who each rated every target. The mean squares:
///
///     targets BMS, raters JMS, error EMS, within targets WMS
///
///     one_way         (1,1)  raters differ from target to target
///     random_raters   (2,1)  the same raters, a sample of those one could ask: agreement
///     fixed_raters    (3,1)  these raters only, their means aside: consistency
///
/// and of the mean over k raters (1,k), (2,k), (3,k).
struct Intraclass {
  std::size_t targets{0};
  std::size_t raters{0};
  double mean_square_targets{0.0};
  double mean_square_raters{0.0};
  double mean_square_error{0.0};
  double mean_square_within{0.0};
  Defined<IntraclassForm> one_way{Undefined{""}};
  Defined<IntraclassForm> random_raters{Undefined{""}};
  Defined<IntraclassForm> fixed_raters{Undefined{""}};
  Defined<IntraclassForm> one_way_mean{Undefined{""}};
  Defined<IntraclassForm> random_raters_mean{Undefined{""}};
  Defined<IntraclassForm> fixed_raters_mean{Undefined{""}};
};

/// @param ratings  (targets x raters), each rated by each.
/// @param level    coverage of the intervals, inside (0, 1).
/// Undefined with fewer than two targets or raters, a value that is not finite, or equal ratings
/// throughout. A form is undefined where its error mean square is 0: then it has no interval.
/// Source: Shrout and Fleiss 1979, Psychological Bulletin 86; McGraw and Wong 1996, Psychological
/// Methods 1.
Defined<Intraclass> intraclass_correlation(const Eigen::MatrixXd& ratings, double level = 0.95);

}  // namespace haptrial::analysis
