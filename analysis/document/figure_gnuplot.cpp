#include "analysis/document/figure_gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/scratch_folder.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScriptName = "figures.gp";
constexpr const char* kLogName = "gnuplot.log";
constexpr int kWidth = 900;  // of the SVG [px]; the PNG has twice as many

// A gnuplot string in which nothing is special: what could end it or run a command is an octal
// escape.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      result += ' ';
    } else if (std::strchr("\"'`\\$@", c) != nullptr) {
      result += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

/// A label of a tick, which gnuplot takes for a format.
std::string tick_label(std::string text) {
  for (auto at = text.find('%'); at != text.npos; at = text.find('%', at + 2)) {
    text.insert(at, 1, '%');
  }
  const std::string& label = text;
  return quoted(label);
}

std::vector<const std::vector<double>*> columns(const Series& s) {
  switch (s.mark) {
    case Mark::kBars:
    case Mark::kLinkedBars:
      return {&s.x, &s.y, &s.low, &s.high};
    case Mark::kSegments:
      return {&s.x, &s.y, &s.x2, &s.y2};
    case Mark::kLine:
    case Mark::kPoints:
      break;
  }
  return {&s.x, &s.y};
}

void check(const Figure& figure) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  if (figure.name.empty() || !std::all_of(figure.name.begin(), figure.name.end(), allowed)) {
    throw std::invalid_argument("gnuplot_script: a figure's name is not a plain file name");
  }
  for (const auto& s : figure.series) {
    for (const auto* column : columns(s)) {
      if (column->size() != s.x.size()) {
        throw std::invalid_argument("gnuplot_script: columns of a series differ in length");
      }
    }
  }
}

std::string data_block(const Series& series, std::size_t index) {
  const auto used = columns(series);
  std::string text = fmt::format("$s{} << EOD\n", index);
  for (std::size_t row = 0; row < series.x.size(); ++row) {
    for (const auto* column : used) {
      text += fmt::format("{:.6g} ", (*column)[row]);
    }
    text += '\n';
  }
  return text + "EOD\n";
}

std::string plot_element(const Series& series, std::size_t index) {
  const Look& look = series.look;
  const auto line = fmt::format("lc rgb '{}' lw {:.3g} dt {}", look.color, look.width, look.dash);
  const auto point = fmt::format("pt {} ps {:.3g}", look.point, look.point_size);
  const auto title =
      series.label.empty() ? std::string("notitle") : "title " + quoted(series.label);
  switch (series.mark) {
    case Mark::kLine:
      return fmt::format("$s{} using 1:2 with lines {} {}", index, line, title);
    case Mark::kPoints:
      return fmt::format("$s{} using 1:2 with points {} {} {}", index, line, point, title);
    case Mark::kSegments:
      return fmt::format("$s{} using 1:2:($3-$1):($4-$2) with vectors nohead {} {}", index, line,
                         title);
    case Mark::kBars:
      return fmt::format("$s{} using 1:2:3:4 with yerrorbars {} {} {}", index, line, point, title);
    case Mark::kLinkedBars:
      break;
  }
  // A dashed bar could be taken for a short one.
  return fmt::format(
      "$s{} using 1:2:3:4 with yerrorbars lc rgb '{}' lw {:.3g} dt solid {} notitle, "
      "$s{} using 1:2 with linespoints {} {} {}",
      index, look.color, look.width, point, index, line, point, title);
}

std::string range(const char* axis, const std::optional<Range>& limits) {
  return limits ? fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis, limits->first, limits->second)
                : fmt::format("set {}range [*:*]\n", axis);
}

std::string axes(const Figure& figure) {
  std::string text = fmt::format("set xlabel {} offset 0,0.2\nset ylabel {}\n",
                                 quoted(figure.x_label), quoted(figure.y_label));
  text += range("x", figure.x_range) + range("y", figure.y_range);
  if (!figure.x_names.empty()) {
    std::string names;
    for (const auto& [at, name] : figure.x_names) {
      names += fmt::format("{}{} {:.6g}", names.empty() ? "" : ", ", tick_label(name), at);
    }
    text += "set xtics (" + names + ")\n";
  }
  return text;
}

bool has_key(const Figure& figure) {
  return std::any_of(figure.series.begin(), figure.series.end(),
                     [](const Series& s) { return !s.label.empty(); });
}

const char* no_key(const Figure& figure) { return has_key(figure) ? "" : "unset key\n"; }

// Room for the key, where there is one.
std::string layout(const Figure& figure) {
  return fmt::format("{}set bmargin {}\n{}", no_key(figure), has_key(figure) ? 6 : 4,
                     figure.equal_scale ? "set size ratio -1\n" : "");
}

std::string headings(const Figure& figure) {
  auto text =
      fmt::format("set label 1 {} at graph 0, graph 1 offset 0,1.2 left font ',16' noenhanced\n",
                  quoted(figure.title));
  if (figure.simulated) {
    text += fmt::format(
        "set label 2 {} at graph 1, graph 1 offset 0,1.2 right font ',12' textcolor rgb '#b00020' "
        "noenhanced\n",
        quoted("SIMULATED " + figure.who));
  }
  return text;
}

/// Room for the key of a figure for a paper, beyond the height of the figure on a screen [mm].
double key_room(const Figure& figure) {
  constexpr double kRoom = 10.0;
  return has_key(figure) ? kRoom : 0.0;
}

/// Draws the figure once more for a paper, which has the title in its caption; what marks simulated
/// results stays. An SVG has points of a fixed size, so that it is drawn twice as large.
std::string paper_plot(const Figure& figure, const std::string& plot, int width) {
  constexpr double kMillimetres = 10.0;          // in a centimetre
  constexpr double kPixels = 2.0 * 96.0 / 25.4;  // in a millimetre; 8 pt are 21.3
  const double high = figure.height * width + key_room(figure);
  const std::string mark = figure.simulated ? "SIMULATED " + figure.who : std::string();
  return fmt::format(
      "unset label 1\nset label 2 {} at graph 1, graph 1 offset 0,0.7 right font ',7' textcolor "
      "rgb "
      "'#b00020' noenhanced\nset tmargin {}\nset bmargin {}\nset rmargin 1\n"
      "set key samplen 1.2 width 0 font ',7'\n{}"
      "set terminal pdfcairo size {:.2f}cm,{:.2f}cm noenhanced font 'sans,8' fontscale 1 linewidth "
      "0.5 pointscale 0.5 background rgb 'white'\nset output '{}.pdf'\n{}\nset output\n"
      "set label 2 font ',18.7'\nset key font ',18.7'\n{}"
      "set terminal svg size {:.0f},{:.0f} dynamic noenhanced font "
      "'Helvetica,Arial,sans-serif,21.3' background rgb 'white'\nset output '{}-paper.svg'\n{}\n"
      "set output\n",
      quoted(mark), figure.simulated ? 2 : 1, has_key(figure) ? 5.5 : 3.5, no_key(figure),
      width / kMillimetres, high / kMillimetres, figure.name, plot, no_key(figure), kPixels * width,
      kPixels * high, figure.name, plot);
}

/// Says in an SVG how large it is on paper.
void state_size(const fs::path& svg, const Figure& figure, int width) {
  std::string text = file_text(svg);
  const auto at = text.find("viewBox=");
  if (at != std::string::npos) {
    text.insert(at, fmt::format("width=\"{}mm\" height=\"{:.1f}mm\" ", width,
                                figure.height * width + key_room(figure)));
    write_text(svg, text);
  }
}

constexpr const char* kStyle = R"(reset
set encoding utf8
set decimalsign '.'
set border 3 lc rgb '#444444' lw 1
set tics nomirror out scale 0.6
set grid ytics lc rgb '#e3e5e8' lw 1 dt solid
set key outside bottom center horizontal Left reverse samplen 4 width 2 noenhanced
set bars 1.2
set tmargin 3
set rmargin 4
)";

// Whether a file ends as a complete one of its kind does.
bool ends_with(const fs::path& file, const std::string& ending) {
  const std::string text = file_text(file);
  const auto tail = text.substr(text.size() - std::min<std::size_t>(text.size(), 16));
  return tail.find(ending) != std::string::npos;
}

// Runs gnuplot on the script in `folder`, its words in the log. Returns its exit status.
int run_gnuplot(const fs::path& folder) {
  const Descriptor log(
      open((folder / kLogName).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (log.get() < 0) {
    throw RunError(fmt::format("{}: could not be written: {}", (folder / kLogName).string(),
                               std::strerror(errno)));
  }
  try {
    // -d: no settings of the user's own.
    ChildProcess gnuplot(
        {.words = {"gnuplot", "-d", kScriptName}, .folder = folder, .output = log.get()});
    return gnuplot.wait();
  } catch (const std::system_error& error) {
    throw RunError(fmt::format(
        "the figures need gnuplot, which could not be started ({}); install the package "
        "gnuplot-nox or put gnuplot on the PATH",
        error.code().message()));
  }
}

std::string first_words_of(const fs::path& log) {
  std::ifstream stream(log);
  std::string line;
  while (std::getline(stream, line) && line.find_first_not_of(" \t^") == std::string::npos) {
  }
  return line.empty() ? "it said nothing" : line;
}

std::string plot_command(const Figure& figure) {
  std::string plot = "plot ";
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    plot += (i == 0 ? "" : ", \\\n  ") + plot_element(figure.series[i], i);
  }
  return plot;
}

/// Style, data, and the picture as SVG.
std::string svg_script(const Figure& figure) {
  std::string text = kStyle + layout(figure) + headings(figure) + axes(figure);
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    text += data_block(figure.series[i], i);
  }
  return text +
         fmt::format(
             "set terminal svg size {},{} dynamic noenhanced font "
             "'Helvetica,Arial,sans-serif,14' background rgb 'white'\nset output '{}.svg'\n{}\n",
             kWidth, static_cast<int>(figure.height * kWidth), figure.name, plot_command(figure));
}

/// Runs a script in the folder. @throws RunError if gnuplot is absent or fails
void draw_script(const std::string& script, const fs::path& folder) {
  write_text(folder / kScriptName, script);
  const int status = run_gnuplot(folder);
  if (status != 0) {
    throw RunError(fmt::format("gnuplot failed with status {} while drawing the figures: {}",
                               status, first_words_of(folder / kLogName)));
  }
}

[[noreturn]] void fail_unfinished(const fs::path& file) {
  throw RunError(
      fmt::format("{}: gnuplot did not finish this picture; is the disk full?", file.string()));
}

}  // namespace

std::string gnuplot_script(const Figure& figure, int paper) {
  check(figure);
  const std::string plot = plot_command(figure);
  const int height = static_cast<int>(figure.height * kWidth);
  std::string text =
      svg_script(figure) +
      fmt::format(
          "set terminal pngcairo size {},{} noenhanced font 'sans,14' fontscale 1.8 linewidth 2 "
          "pointscale 2 background rgb 'white'\nset output '{}.png'\n{}\nset output\n",
          2 * kWidth, 2 * height, figure.name, plot);
  if (paper > 0) {
    text += paper_plot(figure, plot, paper);
  }
  return text;
}

void draw_figures(const std::vector<Figure>& figures, const fs::path& folder, int paper) {
  if (figures.empty()) {
    return;
  }
  std::string script;
  for (const auto& figure : figures) {
    script += gnuplot_script(figure, paper);
  }
  draw_script(script, folder);
  std::vector<std::pair<const char*, const char*>> kinds{{".svg", "</svg>"}, {".png", "IEND"}};
  if (paper > 0) {
    kinds.emplace_back(".pdf", "%%EOF");
    kinds.emplace_back("-paper.svg", "</svg>");
  }
  for (const auto& figure : figures) {
    for (const auto& [extension, ending] : kinds) {
      const fs::path file = folder / (figure.name + extension);
      if (!ends_with(file, ending)) {
        fail_unfinished(file);
      }
    }
  }
  if (paper > 0) {
    for (const auto& figure : figures) {
      state_size(folder / (figure.name + "-paper.svg"), figure, paper);
    }
  }
  fs::remove(folder / kScriptName);
  fs::remove(folder / kLogName);
}

std::vector<Drawing> drawn(const std::vector<Figure>& figures) {
  std::vector<Drawing> drawings;
  if (figures.empty()) {
    return drawings;
  }
  const ScratchFolder folder("figures");
  std::string script;
  for (const Figure& figure : figures) {
    check(figure);
    script += svg_script(figure);
  }
  draw_script(script, folder.path());
  for (const Figure& figure : figures) {
    const fs::path file = folder.path() / (figure.name + ".svg");
    if (!ends_with(file, "</svg>")) {
      fail_unfinished(file);
    }
    drawings.push_back({figure, file_text(file)});
  }
  return drawings;
}

}  // namespace haptrial::analysis
