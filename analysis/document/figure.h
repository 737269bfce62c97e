#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptrial::analysis {

/// How a series is drawn. Colour is never the only difference: lines also differ in dash and width,
/// points in shape.
struct Look {
  const char* color{"#000000"};  // `#rrggbb`, a literal
  const char* dash{"solid"};     // "solid", or lengths drawn and left out: "(8,5)"
  int point{7};                  // gnuplot point type; 7 is a filled circle
  double width{2.0};
  double point_size{1.0};
};

enum class Mark {
  kLine,        // x, y
  kPoints,      // x, y
  kBars,        // x, y with a vertical interval low .. high
  kLinkedBars,  // the same, joined by a line
  kSegments,    // from (x, y) to (x2, y2)
};

/// Columns that a mark does not use stay empty; those that it uses are equally long.
struct Series {
  std::string label;  // empty: not in the key
  Mark mark{Mark::kLine};
  Look look;
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> low{}, high{};
  std::vector<double> x2{}, y2{};
};

using Range = std::pair<double, double>;

/// A figure as data: what is drawn, not how.
struct Figure {
  std::string name;  // of the files, without extension; letters, digits, '-' and '_'
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;                           // drawn in this order
  std::vector<std::pair<double, std::string>> x_names;  // names in place of numbers on x
  std::optional<Range> x_range;                         // automatic when absent
  std::optional<Range> y_range;
  double height{0.6};               // height / width of the whole picture
  bool equal_scale{false};          // a unit is as long on x as on y
  bool simulated{false};            // carries the mark of what is simulated
  std::string who{"PARTICIPANTS"};  // is simulated
  std::string caption;              // a sentence or two for the report
  std::string alt;                  // what one sees, for those who cannot see it
};

}  // namespace haptrial::analysis
