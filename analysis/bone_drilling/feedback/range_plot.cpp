#include "analysis/bone_drilling/feedback/range_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {

const char* const kPlotStyle = R"css(
.plot { width: 100%; max-width: 27rem; height: auto; display: block; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(19rem, 1fr)); gap: 1rem; }
.plot text { font: 12px system-ui, Arial, sans-serif; fill: var(--ink); }
.plot .axis { stroke: var(--soft); fill: none; }
.plot .band { fill: var(--band); }
.plot .median { stroke: var(--soft); stroke-dasharray: 5 3; fill: none; }
.plot .limit { stroke: var(--soft); stroke-width: 1.5; fill: none; }
.plot .own { fill: var(--accent); fill-opacity: .55; }
.plot .faulty { fill: none; stroke: var(--force); stroke-width: 1.4; }
.plot .joined { stroke: var(--accent); fill: none; stroke-width: 1.5; }
)css";

namespace {

constexpr double kWidth = 420.0, kHeight = 260.0;                           // [px]
constexpr double kLeft = 54.0, kRight = 12.0, kTop = 28.0, kBottom = 44.0;  // margins [px]

/// 1, 2 or 5 times a power of ten, so that about `count` steps fit.
double nice_step(double span, double count) {
  const double rough = span / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (times * power >= rough) {
      return times * power;
    }
  }
  return 10.0 * power;
}

class Drawn {
 public:
  explicit Drawn(const RangePlot& plot) : p_(plot) {
    double low = 0.0, high = 0.0;
    for (const PlotRange& range : p_.ranges) {
      low = std::min(low, range.low);
      high = std::max(high, range.high);
    }
    for (const PlotPoint& point : p_.points) {
      low = std::min(low, point.y);
      high = std::max(high, point.y);
    }
    high = high - low > 1e-9 ? high : low + 1.0;  // nothing but zeros
    step_ = nice_step(high - low, 5.0);
    low_ = step_ * std::floor(low / step_);
    high_ = step_ * std::ceil(high / step_);
  }

  std::string svg() {
    add("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
        kHeight, escape_html(p_.title + ": " + p_.y_label + " over " + p_.x_label));
    ranges();
    axes();
    points();
    add("<text x=\"{}\" y=\"16\">{}</text></svg>\n", kLeft, escape_html(p_.title));
    return std::move(text_);
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> words, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), words, std::forward<Values>(values)...);
  }
  double x(double value) const {
    return kLeft + (kWidth - kLeft - kRight) * (value - p_.x_low) / (p_.x_high - p_.x_low);
  }
  double y(double value) const {
    return kHeight - kBottom - (kHeight - kTop - kBottom) * (value - low_) / (high_ - low_);
  }

  void ranges() {
    for (const PlotRange& r : p_.ranges) {
      const double from = x(r.from), to = x(r.to);
      add("<rect class=\"band\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
          from, y(r.high), to - from, y(r.low) - y(r.high));
      add("<path class=\"limit\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", from, y(r.high), to);
      add("<path class=\"median\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", from, y(r.median), to);
    }
  }

  void axes() {
    add("<path class=\"axis\" d=\"M{0:.1f} {1:.1f}V{2:.1f}H{3:.1f}\"/>", kLeft, kTop,
        kHeight - kBottom, kWidth - kRight);
    for (double value = low_; value <= high_ + 0.5 * step_; value += step_) {
      const double shown = std::abs(value) < 1e-9 * step_ ? 0.0 : value;
      add("<path class=\"axis\" d=\"M{:.1f} {:.1f}h-4\"/>", kLeft, y(value));
      add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>", kLeft - 7.0,
          y(value) + 4.0, shown);
    }
    const double step = nice_step(p_.x_high - p_.x_low, 6.0);
    const double wide = p_.whole_numbers ? std::max(1.0, step) : step;
    for (double value = wide * std::ceil(p_.x_low / wide); value <= p_.x_high + 1e-9;
         value += wide) {
      add("<path class=\"axis\" d=\"M{:.1f} {:.1f}v4\"/>", x(value), kHeight - kBottom);
      add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.4g}</text>", x(value),
          kHeight - kBottom + 17.0, value);
    }
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
        0.5 * (kLeft + kWidth - kRight), kHeight - 8.0, escape_html(p_.x_label));
    add("<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        0.5 * (kTop + kHeight - kBottom), escape_html(p_.y_label));
  }

  void points() {
    if (p_.joined && p_.points.size() > 1) {
      add("<path class=\"joined\" d=\"");
      for (std::size_t n = 0; n < p_.points.size(); ++n) {
        add("{}{:.1f} {:.1f}", n == 0 ? "M" : "L", x(p_.points[n].x), y(p_.points[n].y));
      }
      add("\"/>");
    }
    for (const PlotPoint& point : p_.points) {
      const double at = x(point.x), high = y(point.y);
      if (point.faulty) {
        add("<path class=\"faulty\" d=\"M{0:.1f} {1:.1f}l6 6m0 -6l-6 6\"/>", at - 3.0, high - 3.0);
      } else {
        add("<circle class=\"own\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", at, high,
            p_.joined ? 4.0 : 2.0);
      }
    }
  }

  const RangePlot& p_;
  double low_{0.0}, high_{1.0}, step_{1.0};
  std::string text_;
};

}  // namespace

std::string range_svg(const RangePlot& plot) { return Drawn(plot).svg(); }

}  // namespace haptrial::analysis::drilling
