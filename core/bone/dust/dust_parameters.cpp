#include "core/bone/dust/dust_parameters.h"

#include "core/base/definition/schema.h"

namespace haptrial::bone {

const Schema<DustParameters>& dust_schema() {
  using P = DustParameters;
  static const auto schema =
      Schema<P>()
          .number("cell", &P::cell, {1e-4, 5e-3}, "m",
                  "Edge of a cell of the dust; smaller cells show finer piles and cost time")
          .required()
          .number("bulking", &P::bulking, {1.0, 100.0}, "",
                  "Volume of loose dust over that of the solid bone from which the dust came")
          .required()
          .number("fall_speed", &P::fall_speed, {0.0, 10.0, true}, "m/s",
                  "Speed at which dust falls")
          .required()
          .number("slope", &P::slope, {kLeastSlope, 0.7}, "",
                  "Steepest slope of a pile of dust at rest, rise over run; a steeper pile slides")
          .required()
          .number("suction_rate", &P::suction_rate, {0.0, 1e-3, true}, "m3/s",
                  "Volume of dust that a suction tube takes in a second, counted as solid bone")
          .required()
          .number("suction_reach", &P::suction_reach, {0.0, 0.02, true}, "m",
                  "Distance from a suction tube's mouth within which dust is taken")
          .required()
          .number("water_rate", &P::water_rate, {0.0, 1e-3}, "m3/s",
                  "Volume of dust that the water at a turning burr carries off in a second, "
                  "counted as solid bone; 0: no water runs")
          .number("water_reach", &P::water_reach, {0.0, 0.02, true}, "m",
                  "Distance from a turning burr within which water carries dust off");
  return schema;
}

}  // namespace haptrial::bone
