#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/document/figure.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::protocols {
struct ForcePlane;
}

namespace haptrial::experiments {

inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};

/// Look of the curves of a figure, one after the other: they differ in colour and dash.
analysis::Look curve_look(std::size_t at);

/// A row of a timeline.
struct TimelineBar {
  std::string label;     // left of the bars
  std::string words;     // beside the bar
  double shortest{0.0};  // [s]
  bool waits{false};     // for something that the participant does
};

/// Bars one after the other, each in a row of its own, as SVG. Parts that wait are drawn 1 s longer
/// than they must last, dashed.
std::string timeline_svg(const std::vector<TimelineBar>& bars);

/// A picture with words below it.
struct GalleryPicture {
  std::string png;          // bytes of a file
  int width{1}, height{1};  // [px]
  std::string words;
};

/// Pictures side by side in rows of three, as SVG.
std::string gallery_svg(const std::vector<GalleryPicture>& pictures);

/// Arrows of the same length along the force, darker where it is stronger, as SVG with a scale. A
/// plane with z has it pointing down, as seen from above.
std::string arrows_svg(const protocols::ForcePlane& plane);

/// The figure of a timeline, with its caption.
analysis::Figure timeline_figure(std::size_t bars);
/// The figure of a gallery, with its caption. @param words  about each picture
analysis::Figure gallery_figure(const std::vector<std::string>& words, const std::string& caption);

/// "1 comparison: press"; without the interval in a trial of one.
std::string stage_name(const protocols::PreviewedTrial& trial, const protocols::StagePlace& place);

/// The names of stages, one after the other.
std::string stage_names(const protocols::PreviewedTrial& trial,
                        const std::vector<protocols::StagePlace>& places);

}  // namespace haptrial::experiments
