#pragma once

#include <string>
#include <vector>

namespace haptrial::analysis::drilling {

/// The experts' range over a stretch of x.
struct PlotRange {
  double from{0.0}, to{0.0};
  double low{0.0}, median{0.0}, high{0.0};
};

struct PlotPoint {
  double x{0.0}, y{0.0};
  bool faulty{false};  // another colour and shape
};

/// A trainee's values in front of the range of experts.
struct RangePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  double x_low{0.0}, x_high{1.0};  // x_low < x_high
  bool whole_numbers{false};       // on x
  bool joined{false};              // points, by a line
  std::vector<PlotRange> ranges;
  std::vector<PlotPoint> points;
};

/// The plot as an element of a page, which colours it (kPlotStyle). Texts are escaped.
std::string range_svg(const RangePlot& plot);

/// Classes of range_svg() in the colours of the page's variables.
extern const char* const kPlotStyle;

}  // namespace haptrial::analysis::drilling
