#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/serial_board.h"

namespace haptrial::device {

/// How a board is set up that prints a line for each reading and takes a line for each force, such
/// as a Hapkit-like paddle with a sketch of a course.
struct PaddleParameters {
  SerialBoardSetup line;
  /// Meaning of each column of a printed line: x, y or z (position along an axis of W), buttons (a
  /// whole number, bit i for button i), or - (passed over).
  std::vector<std::string> columns{"x"};
  double position_scale{1.0};  // of a printed position, not 0 [m]
  double position_zero{0.0};   // printed position at the origin of W
  std::string command{"{x}"};  // line for a force; {x}, {y} and {z} stand for its numbers
  double force_scale{1.0};  // number for a force of 1 N, not 0: 1/N, or a lever's length for N·m
  std::string start;        // line that starts the board; empty: it starts by itself
  int stop_button{-1};      // emergency stop; -1: none
};

/// The keys of [paddle].
const Schema<PaddleParameters>& paddle_schema();

/// Columns of a line are separated by blanks, tabs, commas or semicolons; a line with another
/// number of columns, or with one that is no finite number, is passed over. The board speaks by its
/// own clock, and each reading is answered by a force.
std::unique_ptr<BoardProtocol> paddle_protocol(const PaddleParameters& parameters);

/// Axes of W along which the board gives force, as in DeviceInfo.
Eigen::Vector3d force_axes(const PaddleParameters& parameters);

/// Whether lines of the board have buttons.
bool has_buttons(const PaddleParameters& parameters);

/// @throws as SerialBoard does
std::unique_ptr<SerialBoard> open_paddle_board(const PaddleParameters& parameters, double rate);

}  // namespace haptrial::device
