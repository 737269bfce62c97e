#include "analysis/force_training/report/recall_figure.h"

#include <algorithm>

#include "analysis/document/palette.h"

namespace haptrial::analysis {
namespace {

constexpr std::size_t kPairs = 60;  // drawn of the path

constexpr Look kTarget{palette::kOrange, palette::kSolid, 0, 2.5};
constexpr Look kApplied{palette::kGrey, palette::kShort, 0, 2.0};
constexpr Look kWarped{palette::kBlue, palette::kLong, 0, 2.5};
constexpr Look kPairing{palette::kPale, palette::kSolid, 0, 0.8};

std::vector<double> instants(const TimeBase& base) {
  std::vector<double> times(base.samples);
  for (std::size_t k = 0; k < base.samples; ++k) {
    times[k] = base.step() * static_cast<double>(k);
  }
  return times;
}

}  // namespace

Figure recall_figure(const RecallDetail& recall, const std::string& unit) {
  Figure figure;
  figure.name = "alignment";
  figure.title = "Alignment of the applied curve with the target";
  figure.x_label = "Time [s]";
  figure.y_label = unit.empty() ? "Value" : "Value [" + unit + "]";
  figure.x_range = Range{0.0, recall.time.duration};
  const std::vector<double> times = instants(recall.time);
  Series pairs{"paired samples", Mark::kSegments, kPairing};
  const std::size_t stride = std::max<std::size_t>(1, recall.path.size() / kPairs);
  for (std::size_t k = 0; k < recall.path.size(); k += stride) {
    const auto [target, applied] = recall.path[k];
    pairs.x.push_back(times[target]);
    pairs.y.push_back(recall.target[target]);
    pairs.x2.push_back(times[applied]);
    pairs.y2.push_back(recall.applied[applied]);
  }
  figure.series = {pairs,
                   {"target", Mark::kLine, kTarget, times, recall.target},
                   {"applied", Mark::kLine, kApplied, times, recall.applied},
                   {"applied, warped", Mark::kLine, kWarped, times, recall.warped}};
  figure.alt =
      "Target and applied curve over time, joined by the lines of the alignment, and the "
      "applied curve after warping.";
  return figure;
}

}  // namespace haptrial::analysis
