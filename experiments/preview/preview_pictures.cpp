#include "experiments/preview/preview_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/document/html.h"
#include "analysis/document/palette.h"
#include "core/base/counted.h"
#include "protocols/psychophysics/preview/felt_forces.h"

namespace haptrial::experiments {
namespace {

using analysis::escape_html;

constexpr double kWide = 900.0;  // of a picture [px]
constexpr const char* kFont = "font-family=\"Helvetica,Arial,sans-serif\"";

std::string opening(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\"><rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>",
      width, height);
}

std::string text_at(double x, double y, const char* anchor, const std::string& words,
                    double size = 13.0) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {} font-size=\"{:g}\" "
      "fill=\"{}\">{}</text>",
      x, y, anchor, kFont, size, analysis::palette::kBlack, escape_html(words));
}

std::string line_from(double x, double y, double x2, double y2, const std::string& style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>", x, y, x2,
                     y2, style);
}

/// 1, 2 or 5 times a power of ten, so that few marks stand within the span.
double mark_step(double span, double marks) {
  const double raw = span / marks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

constexpr double kWaiting = 1.0;  // for which something that waits is drawn [s]

double drawn_length(const TimelineBar& bar) { return bar.shortest + (bar.waits ? kWaiting : 0.0); }

/// Layout of a timeline [px].
struct Rows {
  double left{210.0};   // where time begins
  double right{740.0};  // and ends
  double row{26.0};
  double top{8.0};
  double seconds{1.0};  // in all

  double x(double time) const { return left + (right - left) * time / seconds; }
  double y(std::size_t at) const { return top + row * static_cast<double>(at); }
};

/// The first letters of UTF-8 text, with three dots where it is longer.
std::string shortened(std::string words, std::size_t letters) {
  if (words.size() <= letters) {
    return words;
  }
  std::size_t end = letters > 3 ? letters - 3 : 0;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0U) == 0x80U) {
    --end;
  }
  words.resize(end);
  return words + "...";
}

/// Words on the side that has room, else as small as can be read on the wider side, and cut there:
/// the table below the picture has all of them.
/// @param room_left  [px]  @param right, left  where the words begin or end
std::string words_beside(const std::string& words, double room_left, double right, double left,
                         double y) {
  constexpr double kLetter = 6.0;  // about the width of one at 13 px [px]
  constexpr double kUsual = 13.0, kSmallest = 8.0;
  const double needed = kLetter * static_cast<double>(words.size());
  const bool at_left = needed > kWide - right && room_left > kWide - right;
  const double room = at_left ? room_left : kWide - right;
  const double size = std::clamp(kUsual * room / needed, kSmallest, kUsual);
  const auto letters = static_cast<std::size_t>(std::max(0.0, room * kUsual / (kLetter * size)));
  return text_at(at_left ? left : right, y, at_left ? "end" : "start", shortened(words, letters),
                 size);
}

std::string bar_of(const TimelineBar& bar, double begin, std::size_t at, const Rows& rows) {
  constexpr double kThick = 15.0;
  const double y = rows.y(at) + 0.5 * (rows.row - kThick);
  const double x = rows.x(begin);
  const double solid = rows.x(begin + bar.shortest) - x;
  std::string svg = text_at(rows.left - 10.0, y + 12.0, "end", bar.label);
  if (bar.waits) {
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\" fill=\"#eef4f9\" "
        "stroke=\"{}\" stroke-dasharray=\"5,3\"/>",
        x, y, rows.x(begin + drawn_length(bar)) - x, kThick, analysis::palette::kBlue);
  }
  svg +=
      fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:g}\" fill=\"{}\"/>",
                  x, y, std::max(solid, bar.waits ? 0.0 : 1.5), kThick, analysis::palette::kBlue);
  return svg + words_beside(bar.words, x - 7.0 - rows.left, rows.x(begin + drawn_length(bar)) + 7.0,
                            x - 7.0, y + 12.0);
}

std::string time_axis(const Rows& rows, std::size_t count) {
  const double bottom = rows.y(count) + 4.0;
  std::string svg;
  const double step = mark_step(rows.seconds, 8.0);
  for (double t = 0.0; t <= rows.seconds + 1e-9; t += step) {
    svg += line_from(rows.x(t), rows.top, rows.x(t), bottom, "stroke=\"#e3e5e8\"");
    svg += text_at(rows.x(t), bottom + 17.0, "middle", fmt::format("{:g}", t));
  }
  return svg + text_at(rows.right, bottom + 36.0, "end",
                       "time [s], if whatever waits takes 1 s longer than it must");
}

/// From pale to dark; the palest can still be told from white.
std::string shade(double share) {
  const auto mix = [&](int pale, int dark) {
    return static_cast<int>(std::lround(pale + share * (dark - pale)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(0x8f, 0x08), mix(0xb8, 0x22), mix(0xde, 0x55));
}

std::string arrow(double x, double y, double along, double up, double length,
                  const std::string& colour) {
  const double dx = 0.5 * length * along, dy = -0.5 * length * up;
  const double head = 0.36;  // of the half length
  const double tip_x = x + dx, tip_y = y + dy;
  const double neck_x = tip_x - 2.0 * head * dx, neck_y = tip_y - 2.0 * head * dy;
  return line_from(x - dx, y - dy, neck_x, neck_y,
                   fmt::format("stroke=\"{}\" stroke-width=\"2.4\"", colour)) +
         fmt::format("<polygon points=\"{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}\" fill=\"{}\"/>",
                     tip_x, tip_y, neck_x - head * dy, neck_y + head * dx, neck_x + head * dy,
                     neck_y - head * dx, colour);
}

std::string scale_of_shades(double most, double left, double top) {
  std::string svg = text_at(left, top - 12.0, "start", "force in the plane [N]");
  constexpr int kSteps = 5;
  for (int i = 0; i < kSteps; ++i) {
    const double share = static_cast<double>(i + 1) / kSteps;
    const double y = top + 26.0 * i;
    svg += arrow(left + 17.0, y + 8.0, 1.0, 0.0, 30.0, shade(share));
    svg += text_at(left + 44.0, y + 12.5, "start", fmt::format("{:.3g}", share * most));
  }
  svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\" fill=\"#5f6368\"/>",
                     left + 17.0, top + 26.0 * kSteps + 8.0);
  return svg + text_at(left + 44.0, top + 26.0 * kSteps + 12.5, "start", "none");
}

/// Words in lines of at most so many letters, if no word is longer.
std::vector<std::string> lines_of_words(const std::string& words, std::size_t letters) {
  std::vector<std::string> lines(1);
  std::size_t at = 0;
  while (at < words.size()) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    const std::string word = words.substr(at, end - at);
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > letters) {
      lines.emplace_back();
    }
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines;
}

}  // namespace

analysis::Look curve_look(std::size_t at) {
  namespace palette = analysis::palette;
  static constexpr std::array kCurveLooks{
      analysis::Look{palette::kBlue, palette::kSolid, 7, 3.0, 1.0},
      analysis::Look{palette::kOrange, palette::kLong, 7, 2.6, 1.0},
      analysis::Look{palette::kGreen, palette::kMixed, 7, 2.6, 1.0},
      analysis::Look{palette::kBlack, palette::kShort, 7, 2.0, 1.0},
      analysis::Look{palette::kPurple, palette::kLong, 7, 2.0, 1.0},
      analysis::Look{palette::kGrey, palette::kSolid, 7, 2.0, 1.0}};
  return kCurveLooks[at % kCurveLooks.size()];
}

analysis::Figure timeline_figure(std::size_t bars) {
  analysis::Figure figure;
  figure.name = "timeline";
  figure.title = "Stages of the trial";
  figure.caption =
      "Solid: time that passes in any case. Dashed: until something happens, drawn as 1 s.";
  figure.alt = fmt::format("{} one after the other; the table below has them.",
                           counted(bars, "stage or question", "stages and questions"));
  return figure;
}

analysis::Figure gallery_figure(const std::vector<std::string>& words, const std::string& caption) {
  analysis::Figure figure;
  figure.name = "seen";
  figure.title = "Pictures of the stages and questions";
  figure.caption = caption;
  figure.alt = fmt::format("{}.", fmt::join(words, "; "));
  return figure;
}

std::string timeline_svg(const std::vector<TimelineBar>& bars) {
  Rows rows;
  rows.seconds = 0.0;
  for (const TimelineBar& bar : bars) {
    rows.seconds += drawn_length(bar);
  }
  rows.seconds = std::max(rows.seconds, 0.1);
  std::string svg = opening(kWide, rows.y(bars.size()) + 48.0) + time_axis(rows, bars.size());
  double begin = 0.0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    svg += bar_of(bars[i], begin, i, rows);
    begin += drawn_length(bars[i]);
  }
  return svg + "</svg>\n";
}

std::string gallery_svg(const std::vector<GalleryPicture>& pictures) {
  constexpr std::size_t kColumns = 3;
  constexpr double kGap = 18.0, kLine = 15.0;
  const double width = (kWide - kGap * (kColumns - 1)) / kColumns;
  const auto letters = static_cast<std::size_t>(width / 6.1);
  double top = 1.0;
  std::string svg;
  for (std::size_t first = 0; first < pictures.size(); first += kColumns) {
    double tallest = 0.0;
    for (std::size_t i = first; i < std::min(first + kColumns, pictures.size()); ++i) {
      const GalleryPicture& each = pictures[i];
      const double x = (width + kGap) * static_cast<double>(i - first);
      const double height = width * each.height / each.width;
      svg += fmt::format(
          "<image x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" "
          "href=\"data:image/png;base64,{4}\"/><rect x=\"{0:.1f}\" y=\"{1:.1f}\" "
          "width=\"{2:.1f}\" height=\"{3:.1f}\" fill=\"none\" stroke=\"#5f6368\"/>",
          x, top, width, height, analysis::base64(each.png));
      double y = top + height + kLine;
      for (const std::string& line : lines_of_words(each.words, letters)) {
        svg += text_at(x, y, "start", line, 12.0);
        y += kLine;
      }
      tallest = std::max(tallest, y - top);
    }
    top += tallest + 6.0;
  }
  return opening(kWide, top) + svg + "</svg>\n";
}

std::string arrows_svg(const protocols::ForcePlane& plane) {
  constexpr double kLeft = 120.0, kTop = 20.0, kSide = 520.0;
  const Eigen::Vector3d first = plane.places.front(), last = plane.places.back();
  const double low = first[plane.across], high = last[plane.across];
  const double bottom = first[plane.up], top = last[plane.up];
  const auto x = [&](double at) { return kLeft + kSide * (at - low) / (high - low); };
  const bool down = plane.up == 2;  // z points towards the participant: down, as seen from above
  const auto y = [&](double at) {
    return kTop + kSide * (down ? at - bottom : top - at) / (top - bottom);
  };
  double most = 0.0;
  for (const Eigen::Vector3d& force : plane.forces) {
    most = std::max(most, std::hypot(force[plane.across], force[plane.up]));
  }
  std::string svg = opening(kWide, kTop + kSide + 60.0);
  svg += fmt::format(
      "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" "
      "stroke=\"#444444\"/>",
      kLeft - 15.0, kTop - 15.0, kSide + 30.0, kSide + 30.0);
  const double step = mark_step(1e3 * (high - low), 7.0);
  for (double mm = step * std::ceil(1e3 * low / step); mm <= 1e3 * high + 1e-6; mm += step) {
    svg += text_at(x(1e-3 * mm), kTop + kSide + 34.0, "middle", fmt::format("{:g}", mm + 0.0));
  }
  for (double mm = step * std::ceil(1e3 * bottom / step); mm <= 1e3 * top + 1e-6; mm += step) {
    svg += text_at(kLeft - 22.0, y(1e-3 * mm) + 4.5, "end", fmt::format("{:g}", mm + 0.0));
  }
  svg += text_at(kLeft + 0.5 * kSide, kTop + kSide + 54.0, "middle",
                 fmt::format("{} [mm]", kAxisNames[static_cast<std::size_t>(plane.across)]));
  svg += text_at(4.0, kTop + 0.5 * kSide - 10.0, "start",
                 fmt::format("{} [mm]", kAxisNames[static_cast<std::size_t>(plane.up)]));
  const double length = 0.8 * kSide / static_cast<double>(plane.columns - 1);
  for (std::size_t i = 0; i < plane.places.size(); ++i) {
    const double fx = plane.forces[i][plane.across];
    const double fy = (down ? -1.0 : 1.0) * plane.forces[i][plane.up];
    const double size = std::hypot(fx, fy);
    const double px = x(plane.places[i][plane.across]), py = y(plane.places[i][plane.up]);
    svg += size <= 1e-3 * most || most == 0.0
               ? fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.6\" fill=\"#5f6368\"/>", px,
                             py)
               : arrow(px, py, fx / size, fy / size, length, shade(size / most));
  }
  return svg + scale_of_shades(most, kLeft + kSide + 50.0, kTop + 40.0) + "</svg>\n";
}

std::string stage_name(const protocols::PreviewedTrial& trial, const protocols::StagePlace& place) {
  const protocols::PreviewedInterval& shown = trial.intervals[place.interval];
  const std::string& name = shown.stages[place.stage].name;
  return trial.intervals.size() == 1
             ? name
             : fmt::format("{} {}: {}", place.interval + 1, shown.name, name);
}

std::string stage_names(const protocols::PreviewedTrial& trial,
                        const std::vector<protocols::StagePlace>& places) {
  std::vector<std::string> names;
  for (const protocols::StagePlace& place : places) {
    names.push_back(stage_name(trial, place));
  }
  return fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace haptrial::experiments
