#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone/drill/burr.h"
#include "core/bone/drill/feel.h"
#include "core/bone/tools/cut_plane.h"
#include "core/bone/tools/plate.h"

namespace haptrial {
class Table;
}

namespace haptrial::bone {

enum class ToolKind : std::uint8_t { kBurr, kSuction, kCutPlane, kPlate, kGrip };

/// One of the tools that a participant can take in hand.
struct ToolSpec {
  std::string name;
  ToolKind kind{ToolKind::kBurr};
  double handle_radius{2.5e-3};  // > 0 [m]
  double handle_length{0.1};     // > 0 [m]
  BurrParameters burr{};         // of a burr
  FeelParameters feel{};         // likewise
  double suction_radius{1e-3};   // of the tube's opening > 0 [m]
  CutPlane plane{};              // of a cut plane; its pose is the hand's
  PlateParameters plate{};       // of a plate
  std::string shape{};           // of a plate: "straight", "l", "distractor"
  int holes{4};                  // of a straight plate
  double reach{1.5e-3};          // of a grip, to the bone that it takes hold of > 0 [m]
};

/// Reads a [tools] table: `in_hand`, the names in their order, and a table for each of them, which
/// has a `type` ("burr", "suction", "cut_plane", "plate", "grip") and the keys of its kind.
std::vector<ToolSpec> read_tools(Table& table);

/// The plate of a tool. @throws std::invalid_argument for an unknown shape.
PlateModel make_plate_model(const ToolSpec& tool);

}  // namespace haptrial::bone
