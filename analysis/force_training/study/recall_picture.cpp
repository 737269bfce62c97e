#include "analysis/force_training/study/recall_picture.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace haptrial::analysis {

std::vector<std::pair<std::string, std::size_t>> notable(const std::vector<TrialScore>& scores) {
  if (scores.empty()) {
    return {};
  }
  std::vector<std::size_t> order(scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a].score < scores[b].score; });
  return {
      {"best", order.front()}, {"median", order[(order.size() - 1) / 2]}, {"worst", order.back()}};
}

RecallPicture recall_picture(const std::string& which, const TrialScore& score,
                             RecallDetail detail) {
  RecallPicture picture{which,
                        score,
                        detail.time.duration,
                        std::move(detail.target),
                        std::move(detail.applied),
                        std::move(detail.warped)};
  for (const auto& point : detail.path) {
    picture.pairs.emplace_back(point.target, point.applied);
  }
  return picture;
}

}  // namespace haptrial::analysis
