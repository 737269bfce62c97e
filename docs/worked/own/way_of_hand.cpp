// haptrial with one score more: how far the hand went in each pass.
#include "analysis/exchange/score.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/line/whole_command.h"

namespace {

using namespace haptrial;

class WayOfHand final : public analysis::Score {
 public:
  std::string_view name() const override { return "way"; }
  std::string_view unit() const override { return "m"; }
  std::vector<analysis::ScoreValue> values(const record::SessionReader& session) const override {
    std::vector<analysis::ScoreValue> found;
    int number = 0;
    for (const record::PassRow& pass : session.passes()) {
      const auto columns =
          session.columns(pass.first_sample, pass.last_sample - pass.first_sample + 1);
      double way = 0.0;
      for (Eigen::Index i = 1; i < columns.position.cols(); ++i) {
        way += (columns.position.col(i) - columns.position.col(i - 1)).norm();
      }
      found.push_back({number++, way});
    }
    return found;
  }
};

}  // namespace

int main(int argc, char** argv) {
  static const WayOfHand way;
  return experiments::whole_command(argc, argv, [] { analysis::add_score(way); });
}
