#include "core/bone/tools/simulator_tools.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/bone/tools/plate_shapes.h"

namespace haptrial::bone {
namespace {

constexpr int kMostTools = 32;

void optional(Table& table, const char* key, double& value, const Bounds& bounds,
              const char* unit) {
  value = table.has(key) ? table.number(key, bounds, unit) : value;
}

ToolSpec read_tool(Table& table, const std::string& name) {
  ToolSpec tool;
  tool.name = name;
  const std::string type = table.choice("type", {"burr", "suction", "cut_plane", "plate", "grip"});
  optional(table, "handle_radius", tool.handle_radius, {1e-4, 0.05}, "m");
  optional(table, "handle_length", tool.handle_length, {1e-3, 0.5}, "m");
  if (type == "burr") {
    tool.burr = read_burr_parameters(table);
    const double radius = 0.5 * tool.burr.diameter;
    tool.feel = default_feel(radius);
    if (table.has("feel")) {
      Table feel = table.table("feel");
      tool.feel = read_feel_parameters(feel, radius);
    }
  } else if (type == "suction") {
    tool.kind = ToolKind::kSuction;
    optional(table, "radius", tool.suction_radius, {1e-4, 0.01}, "m");
  } else if (type == "cut_plane") {
    tool.kind = ToolKind::kCutPlane;
    tool.plane = read_cut_plane(table);
  } else if (type == "plate") {
    tool.kind = ToolKind::kPlate;
    tool.shape = table.choice("shape", {"straight", "l", "distractor"});
    tool.holes = table.has("holes") ? static_cast<int>(table.integer("holes", 2, 20)) : tool.holes;
    if (table.has("contact")) {
      Table contact = table.table("contact");
      tool.plate = read_plate_parameters(contact);
    }
  } else if (type == "grip") {
    tool.kind = ToolKind::kGrip;
    optional(table, "reach", tool.reach, {1e-4, 0.02}, "m");
  }
  return tool;
}

}  // namespace

std::vector<ToolSpec> read_tools(Table& table) {
  std::vector<ToolSpec> tools;
  const std::vector<std::string> names = table.texts("in_hand");
  if (names.empty() || names.size() > kMostTools) {
    table.reject("in_hand", fmt::format("a list of {} names", names.size()),
                 fmt::format("1 to {} names of tools", kMostTools));
  }
  for (const std::string& name : names) {
    for (const ToolSpec& before : tools) {
      if (before.name == name) {
        table.reject("in_hand", fmt::format("names '{}' twice; name each tool once", name));
      }
    }
    Table own = table.table(name);
    tools.push_back(read_tool(own, name));
  }
  return tools;
}

PlateModel make_plate_model(const ToolSpec& tool) {
  if (tool.shape == "straight") {
    return {tool.name, make_plate(straight_miniplate(tool.holes)), tool.plate};
  }
  if (tool.shape == "l") {
    return {tool.name, make_plate(l_plate()), tool.plate};
  }
  if (tool.shape == "distractor") {
    return {tool.name, make_distractor(), tool.plate};
  }
  throw std::invalid_argument("no plate has the shape '" + tool.shape + "'");
}

}  // namespace haptrial::bone
