#include "core/bone/simulator/simulator_tools.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/bone/simulator/plate_shapes.h"

namespace haptrial::bone {
namespace {

constexpr int kMostTools = 32;

void optional(Table& table, const char* key, double& value, const Bounds& bounds,
              const char* unit) {
  value = table.number_or(key, value, bounds, unit);
}

/// @param widest  [m]
std::optional<ShaftParameters> read_shaft(Table& table, double widest) {
  if (!table.has("shaft_radius") && !table.has("shaft_length")) {
    return std::nullopt;
  }
  const double radius = table.number("shaft_radius", {1e-4, widest}, "m");
  return default_shaft(radius, table.number("shaft_length", {1e-3, 0.1}, "m"));
}

BurrTool read_burr(Table& table) {
  BurrTool tool;
  tool.burr = read_burr_parameters(table);
  const double as_ball = BurrShape(tool.burr.dimensions()).ball_radius();
  tool.feel = default_feel(as_ball);
  if (table.has("feel")) {
    Table feel = table.table("feel");
    tool.feel = read_feel_parameters(feel, as_ball);
  }
  tool.shaft = read_shaft(table, tool.radius());
  return tool;
}

PlateTool read_plate(Table& table) {
  PlateTool tool;
  tool.shape = table.choice("shape", {"straight", "l", "distractor"});
  tool.holes = table.has("holes") ? static_cast<int>(table.integer("holes", 2, 20)) : tool.holes;
  if (table.has("contact")) {
    Table contact = table.table("contact");
    tool.contact = read_plate_parameters(contact);
  }
  return tool;
}

ToolSpec read_tool(Table& table, const std::string& name) {
  ToolSpec tool;
  tool.name = name;
  const std::string type =
      table.choice("type", {"burr", "suction", "cut_plane", "plate", "grip", "probe"});
  optional(table, "handle_radius", tool.handle_radius, {1e-4, 0.05}, "m");
  optional(table, "handle_length", tool.handle_length, {1e-3, 0.5}, "m");
  if (type == "burr") {
    tool.kind = read_burr(table);
  } else if (type == "suction") {
    optional(table, "radius", tool.kind.emplace<SuctionTool>().radius, {1e-4, 0.01}, "m");
  } else if (type == "cut_plane") {
    tool.kind = read_cut_plane(table);
  } else if (type == "plate") {
    tool.kind = read_plate(table);
  } else if (type == "grip") {
    optional(table, "reach", tool.kind.emplace<GripTool>().reach, {1e-4, 0.02}, "m");
  } else if (type == "probe") {
    optional(table, "radius", tool.kind.emplace<ProbeTool>().radius, {1e-4, 0.002}, "m");
  }
  return tool;
}

}  // namespace

ShaftParameters default_shaft(double radius, double length) {
  ShaftParameters shaft;
  shaft.radius = radius;
  shaft.length = length;
  shaft.feel = default_feel(BurrShape(shaft.dimensions()).ball_radius());
  return shaft;
}

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

PlateModel make_plate_model(const std::string& name, const PlateTool& tool) {
  if (tool.shape == "straight") {
    return {name, make_plate(straight_miniplate(tool.holes)), tool.contact};
  }
  if (tool.shape == "l") {
    return {name, make_plate(l_plate()), tool.contact};
  }
  if (tool.shape == "distractor") {
    return {name, make_distractor(), tool.contact};
  }
  throw std::invalid_argument("no plate has the shape '" + tool.shape + "'");
}

}  // namespace haptrial::bone
