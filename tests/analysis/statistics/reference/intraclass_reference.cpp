#include "analysis/statistics/relation/intraclass.h"
#include "tests/analysis/statistics/reference/reference.h"

namespace haptrial::analysis::reference::intraclass_reference {
namespace {

using Eigen::MatrixXd;

MatrixXd columns_of(const std::string& data) {
  const DataSet set(data);
  const auto first = set.numbers("first"), second = set.numbers("second");
  MatrixXd ratings(static_cast<Eigen::Index>(first.size()), 2);
  for (Eigen::Index i = 0; i < ratings.rows(); ++i) {
    ratings(i, 0) = first[static_cast<std::size_t>(i)];
    ratings(i, 1) = second[static_cast<std::size_t>(i)];
  }
  return ratings;
}

void compare_case(Answers& r, const std::string& name, const MatrixXd& ratings) {
  const auto c = intraclass_correlation(ratings);
  std::vector<std::vector<double>> columns(7);
  for (const auto* form : {&c->one_way, &c->random_raters, &c->fixed_raters, &c->one_way_mean,
                           &c->random_raters_mean, &c->fixed_raters_mean}) {
    const IntraclassForm& f = **form;
    std::size_t column = 0;
    for (const double value : {f.value, f.low, f.high, f.f, f.df_targets, f.df_error, f.p}) {
      columns[column++].push_back(value);
    }
  }
  r.at("Intraclass correlation", name)
      .are("value", columns[0])
      .are("low", columns[1])
      .are("high", columns[2])
      .are("f", columns[3])
      .are("df_targets", columns[4])
      .are("df_error", columns[5])
      .are("p", columns[6]);
}

void compare(Answers& r) {
  MatrixXd classic(6, 4);
  classic << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  compare_case(r, "Shrout and Fleiss", classic);
  const auto values = DataSet("ratings").numbers("value");
  compare_case(r, "ratings",
               Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>>(
                   values.data(), static_cast<Eigen::Index>(values.size() / 4), 4));
  compare_case(r, "pairs", columns_of("pairs"));
  compare_case(r, "tied pairs", columns_of("tied_pairs"));
}

const Topic kTopic("intraclass", compare);

}  // namespace
}  // namespace haptrial::analysis::reference::intraclass_reference
