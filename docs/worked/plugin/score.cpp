// A score: how far the hand went in each pass.
#include "analysis/scores/score.h"
#include "core/record/read/session_reader.h"
#include "experiments/plugin/plugin.h"

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

void add(experiments::PluginParts& parts) {
  static const WayOfHand way;
  parts.score(way);
}

}  // namespace

HAPTRIAL_PLUGIN("way-of-hand", "1.0", add)
