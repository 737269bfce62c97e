#include "core/device/paddle_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/definition/schema.h"

namespace haptrial::device {
namespace {

constexpr std::array<std::string_view, 3> kWorldAxes{"x", "y", "z"};
constexpr std::string_view kButtonColumn = "buttons";
constexpr std::string_view kPassedOver = "-";
constexpr std::size_t kLongestLine = 256;
constexpr double kMostButtons = 4294967295.0;

bool has_column(const PaddleParameters& p, std::string_view column) {
  return std::ranges::find(p.columns, column) != p.columns.end();
}

std::string mark_of(std::string_view axis) { return fmt::format("{{{}}}", axis); }

/// The columns of a line as numbers; nothing if one is no finite number.
std::optional<std::vector<double>> numbers_of(std::string_view line) {
  constexpr std::string_view kBetween = " \t,;\r";
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) {
      return numbers;
    }
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBetween));
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    numbers.push_back(number);
    line.remove_prefix(word.size());
  }
}

class PaddleProtocol final : public BoardProtocol {
 public:
  explicit PaddleProtocol(const PaddleParameters& parameters) : p_(parameters) {}

  bool answers() const override { return false; }
  std::string start_message() const override { return p_.start.empty() ? "" : p_.start + "\n"; }

  std::string force_message(const Eigen::Vector3d& force) override {
    std::string line = p_.command;
    for (std::size_t axis = 0; axis < kWorldAxes.size(); ++axis) {
      const std::string mark = mark_of(kWorldAxes[axis]);
      const double number = p_.force_scale * force[static_cast<Eigen::Index>(axis)];
      for (std::size_t at = line.find(mark); at != std::string::npos; at = line.find(mark)) {
        line.replace(at, mark.size(), fmt::format("{:.5f}", number == 0.0 ? 0.0 : number));
      }
    }
    return line + "\n";
  }

  std::optional<BoardReading> take(std::string_view bytes) override {
    std::optional<BoardReading> newest;
    for (const char each : bytes) {
      if (each != '\n') {
        line_.push_back(each);
        too_long_ = too_long_ || line_.size() > kLongestLine;
        line_.resize(std::min(line_.size(), kLongestLine));
        continue;
      }
      const auto reading = too_long_ ? std::nullopt : reading_of(line_);
      newest = reading ? reading : newest;
      misunderstood_ = reading ? misunderstood_ : line_;
      line_.clear();
      too_long_ = false;
    }
    return newest;
  }

  std::string misunderstood() const override {
    constexpr std::size_t kShown = 40;
    std::string shown = (misunderstood_.empty() ? line_ : misunderstood_).substr(0, kShown);
    std::erase_if(shown, [](char each) { return each < ' ' || each > '~'; });
    return shown;
  }

 private:
  std::optional<BoardReading> reading_of(std::string_view line) const {
    const auto numbers = numbers_of(line);
    if (!numbers || numbers->size() != p_.columns.size()) {
      return std::nullopt;
    }
    BoardReading reading;
    for (std::size_t i = 0; i < p_.columns.size(); ++i) {
      const auto* const axis = std::ranges::find(kWorldAxes, p_.columns[i]);
      const double number = (*numbers)[i];
      if (axis != kWorldAxes.end()) {
        reading.position[axis - kWorldAxes.begin()] =
            p_.position_scale * (number - p_.position_zero);
      } else if (p_.columns[i] == kButtonColumn) {
        if (!(number >= 0.0 && number <= kMostButtons)) {
          return std::nullopt;
        }
        reading.buttons = static_cast<std::uint32_t>(number);
      }
    }
    return reading;
  }

  PaddleParameters p_;
  std::string line_;
  bool too_long_{false};
  std::string misunderstood_;
};

void check_paddle(Table& table, PaddleParameters& p) {
  for (const std::string& column : p.columns) {
    const bool known = std::ranges::find(kWorldAxes, column) != kWorldAxes.end() ||
                       column == kButtonColumn || column == kPassedOver;
    if (!known || (column != kPassedOver && std::ranges::count(p.columns, column) > 1)) {
      table.reject("columns", fmt::format("\"{}\" among them", column),
                   "x, y, z and buttons, each at most once, and - for what is passed over");
      return;
    }
  }
  bool any = false;
  for (const std::string_view axis : kWorldAxes) {
    const bool read = has_column(p, axis);
    any = any || read;
    if (read != (p.command.find(mark_of(axis)) != std::string::npos)) {
      table.reject("command", fmt::format("\"{}\"", p.command),
                   "a text with {x}, {y} and {z} for just the axes that columns has");
      return;
    }
  }
  if (!any) {
    table.reject("columns", "without an axis", "x, y or z among them");
  }
  if (p.position_scale == 0.0) {
    table.reject("position_scale", "0", "another number");
  }
  if (p.force_scale == 0.0) {
    table.reject("force_scale", "0", "another number");
  }
}

}  // namespace

const Schema<PaddleParameters>& paddle_schema() {
  using P = PaddleParameters;
  static const auto schema =
      Schema<P>()
          .keys_of(&P::line, serial_board_schema())
          .texts(
              "columns", &P::columns,
              "Meaning of each column of a line that the board prints: x, y or z for a position "
              "along that axis, buttons for a whole number with a bit for each button, - for what "
              "is passed over")
          .otherwise("[\"x\"]")
          .number("position_scale", &P::position_scale, {-1e6, 1e6}, "m",
                  "Way of the handle for a printed position of 1; below 0 the axis is turned round")
          .number("position_zero", &P::position_zero, {-1e9, 1e9}, "",
                  "Printed position at the middle of the workspace")
          .text("command", &P::command,
                "Line that commands a force; {x}, {y} and {z} stand for its numbers")
          .number("force_scale", &P::force_scale, {-1e6, 1e6}, "1/N",
                  "Number in the command for a force of 1 N; for torques the length of the lever")
          .text("start", &P::start, "Line that starts the board")
          .otherwise("none")
          .integer("stop_button", &P::stop_button, -1, 31,
                   "Button of the board for emergency stops; -1: none")
          .check(check_paddle);
  return schema;
}

std::unique_ptr<BoardProtocol> paddle_protocol(const PaddleParameters& parameters) {
  return std::make_unique<PaddleProtocol>(parameters);
}

Eigen::Vector3d force_axes(const PaddleParameters& parameters) {
  Eigen::Vector3d axes = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < kWorldAxes.size(); ++axis) {
    axes[static_cast<Eigen::Index>(axis)] = has_column(parameters, kWorldAxes[axis]) ? 1.0 : 0.0;
  }
  return axes;
}

bool has_buttons(const PaddleParameters& parameters) {
  return has_column(parameters, kButtonColumn);
}

std::unique_ptr<SerialBoard> open_paddle_board(const PaddleParameters& parameters, double rate) {
  SerialBoardSetup setup = parameters.line;
  setup.table = "paddle";
  setup.force_axes = force_axes(parameters);
  setup.stop_button = parameters.stop_button;
  return std::make_unique<SerialBoard>(std::move(setup), paddle_protocol(parameters), rate);
}

}  // namespace haptrial::device
