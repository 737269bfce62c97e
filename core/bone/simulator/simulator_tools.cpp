#include "core/bone/simulator/simulator_tools.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/bone/simulator/plate_shapes.h"

namespace haptrial::bone {
namespace {

constexpr int kMostTools = 32;
constexpr double kWidestShaft = 0.015;  // [m]

/// Both keys of a shaft are needed if one is there. Which of them comes first reads both.
void read_shaft(Table& table, const std::string&, BurrTool& tool) {
  if (tool.shaft) {
    return;
  }
  const double radius = table.number("shaft_radius", {1e-4, kWidestShaft}, "m");
  tool.shaft = default_shaft(radius, table.number("shaft_length", {1e-3, 0.1}, "m"));
  if (radius > tool.radius()) {
    table.reject("shaft_radius", fmt::format("{}", radius),
                 fmt::format("at most half of diameter, {} [m]", tool.burr.diameter));
  }
}

const Schema<BurrTool>& burr_tool_schema() {
  static const auto schema =
      Schema<BurrTool>()
          .keys_of(&BurrTool::burr, burr_schema())
          .derive([](BurrTool& tool) {
            tool.feel = default_feel(BurrShape(tool.burr.dimensions()).ball_radius());
          })
          .table("feel", &BurrTool::feel, feel_schema(),
                 "Strength with which bone pushes the burr back")
          .custom("shaft_radius",
                  "Radius of the shaft behind the burr, by which bone is felt but not removed",
                  read_shaft)
          .otherwise("not felt")
          .custom("shaft_length",
                  "Length of the shaft behind the burr, by which bone is felt but not removed",
                  read_shaft)
          .otherwise("not felt");
  return schema;
}

constexpr const char* kRadius = "Radius of the opening of a suction tube, or of the tip of a probe";

const Schema<SuctionTool>& suction_schema() {
  static const auto schema =
      Schema<SuctionTool>().number("radius", &SuctionTool::radius, {1e-4, 0.01}, "m", kRadius);
  return schema;
}

const Schema<ProbeTool>& probe_schema() {
  static const auto schema =
      Schema<ProbeTool>().number("radius", &ProbeTool::radius, {1e-4, 0.002}, "m", kRadius);
  return schema;
}

const Schema<GripTool>& grip_schema() {
  static const auto schema =
      Schema<GripTool>().number("reach", &GripTool::reach, {1e-4, 0.02}, "m",
                                "Distance from a piece of bone within which a grip takes hold of "
                                "the piece");
  return schema;
}

const Schema<PlateTool>& plate_tool_schema() {
  static const auto schema =
      Schema<PlateTool>()
          .custom("shape", "Shape of the burr, or of the plate",
                  [](Table& table, const std::string& key, PlateTool& tool) {
                    tool.shape = table.choice(key, {"straight", "l", "distractor"});
                  })
          .required()
          .integer("holes", &PlateTool::holes, 2, 20, "Number of holes of a straight plate")
          .table("contact", &PlateTool::contact, plate_schema(), "Feel of the plate on bone");
  return schema;
}

void read_kind(Table& table, const std::string& key, ToolSpec& tool) {
  const auto read = [&]<class Kind>(const Schema<Kind>& schema) {
    schema.read(table, tool.kind.emplace<Kind>());
  };
  const std::string type =
      table.choice(key, {"burr", "suction", "cut_plane", "plate", "grip", "probe"});
  if (type == "burr") {
    read(burr_tool_schema());
  } else if (type == "suction") {
    read(suction_schema());
  } else if (type == "cut_plane") {
    read(cut_plane_schema());
  } else if (type == "plate") {
    read(plate_tool_schema());
  } else if (type == "grip") {
    read(grip_schema());
  } else if (type == "probe") {
    read(probe_schema());
  }
}

const Schema<ToolSpec>& tool_schema() {
  static const auto schema =
      Schema<ToolSpec>()
          .number("handle_radius", &ToolSpec::handle_radius, {1e-4, 0.05}, "m",
                  "Radius of the tool's handle")
          .number("handle_length", &ToolSpec::handle_length, {1e-3, 0.5}, "m",
                  "Length of the tool's handle")
          .custom("type", "Type of the tool, on which the tool's other keys depend", read_kind)
          .required();
  return schema;
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
  table.describe({"in_hand", "Names of tools, in the order in which a button selects them", ""});
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
    tools.push_back(tool_schema().read(own));
    tools.back().name = name;
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
