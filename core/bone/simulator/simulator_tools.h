#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/burr_tool.h"
#include "core/bone/simulator/cut_plane.h"
#include "core/bone/simulator/plate.h"

namespace haptrial::bone {

struct SuctionTool {
  double radius{1e-3};  // of the tube's opening > 0 [m]
};
/// Stimulates nerves (core/bone/nerve) while it has power; bone does not feel it.
struct ProbeTool {
  double radius{2.5e-4};  // of its tip > 0 [m]
};
struct PlateTool {
  std::string shape{"straight"};  // or "l", "distractor"
  int holes{4};                   // of a straight plate
  double curvature{0.0};          // with which it is bent over the bone >= 0 [1/m]
  PlateParameters contact{};
};
/// Takes hold of a piece.
struct GripTool {
  double reach{1.5e-3};  // to the bone > 0 [m]
};
/// Drives screws into the holes of plates (screws.h).
struct ScrewTool {
  double diameter{2.0e-3};    // of the thread > 0 [m]
  double length{7e-3};        // of a screw, from the plate's outer side > 0 [m]
  double pitch{0.8e-3};       // > 0 [m]
  double turns{2.0};          // with full power > 0 [1/s]
  double torque_rate{100.0};  // over the length of solid bone that the thread is in >= 0 [N·m/m]
};

/// One of the tools that a participant can take in hand.
struct ToolSpec {
  std::string name;
  double handle_radius{2.5e-3};  // > 0 [m]
  double handle_length{0.1};     // > 0 [m]
  // A cut plane lies in the hand.
  std::variant<BurrTool, SuctionTool, CutPlane, PlateTool, GripTool, ProbeTool, ScrewTool> kind{};

  /// The tool as one kind; null if it is another.
  template <class Kind>
  const Kind* as() const noexcept {
    return std::get_if<Kind>(&kind);
  }
};

/// Reads a [tools] table: `in_hand`, the names in their order, and a table for each of them, which
/// has a `type` ("burr", "saw", "suction", "cut_plane", "plate", "grip", "screw", "probe") and the
/// keys of its kind.
std::vector<ToolSpec> read_tools(Table& table);

/// @throws std::invalid_argument for an unknown shape.
PlateModel make_plate_model(const std::string& name, const PlateTool& tool);

}  // namespace haptrial::bone
