#include "core/bone/simulator/simulator_tools.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/bone/simulator/plate_shapes.h"
#include "core/bone/simulator/saw.h"
#include "core/bone/simulator/tuning.h"

namespace haptrial::bone {
namespace {

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

const Schema<ScrewTool>& screw_schema() {
  using T = ScrewTool;
  static const auto schema =
      Schema<T>()
          .number("diameter", &T::diameter, {5e-4, 0.01}, "m", "Diameter of a screw's thread")
          .number("length", &T::length, {1e-3, 0.05}, "m",
                  "Length of a screw, from the outer side of the plate")
          .number("pitch", &T::pitch, {1e-4, 0.005}, "m", "Advance of a screw in one turn")
          .number("turns", &T::turns, {0.1, 100.0}, "1/s",
                  "Turns of a screw in a second at full power")
          .number("torque_rate", &T::torque_rate, {0.0, 1e5}, "N·m/m",
                  "Torque of a screw over the length of solid bone that its thread is in");
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
          .number("curvature", &PlateTool::curvature, {0.0, 200.0}, "1/m",
                  "Curvature with which the plate is bent over the bone, about its y axis; not a "
                  "distractor's")
          .table("contact", &PlateTool::contact, plate_schema(), "Feel of the plate on bone");
  return schema;
}

void read_kind(Table& table, const std::string& key, ToolSpec& tool) {
  const auto read = [&]<class Kind>(const Schema<Kind>& schema) {
    schema.read(table, tool.kind.emplace<Kind>());
  };
  const std::string type =
      table.choice(key, {"burr", "saw", "suction", "cut_plane", "plate", "grip", "screw", "probe"});
  if (type == "burr") {
    read(burr_tool_schema());
  } else if (type == "saw") {
    tool.kind = saw_tool(saw_schema().read(table));
  } else if (type == "suction") {
    read(suction_schema());
  } else if (type == "cut_plane") {
    read(cut_plane_schema());
  } else if (type == "plate") {
    read(plate_tool_schema());
  } else if (type == "grip") {
    read(grip_schema());
  } else if (type == "screw") {
    read(screw_schema());
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
  const auto with_holes = [&](const PlateShape& shape) {
    std::vector<Eigen::Isometry3d> holes;
    for (const Eigen::Vector2d& hole : shape.holes) {
      holes.push_back(bent_at({hole.x(), hole.y(), 0.0}, tool.curvature));
    }
    return PlateModel(name, bent(make_plate(shape), tool.curvature), tool.contact,
                      std::move(holes));
  };
  if (tool.shape == "straight") {
    return with_holes(straight_miniplate(tool.holes));
  }
  if (tool.shape == "l") {
    return with_holes(l_plate());
  }
  if (tool.shape == "distractor") {
    return {name, make_distractor(), tool.contact};
  }
  throw std::invalid_argument("no plate has the shape '" + tool.shape + "'");
}

}  // namespace haptrial::bone
